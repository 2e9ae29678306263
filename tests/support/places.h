// places.h — where a test finds what is shipped. The path is in one source file, so that the compiler's cache serves all
// others in another clone.
#pragma once

#include <filesystem>
#include <string_view>

namespace glisson::test {

/// In the project's folder: `shipped("scenes/fit")`.
std::filesystem::path shipped(std::string_view relative);

}  // namespace glisson::test
