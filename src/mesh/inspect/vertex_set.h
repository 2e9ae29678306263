// vertex_set.h — a vertex set that a mesh does not have, those it has, and which vertices belong to the body.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "glisson/mesh.h"

namespace glisson {

/// `no vertex set "zmin"; did you mean "z_min"? the sets are: …`.
std::string no_vertex_set(const std::string& name, std::span<const std::string> known);

/// Per vertex: 1 where it belongs to a tet; others have no mass and bear nothing.
std::vector<char> vertices_in_tets(const TetMesh& mesh);

}  // namespace glisson
