// mesh_refinement.h — finer meshes of the same body, to estimate the error of the mesh.
#pragma once

#include <span>
#include <vector>

#include "glisson/mesh.h"

namespace glisson {

/// The mesh with every tet split into eight at the middles of its edges; the inner octahedron is split along the diagonal that gives
/// the best shapes (in [Bey1995] by the corners' numbers). Vertices keep their numbers; the children of tet t are 8 t … 8 t + 7.
///
/// Regions and fibres are those of the parent. A new vertex belongs to a set if both ends of its edge do; where all the set
/// lies on the surface, the edge has to lie there, too. Planes stay planes: a curved surface stays the polyhedron it is.
/// @throws std::invalid_argument as require_valid
/// Cost: O(tets log tets).
TetMesh refined(const TetMesh& mesh);

/// A field of the vertices of refined(mesh), linear within the tets of the mesh: a new vertex has the mean of its edge's ends.
/// @param field  one per vertex of the mesh
/// @throws std::invalid_argument as require_valid, and where the field is of another size
std::vector<Vec3d> refined(const TetMesh& mesh, std::span<const Vec3d> field);

}  // namespace glisson
