// contact_fields.h — traction and pressure of tools and containers on the surface of a body, per vertex.
#pragma once

#include <vector>

#include "glisson/math.h"

namespace glisson {

/// Fields in the order of the mesh's vertices, of the last step. Nodal area: a third of the present area of the triangles of the
/// surface around a vertex. Traction times nodal area, summed over the vertices, is the force of the tools and containers.
struct ContactFields {
  std::vector<Vec3d> traction;   ///< contact force on the tissue over the nodal area [Pa]
  std::vector<double> pressure;  ///< its part along the normals of contact, ≥ 0 except where a bond pulls [Pa]
};

}  // namespace glisson
