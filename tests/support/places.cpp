#include "support/places.h"

namespace glisson::test {

std::filesystem::path shipped(std::string_view relative) {
  return std::filesystem::path(GLISSON_SOURCE_DIR) / relative;
}

}  // namespace glisson::test
