// atomic_file.h — files that are either the old ones or complete, whenever a run is interrupted.
#pragma once

#include <filesystem>
#include <string_view>

namespace glisson::detail {

/// Writes FILE.part beside the file and then renames it to `file`; leaves no part where that fails.
/// @throws FileError with the system's reason
void replace_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace glisson::detail
