// mesh_step.h — how the shapes of a mesh's tets shorten the stable step, whatever the tissue. A header of its own, for programs that
// make meshes and need nothing else of a simulation.
#pragma once

#include <span>

#include "glisson/mesh.h"

namespace glisson {

/// The largest stable step of a mesh relative to that of a regular tet of the given edge, both undamped, default tissue, ν = 0.4:
///
///   h*  over  e √(ρ/2m),   ρ density, m = 3λ + 2μ
///
/// Below 1 the shapes and sizes of the tets shorten the step; with another tissue an explicit run has about the same ratio.
/// @param edge  e [m], > 0
/// @throws std::invalid_argument  as require_valid, or an edge out of range
/// Cost: some 5 µs a tet.
double relative_stable_step(const TetMesh& mesh, double edge);

/// The same with an edge e for each tet (edges_asked in glisson/region_mesh.h): the forces of a tet are multiplied by e²,
/// which gives each tet the step of an edge of 1.
/// @param edges  e of each tet [m], > 0
double relative_stable_step(const TetMesh& mesh, std::span<const double> edges);

}  // namespace glisson
