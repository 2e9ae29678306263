// vtu_array.h — the arrays of a .vtu file, decoded by VTK's XML parser into memory that we size ourselves.
//
// VTK's reader of whole grids believes what a file says of itself: an array shorter than its piece states, or
// of an unknown type, leads it to a null pointer, and its XML parser divides by the block size of compressed
// data. So we use its XML, its reading of text and its compressors, and count what is read.
#pragma once

#include <vtkDataCompressor.h>
#include <vtkSmartPointer.h>

#include <string>
#include <string_view>
#include <vector>

#include "io/vtk_log.h"
#include "io/vtu_blocks.h"

class vtkXMLDataElement;
class vtkXMLDataParser;

namespace glisson::detail {

class VtuArrays {
 public:
  /// @param parser  has parsed `bytes`
  /// @throws FileError for an unknown compressor
  VtuArrays(vtkXMLDataParser& parser, std::string_view bytes, const std::string& name);

  /// Reads a <DataArray> of exactly `count` values. @throws FileError if it has more, fewer or bad ones
  std::vector<double> read(vtkXMLDataElement& element, std::uint64_t count);
  /// The same where only integers make sense; unsigned values beyond the signed range come out negative.
  std::vector<std::int64_t> read_integers(vtkXMLDataElement& element, std::uint64_t count);

  /// A count in an attribute, `otherwise` without it. @throws FileError if the file has no room for so many
  std::uint64_t count(vtkXMLDataElement& element, const char* attribute, std::uint64_t otherwise) const;

  /// @throws FileError with the name of the array and WHAT
  [[noreturn]] void refuse(vtkXMLDataElement& element, const std::string& what) const;

 private:
  struct Raw {
    int type;
    std::vector<unsigned char> bytes;
  };
  Raw read_raw(vtkXMLDataElement& element, std::uint64_t count);
  std::vector<unsigned char> read_text(vtkXMLDataElement& element, int type, std::size_t size, std::uint64_t count);
  std::vector<unsigned char> read_block(vtkXMLDataElement& element, std::uint64_t position, const VtuPacking& packing,
                                        std::size_t size);
  void require_count(vtkXMLDataElement& element, std::uint64_t found, std::uint64_t count) const;

  vtkXMLDataParser& parser_;
  vtkSmartPointer<vtkDataCompressor> compressor_;
  vtkSmartPointer<VtkErrorLog> log_;
  std::string_view bytes_;
  std::string name_;
  VtuPacking inline_, appended_;
  std::uint64_t room_;
};

}  // namespace glisson::detail
