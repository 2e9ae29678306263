// view_lines.h — reads view.jsonl of a run: who is there in its first line, where they are in the further ones.
#pragma once

#include <filesystem>

#include "view/replay/run_folder.h"

namespace glisson::view {

/// Tools, forms, sets and heading into the run, places of instruments into its frames; what is wrong with the file goes into the
/// run's notice, by line and key, and what stands before is kept. @throws std::invalid_argument where it is no regular file
void take_view_file(const std::filesystem::path& file, RunFolder& run);

}  // namespace glisson::view
