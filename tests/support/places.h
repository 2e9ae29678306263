// places.h — where a test finds what is shipped, and where it may write. The paths are in one source file, so that the
// compiler's cache serves all others in another clone.
#pragma once

#include <filesystem>
#include <string_view>

namespace glisson::test {

/// In the project's folder: `shipped("scenes/fit")`.
std::filesystem::path shipped(std::string_view relative);
/// In the folder of the build: a file that a test writes.
std::filesystem::path written(std::string_view relative);

}  // namespace glisson::test
