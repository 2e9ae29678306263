// mesh_step.h — what the shapes of a mesh's tets cost in steps, before there is a tissue. A header of its own: programs that make meshes
// need nothing else of a simulation.
#pragma once

#include <span>

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

/// The same where another edge was asked for in each tet (edges_asked in glisson/region_mesh.h): the forces of a tet are taken
/// e² times, so that each has a step as if all edges were 1.
/// @param edges  e of each tet [m], > 0
double relative_stable_step(const TetMesh& mesh, std::span<const double> edges);

}  // namespace glisson
