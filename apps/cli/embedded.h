// embedded.h — files that travel inside the program, so that it needs none of its source or install tree to run.
#pragma once

#include <string_view>

namespace glisson::app {

/// The built page of the live view, from web/.
std::string_view live_page();

/// The built report page with its data token, from web/.
std::string_view report_template();

// The scenes of scenes/paper/ as TOML text.
std::string_view figure2_scene();
std::string_view figure3a_scene();
std::string_view figure3b_scene();
std::string_view speed_scene();

}  // namespace glisson::app
