// image_header.h — what the header of an image file says, whatever its format: grid, numbers, and where the voxels are.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "glisson/image/image.h"
#include "image/read/byte_stream.h"

namespace glisson::image {

enum class VoxelType { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

inline std::size_t bytes_of(VoxelType type) {
  constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

struct ImageHeader {
  ImageGrid grid;
  VoxelType type = VoxelType::u8;
  bool big_endian = false;
  double slope = 1.0, intercept = 0.0;  ///< value = slope · number + intercept
  std::map<int, std::string> names;
  std::vector<std::string> notes;

  ByteSource data;           ///< the file that holds the voxels
  bool packed = false;       ///< gzip or zlib
  bool from_end = false;     ///< the voxels are the last bytes of an unpacked file
  std::uint64_t before = 0;  ///< bytes before the packed data or the voxels
  std::uint64_t skip = 0;    ///< unpacked bytes before the voxels
};

/// @throws ImageError  naming file, field and value
ImageHeader read_nifti(const ByteSource& source);
ImageHeader read_nrrd(const ByteSource& source);
ImageHeader read_metaimage(const ByteSource& source);

// What the formats share.

/// The grid of a file in millimetres, its columns and origin given row by row in the frame of the file.
/// @param flip  per world axis: −1 where the file's axis points the other way than RAS
/// @throws ImageError  sizes below 1, more than 2⁴⁰ voxels, numbers that are not finite, axes without volume
ImageGrid checked_grid(const std::string& file, const std::array<std::int64_t, 3>& size, const Mat3d& columns,
                       const Vec3d& origin, const Vec3d& flip, double metres);

[[noreturn]] void fail(const ByteSource& source, const std::string& what);

/// Lines of a text header: up to an empty one, or to the last of them. @throws ImageError  a header of more than 4 MiB, or one that is no text
struct TextHeader {
  std::vector<std::string> lines;
  std::uint64_t bytes = 0;  ///< up to the first behind it
};
/// @param last  the key of the line that ends it; empty: an empty line, or the end of the file
TextHeader read_text_header(const ByteSource& source, std::string_view last);

/// Numbers separated by blanks, commas and parentheses, all of them. @throws ImageError naming what they are
std::vector<double> numbers_in(const ByteSource& source, std::string_view text, const std::string& what);
/// A file that a header names, beside it. @throws ImageError where the header is in memory
ByteSource beside(const ByteSource& header, const std::string& name);

}  // namespace glisson::image
