// embedded.h — files that travel inside the program, so that it needs none of its source or install tree to run.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

namespace glisson::app {

/// The built page of the live view, from web/.
std::string_view live_page();

/// The built report page with its data token, from web/.
std::string_view report_template();

/// The files that draw charts and pictures, python/glisson/: names and texts.
std::vector<std::pair<std::string_view, std::string_view>> drawing_files();

/// The text of a file below scenes/, e.g. "paper/figure2.toml": the scenes, fits and curves of `glisson reproduce`.
/// @throws std::out_of_range for a file that is not in the program (a broken build)
std::string_view scene_file(std::string_view path);

/// The paths below scenes/ that start with `folder`, in alphabetical order.
std::vector<std::string_view> scene_files_in(std::string_view folder);

}  // namespace glisson::app
