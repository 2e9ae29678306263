// body_sets.h — named vertex sets of a body of labels: surfaces, the image's border, and what lies beside labels that are not meshed.
#pragma once

#include "glisson/image/image_body.h"

namespace glisson::image {

/// Distance of points from voxels, to half a voxel: [m], 0 within; infinite where there are none.
struct NearLabels {
  std::string name;
  ImageGrid grid;
  std::vector<float> distance;
  double at(const Vec3d& p) const;
};

/// Of groups of labels in an image.
std::vector<NearLabels> near_labels(const LabelImage& image, const std::vector<LabelGroup>& groups);

/// Moves vertices of the body's surface that the mesher left a little off the planes that close the body onto them, where no tet becomes flatter
/// than 10° by it, or than it was.
void flatten_border(TetMesh& mesh, const GroupImage& labels, double edge);

/// Adds NAME_surface of each region, `image_border` where the image cuts the body, and the name of each of `beside`: vertices of the body's
/// surface within a distance of its voxels [m]. @throws std::invalid_argument where one of these is empty
void add_body_sets(TetMesh& mesh, const GroupImage& labels, const std::vector<NearLabels>& beside, double within);

}  // namespace glisson::image
