// outside_file.h — files of a folder that someone else may have made: regular ones of a bearable size, or a word why not.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>

namespace glisson::view {

/// No table of a run but its forces is longer; those are read line by line [bytes].
inline constexpr std::uintmax_t kLongestText = 256'000'000;

/// Whether there is anything by that name that can be read as a file; a pipe or a device would hold its reader for good.
/// @throws std::invalid_argument with the way out where it is there and is no regular file, or longer than `most` bytes
bool can_be_read(const std::filesystem::path& file, std::uintmax_t most = kLongestText);

/// A stream of the file, empty where there is none. @throws std::invalid_argument as can_be_read
std::ifstream open_outside(const std::filesystem::path& file, std::uintmax_t most = kLongestText);

}  // namespace glisson::view
