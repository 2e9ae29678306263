// mesh_refinement.h — finer meshes of the same body, to see what the mesh adds to a result.
#pragma once

#include <span>
#include <vector>

#include "glisson/mesh.h"

namespace glisson {

/// The mesh with every tet split into eight: at the middles of its edges, the octahedron inside along the
/// diagonal that leaves the best shapes [Bey1995]; there the diagonal goes by the numbers of the corners. Vertices keep their numbers, new ones follow; the children of tet t are 8 t … 8 t + 7.
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
