// program_path.cpp — see program_path.h.
#include "cli/program_path.h"

namespace glisson::app {

std::string& program_path() {
  static std::string path = "glisson";
  return path;
}

}  // namespace glisson::app
