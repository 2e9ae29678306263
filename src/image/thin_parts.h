// thin_parts.h — shorter edges where a region is thin, so that the mesher loses no vessel or sheet.
//
// A part is thinner than 2R where no ball of radius R that fits into the region reaches it: region minus its opening by that ball.
#pragma once

#include <functional>

#include "glisson/image/clean_labels.h"

namespace glisson::image {

/// The edge wanted at a point, such that so many are across a region's thickness there: `edge` where that is enough, no shorter than half a
/// voxel. Away from thin parts it grows by `growth` times the distance.
/// @param across  edges across the thickness, > 0 @param edge  [m]
/// Cost: some 0.3 µs a voxel and region.
std::function<double(const Vec3d&)> thin_part_sizes(const GroupImage& image, double across, double edge, double growth);

}  // namespace glisson::image
