// version.cpp — see version.h.
#include "report/version.h"

namespace glisson {

std::string_view version() { return GLISSON_VERSION; }

}  // namespace glisson
