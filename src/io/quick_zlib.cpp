#include "io/quick_zlib.h"

#include <libdeflate.h>
#include <vtkObjectFactory.h>
#include <new>

namespace glisson::detail {
namespace {

constexpr int kLevel = 1;  ///< numbers of fields hardly become smaller at higher ones

}  // namespace

vtkStandardNewMacro(QuickZlib);

QuickZlib::QuickZlib() : quick_(libdeflate_alloc_compressor(kLevel)) {
  if (quick_ == nullptr) throw std::bad_alloc();
}

QuickZlib::~QuickZlib() { libdeflate_free_compressor(quick_); }

std::size_t QuickZlib::GetMaximumCompressionSpace(std::size_t size) {
  return libdeflate_zlib_compress_bound(quick_, size);
}

/// 0 says that it failed.
std::size_t QuickZlib::CompressBuffer(const unsigned char* from, std::size_t size, unsigned char* to,
                                      std::size_t space) {
  return libdeflate_zlib_compress(quick_, from, size, to, space);
}

}  // namespace glisson::detail
