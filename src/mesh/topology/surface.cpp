// surface.cpp — the boundary of a mesh: the faces that belong to one tetrahedron only.
#include "mesh/topology/faces.h"
#include "mesh/topology/require_valid.h"

namespace glisson {

std::vector<Triangle> boundary_triangles(const TetMesh& mesh) {
  detail::require_indices(mesh);
  std::vector<std::uint8_t> open(mesh.tets.size(), 0);  // bit i: the face opposite corner i is at the boundary
  std::size_t count = 0;
  detail::for_each_face(mesh, {}, [&](std::span<const detail::FaceSide> sides) {
    if (sides.size() > 1) return;
    open[sides[0].tet] = static_cast<std::uint8_t>(open[sides[0].tet] | (1u << sides[0].corner));
    ++count;
  });
  std::vector<Triangle> triangles;
  triangles.reserve(count);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Tet& tet = mesh.tets[t];
    for (std::size_t corner = 0; corner < 4; ++corner) {
      if ((open[t] >> corner & 1u) == 0) continue;
      const auto& c = detail::kFaceCorners[corner];
      triangles.push_back({tet[c[0]], tet[c[1]], tet[c[2]]});
    }
  }
  return triangles;
}

}  // namespace glisson
