// spline_field.h — a smooth function through values at voxels: uniform cubic B-splines, twice continuously differentiable.
#pragma once

#include <vector>

#include "glisson/image/image.h"

namespace glisson::image {

class SplineField {
 public:
  /// @param values  at the voxels of the grid, which the function takes there              [Unser1999]
  SplineField(const ImageGrid& grid, std::vector<float> values);

  /// At a point given in voxels; outside the grid that of the nearest point of it.
  double at_index(const Vec3d& index) const;
  double at(const Vec3d& world) const { return at_index(to_index_ * (world - origin_)); }
  const ImageGrid& grid() const { return grid_; }

 private:
  ImageGrid grid_;
  Mat3d to_index_;
  Vec3d origin_;
  std::array<std::size_t, 3> size_{};  ///< of the coefficients: one more on each side
  std::vector<float> coefficients_;
};

}  // namespace glisson::image
