// result_names.h — which names the files of a run have, and which names of a scene may stand beside them or in them.
//
//   OUT/  .glisson  scene.toml  report.html  VARIANT/  forces.csv  forces_TOOL.csv  events.csv  frames.pvd  frames/ …
//
// Upper and lower case count as the same, as some file systems have it.
#pragma once

#include <string>
#include <string_view>

namespace glisson::scene {

/// Letters of the Latin alphabet in lower case: names that a file system may take for one.
std::string folded(std::string_view name);

/// Whether a run or a fit writes a file of exactly that name, or one that becomes it (`.part`).
bool is_result_file(std::string_view name);

/// What makes a variant's name unfit for a folder of results; empty where it is fit.
std::string unfit_as_folder(const std::string& name);

/// What makes the name of a tool or an instrument unfit for its file forces_NAME.csv and for the rows of events.csv; empty
/// where it is fit.
std::string unfit_as_table(const std::string& name);

}  // namespace glisson::scene
