// program_path.h — how the user called this program, so that commands we suggest can be typed as they stand.
#pragma once

#include <string>

namespace glisson::app {

/// argv[0]; set by main.
std::string& program_path();

}  // namespace glisson::app
