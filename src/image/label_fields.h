// label_fields.h — one smooth function a region, such that regions agree on the interfaces between them.
//
// Each group k, and the space around them as group 0, has φ_k: its signed distance from the voxels, smoothed with all others under two
// constraints: at the centre of each voxel the φ of the group that it belongs to stays the least by a margin, so that no voxel changes
// hands (and no sheet or bridge of a voxel's thickness is lost), and each group keeps the volume of its voxels. Where two are equal is
// their interface. The mesher takes regions by precedence, so region k is the set where
//
//   f_k = ½ (φ_k − min_{j after k} φ_j) < 0      and no earlier f is:  f_a = 0 is the one surface between a and whatever comes after it
//
// f_k is a cubic spline through its values at the voxels. Its slope is near 1 at the interface and at most 1 far off.
#pragma once

#include <memory>
#include <vector>

#include "glisson/image/clean_labels.h"
#include "glisson/region_mesh.h"
#include "image/spline_field.h"

namespace glisson::image {

struct SmoothingOptions {
  int rounds = 2;       ///< of smoothing by 1 2 1 along each axis; 0: the voxels' own distances
  double margin = 0.2;  ///< by which a voxel's own φ stays below all others, in voxels
};

struct LabelFields {
  std::vector<std::shared_ptr<const SplineField>> fields;  ///< f of each group [m]
  std::vector<Bounds> bounds;                              ///< of each group [m]
  std::vector<double> volumes;                             ///< that f bounds, by 64 points a voxel [m³]
  std::size_t changed_voxels = 0;                          ///< whose centre is in another group than the voxel
};

/// A region where a field is below 0; outside of its box that is at least the distance from there.
BodyRegion field_region(const std::string& name, std::shared_ptr<const SplineField> field, const Bounds& box);

/// Values of labels beyond the image are those at its border.
/// Cost: some 60 ns a voxel, group and round.
LabelFields smooth_fields(const GroupImage& image, const SmoothingOptions& options);

}  // namespace glisson::image
