// input_file.h — files that a user names, read whole: only regular ones, and only up to a size, so that a device or a
// pipe in the place of a file is a message and not an endless read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace glisson::detail {

/// What is expected of a file, for its limit and for messages.
struct InputKind {
  const char* name;          ///< "a .toml file"
  std::uintmax_t most;       ///< bytes
  const char* if_too_large;  ///< what to do about a larger one
};

inline constexpr InputKind kTomlInput{"a .toml file", std::uintmax_t{16} << 20, "name a scene or a fit"};
inline constexpr InputKind kTableInput{"a .csv file", std::uintmax_t{256} << 20, "record fewer rows or split it"};
inline constexpr InputKind kStateInput{"a file that glisson wrote", std::uintmax_t{256} << 20, "delete it"};
inline constexpr InputKind kMeshInput{"a mesh file", std::uintmax_t{16} << 30, "split or coarsen the mesh"};
inline constexpr InputKind kSurfaceInput{"a surface file", std::uintmax_t{4} << 30, "coarsen the surface"};

struct InputFile {
  std::string bytes;
  std::string problem;  ///< "FILE: what is wrong; what to do"; empty: the bytes are those of the file
};

/// All bytes of a regular file of at most `kind.most`; links are followed.
InputFile read_input(const std::filesystem::path& file, const InputKind& kind);

}  // namespace glisson::detail
