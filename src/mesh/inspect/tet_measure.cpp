// tet_measure.cpp — volume and shape of single tetrahedra.
#include <cmath>

#include "glisson/mesh.h"

namespace glisson {

double six_rest_volume(const TetMesh& mesh, std::size_t tet) {
  const Tet& t = mesh.tets[tet];
  const Vec3d& origin = mesh.vertices[t[0]];
  return dot(mesh.vertices[t[1]] - origin, cross(mesh.vertices[t[2]] - origin, mesh.vertices[t[3]] - origin));
}

double volume(const TetMesh& mesh) {
  double six = 0.0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) six += six_rest_volume(mesh, t);
  return six / 6.0;
}

double regular_mean_ratio(const TetMesh& mesh, std::size_t tet) {
  const double three_volume = 0.5 * six_rest_volume(mesh, tet);
  if (!(three_volume > 0.0)) return 0.0;
  const Tet& t = mesh.tets[tet];
  double edges_squared = 0.0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) {
      const Vec3d edge = mesh.vertices[t[b]] - mesh.vertices[t[a]];
      edges_squared += dot(edge, edge);
    }
  }
  const double root = std::cbrt(three_volume);
  return 12.0 * root * root / edges_squared;  // η = 12 (3V)^⅔ / Σ l²
}

}  // namespace glisson
