// dihedral_angles.cpp — the angles between the faces of tetrahedra.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "glisson/mesh.h"

namespace glisson {

std::array<double, 6> dihedral_angles(const TetMesh& mesh, std::size_t tet) {
  const Tet& t = mesh.tets[tet];
  std::array<double, 6> angles{};
  std::size_t n = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      std::array<std::size_t, 2> others{};
      std::size_t count = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        if (k != i && k != j) others[count++] = k;
      }
      const Vec3d &p = mesh.vertices[t[i]], axis = mesh.vertices[t[j]] - p;
      const Vec3d a = cross(axis, mesh.vertices[t[others[0]]] - p), b = cross(axis, mesh.vertices[t[others[1]]] - p);
      angles[n++] = std::atan2(norm(cross(a, b)), dot(a, b)) * 180.0 / std::numbers::pi;
    }
  }
  return angles;
}

std::vector<std::size_t> dihedral_histogram(const TetMesh& mesh, double bin_deg) {
  std::vector<std::size_t> counts(static_cast<std::size_t>(std::ceil(180.0 / bin_deg - 1e-9)), 0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (const double angle : dihedral_angles(mesh, t)) {
      ++counts[std::min(counts.size() - 1, static_cast<std::size_t>(angle / bin_deg))];
    }
  }
  return counts;
}

}  // namespace glisson
