#include "mesh/inspect/vertex_set.h"

#include <stdexcept>

#include "base/nearest.h"
#include "glisson/mesh.h"

namespace glisson {

std::string no_vertex_set(const std::string& name, std::span<const std::string> known) {
  const std::string meant = scene::nearest(name, known);
  const std::string hint = meant.empty() ? "" : "did you mean \"" + meant + "\"? ";
  return "no vertex set \"" + name + "\"; " + hint +
         (known.empty() ? "the mesh has none" : "the sets are: " + scene::listed(known));
}

const std::vector<std::uint32_t>& TetMesh::vertex_set(const std::string& name) const {
  const auto found = vertex_sets.find(name);
  if (found != vertex_sets.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& set : vertex_sets) known.push_back(set.first);
  throw std::invalid_argument(no_vertex_set(name, known));
}

std::vector<char> vertices_in_tets(const TetMesh& mesh) {
  std::vector<char> in_tet(mesh.vertices.size(), 0);
  for (const Tet& tet : mesh.tets) {
    for (const std::uint32_t v : tet) in_tet[v] = 1;
  }
  return in_tet;
}

}  // namespace glisson
