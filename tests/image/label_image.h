// label_image.h — images that tests make.
#pragma once

#include <string>

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

/// The same as the bytes of a MetaImage (.mha), for programs and scenes. Turned about z, so that its axes are those of RAS.
template <class Label>
std::string meta_image(const std::array<int, 3>& size, double edge_mm, Label label) {
  const std::string spacing = std::to_string(edge_mm);
  std::string text =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nElementSpacing = " + spacing + " " + spacing + " " + spacing +
      "\nOffset = 0 0 0\nTransformMatrix = -1 0 0 0 -1 0 0 0 1\nDimSize = " + std::to_string(size[0]) + " " +
      std::to_string(size[1]) + " " + std::to_string(size[2]) + "\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n";
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) text += static_cast<char>(label(i, j, k));
    }
  }
  return text;
}

}  // namespace glisson::test
