// forged_file.h — files of checkpoint.h whose content is made up: head, size and checksum are right, so the reader behind is met.
//
//   mode even   the rest of the input is the content
//   mode odd    the rest is a list of edits of a sound content: place u16, kind u8, value 8 bytes. So the reader is reached
//               whatever the format of the day
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace glisson::fuzz {

/// What is between head and checksum of a file that was saved.
std::string content_of(const std::string& file);
/// The content that an input asks for.
std::string forged_content(const std::string& sound, std::uint8_t mode, std::string_view rest);
/// The file of a content.
std::string file_of(std::string_view content);

}  // namespace glisson::fuzz
