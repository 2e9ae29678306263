#include "scene/advice/seen_surface.h"

namespace glisson::advice {

std::vector<Corners> seen_from(const Pose& pose, const TetMesh& mesh) {
  std::vector<Corners> surface;
  for (const Triangle& t : boundary_triangles(mesh)) {
    Corners corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d from = mesh.vertices[t[i]] - pose.position;
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t k = 0; k < 3; ++k) corners[i][axis] += pose.axes(k, axis) * from[k];
    }
    surface.push_back(corners);
  }
  return surface;
}

}  // namespace glisson::advice
