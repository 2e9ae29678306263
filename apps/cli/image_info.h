// image_info.h — what `glisson info` says of an image.
#pragma once

#include <string>

namespace glisson::app {

/// Prints grid and labels (or grey values) of an image file. @throws ImageError
int image_info(const std::string& file, bool as_json);

}  // namespace glisson::app
