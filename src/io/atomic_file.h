// atomic_file.h — files that are either the old ones or complete, whenever a run is interrupted.
#pragma once

#include <filesystem>
#include <functional>

namespace glisson::detail {

/// Lets `write` fill FILE.part beside the file and then renames it to `file`; removes it if `write` throws.
/// @throws FileError if the file cannot be renamed, and what `write` throws
void replace_file(const std::filesystem::path& file, const std::function<void(const std::filesystem::path&)>& write);

}  // namespace glisson::detail
