// version.h — the version of the program, as results carry it.
#pragma once

#include <string_view>

namespace glisson {

/// e.g. "0.1.0", from the project's CMakeLists.txt.
std::string_view version();

}  // namespace glisson
