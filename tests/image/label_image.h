// label_image.h — images that tests make.
#pragma once

#include "glisson/image/image.h"

namespace glisson::test {

/// An image of cubes of `edge` [m] at the origin, its labels from a function of (i, j, k).
template <class Label>
LabelImage label_image(const std::array<std::size_t, 3>& size, double edge, Label label) {
  LabelImage image;
  image.grid.size = image.whole = size;
  for (std::size_t a = 0; a < 3; ++a) image.grid.axes(a, a) = edge;
  image.source = "made";
  image.voxels.resize(image.grid.voxels());
  for (std::size_t v = 0; v < image.voxels.size(); ++v) {
    const auto at = image.grid.place(v);
    image.voxels[v] =
        static_cast<std::uint16_t>(label(static_cast<int>(at[0]), static_cast<int>(at[1]), static_cast<int>(at[2])));
  }
  return image;
}

}  // namespace glisson::test
