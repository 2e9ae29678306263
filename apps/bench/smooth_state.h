// smooth_state.h — a state that looks like tissue in motion, the same in every run.
//
//   u(x) = Σ_k a_k sin(2π n_k·ξ + φ_k),  ξ = position in the bounding box, 8 waves of random direction and phase
//
// Long waves, so that neighbours deform alike as they do in tissue; strain of about 1 %, so that the law acts and
// no tetrahedron is near inversion.
#pragma once

#include <vector>

#include "glisson/mesh.h"

namespace glisson::app {

/// Displacement of each vertex [m], root mean square gradient 0.01.
std::vector<Vec3d> smooth_displacement(const TetMesh& mesh);
/// Velocity of each vertex [m/s], root mean square gradient 0.5 1/s, other waves than those of the displacement.
std::vector<Vec3d> smooth_velocity(const TetMesh& mesh);

}  // namespace glisson::app
