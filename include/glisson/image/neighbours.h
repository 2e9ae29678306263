// neighbours.h — what lies beside labels of an image: candidates for supports.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "glisson/image/clean_labels.h"

namespace glisson {

/// A label that lies near others.
struct Neighbour {
  int label = 0;
  std::string name;
  std::size_t voxels = 0;  ///< of it that are near
};

/// Labels of an image with voxels outside of a body of it whose centres are within a distance [m] of those of the body, ascending.
/// @param body  of the image after cleaning, whose islands support nothing
/// @throws std::invalid_argument where it has another grid than the image
/// Cost: some 50 ns a voxel of the image.
std::vector<Neighbour> neighbours(const LabelImage& image, const GroupImage& body, double within);

}  // namespace glisson
