// mesh_step.h — what the shapes of a mesh's tets cost in steps, before there is a tissue. A header of its own: programs that make meshes
// need nothing else of a simulation.
#pragma once

#include "glisson/mesh.h"

namespace glisson {

/// The largest stable step of a mesh over that of a regular tet of the edge asked for, both undamped and of the default tissue, ν = 0.4:
///
///   h*  over  e √(ρ/2m),   ρ density, m = 3λ + 2μ
///
/// What is below 1 is what shapes and sizes of the tets cost; an explicit run with another tissue has about the same share.
/// @param edge  e, asked for [m], > 0
/// @throws std::invalid_argument  as require_valid, or an edge out of range
/// Cost: some 5 µs a tet.
double relative_stable_step(const TetMesh& mesh, double edge);

}  // namespace glisson
