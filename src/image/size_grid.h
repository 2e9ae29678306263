// size_grid.h — wanted edges at the voxels of a grid, and between them.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "glisson/image/image.h"

namespace glisson::image {

class SizeGrid {
 public:
  /// @param edge  at all voxels [m]
  SizeGrid(const ImageGrid& grid, double edge)
      : grid_(grid), to_index_(inverse(grid.axes)), sizes_(grid.voxels(), static_cast<float>(edge)) {}

  std::vector<float>& sizes() { return sizes_; }
  /// size(v) = min over w of size(w) + growth |v − w|, to the 8 % of a distance by steps to neighbours.    [Borgefors1986]
  void spread(double growth);
  /// Linear between voxels; outside the grid that of its nearest point.
  double at(const Vec3d& p) const;
  /// How far a point is outside of the grid [m], at most.
  double beyond(const Vec3d& p) const;

 private:
  ImageGrid grid_;
  Mat3d to_index_;
  std::vector<float> sizes_;
};

/// The edge nearest to a size among those that halve `edge`: the mesher makes its finest edge exact and all others by halving, so that
/// `edge` stays that of the rest.
double whole_grade(double edge, double size);

/// Wanted edges of an image in mm, as a function of a point [m]: `edge` where it asks for none, growing away from its voxels and from its border.
/// @throws ImageError  as read_grey_image; a size below 1/256 of `edge`, with its voxel
std::function<double(const Vec3d&)> image_sizes(const std::filesystem::path& file, double edge, double growth);

}  // namespace glisson::image
