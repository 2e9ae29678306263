// distance_map.h — the distance of each voxel's centre from a set of voxels, exact on the grid, in a time linear in its size.
#pragma once

#include <vector>

#include "glisson/image/image.h"

namespace glisson::image {

/// Distance of each voxel from the nearest of a set, with the given spacings:  d²(p) = min_q |p − q|², axis by axis as the lower envelope of
/// parabolas.                                                                                                  [Felzenszwalb2012]
/// @param in_set  one entry a voxel @return in the unit of the spacings; infinite where the set is empty
std::vector<float> distance_to(const std::array<std::size_t, 3>& size, const Vec3d& spacing,
                               const std::vector<char>& in_set);

}  // namespace glisson::image
