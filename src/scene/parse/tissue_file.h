// tissue_file.h — a [tissue] that another file holds, such as the result of a fit.
#pragma once

#include <filesystem>
#include <string>

#include "scene/parse/schema.h"

namespace glisson::scene {

/// The tissue that a table means which names a `file`: the keys of that file's [tissue], and over them its own. A table
/// without a file is left as it is. Complains of a file that cannot be read or has no [tissue]. Twice is as once.
/// @param base  folder that the file is relative to
Node with_tissue_file(const Node& tissue, const std::filesystem::path& base, const Place& place);

/// `[tissue]` and a line for each key, as such a file has it.
std::string tissue_file_text(const Node& tissue);

}  // namespace glisson::scene
