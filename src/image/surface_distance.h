// surface_distance.h — how far the surfaces of regions in a mesh are from those of the voxels that they are of.
//
// Two surfaces of the voxels are looked at, neither of which the mesher saw: the level ½ of each label's voxels after a Gaussian blur of 0.7
// voxels, and the voxels' faces.
#pragma once

#include "glisson/image/image_body.h"
#include "image/implant.h"

namespace glisson::image {

/// Fills distance_p95 and faces_p95 of each region of a mesh.
void measure_distances(const GroupImage& labels, const std::vector<Implant>& implants, const TetMesh& mesh,
                       std::vector<ImageRegion>& regions);

}  // namespace glisson::image
