// vtu_blocks.h — the binary blocks of a .vtu file, unpacked with every size checked.
//
//   plain       [bytes] data
//   compressed  [parts][bytes of a part][bytes of the last, 0: as the others][packed bytes of each] parts
//
// Header words are 4 or 8 bytes. In base64 the header of compressed data is padded and encoded by itself, so
// that a "=" may stand between it and the data.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <vector>

class vtkDataCompressor;

namespace glisson::detail {

/// How the binary blocks of a file are packed.
struct VtuPacking {
  bool big_endian = false;
  bool base64 = true;
  std::size_t word = 4;                     ///< bytes of a number in a header
  vtkDataCompressor* compressor = nullptr;  ///< none: plain
};

/// What is wrong with a block; the caller knows where it stands.
class BadBlock : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// @param data  the file from where the block begins
/// @param most  refuse to unpack more bytes than this
/// @return the bytes as they were before packing, in the file's byte order
/// @throws BadBlock
std::vector<unsigned char> unpack_block(std::string_view data, const VtuPacking& packing, std::uint64_t most);

}  // namespace glisson::detail
