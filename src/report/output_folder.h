// output_folder.h — the folder a run writes to: a former run there is replaced, anything else is left alone.
//
// A folder of results carries a file `.glisson`. Without it, a folder that holds anything is someone else's. With it,
// the files that a run writes are ours by name and place; a single other file among them stops the run, so that
// nothing of the user's is ever deleted.
#pragma once

#include <filesystem>

namespace glisson {

/// Makes `folder` ready: creates it, or removes the former run in it, and marks it as ours.
/// @throws std::invalid_argument naming the file that is not ours @throws OutputError with the reason of the system
void prepare_output_folder(const std::filesystem::path& folder);

}  // namespace glisson
