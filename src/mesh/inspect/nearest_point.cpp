#include "mesh/inspect/nearest_point.h"

#include <algorithm>
#include <limits>

namespace glisson {

std::pair<Vec3d, Vec3d> box_of(const TetMesh& mesh) {
  Vec3d low = mesh.vertices[mesh.tets[0][0]], high = low;
  for (const Tet& t : mesh.tets) {
    for (const std::uint32_t v : t) {
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], mesh.vertices[v][i]);
        high[i] = std::max(high[i], mesh.vertices[v][i]);
      }
    }
  }
  return {low, high};
}

namespace detail {
namespace {

Vec3d nearest_on_edge(const Vec3d& x, const Vec3d& a, const Vec3d& b) {
  const Vec3d along = b - a;
  const double squared = dot(along, along);
  return squared > 0.0 ? a + along * std::clamp(dot(x - a, along) / squared, 0.0, 1.0) : a;
}

}  // namespace

double place_tolerance(const TetMesh& mesh) {
  const auto [low, high] = box_of(mesh);
  return 1e-9 * norm(high - low);
}

/// The foot of the perpendicular where it lies inside; else the nearest point of the edges.
Vec3d nearest_on_triangle(const Vec3d& x, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d n = cross(b - a, c - a);
  const double squared = dot(n, n);
  if (squared > 0.0) {
    const Vec3d foot = x - n * (dot(x - a, n) / squared);
    const auto inside = [&](const Vec3d& p, const Vec3d& q) { return dot(cross(q - p, foot - p), n) >= 0.0; };
    if (inside(a, b) && inside(b, c) && inside(c, a)) return foot;
  }
  Vec3d best = nearest_on_edge(x, a, b);
  for (const Vec3d& p : {nearest_on_edge(x, b, c), nearest_on_edge(x, c, a)}) {
    if (norm(p - x) < norm(best - x)) best = p;
  }
  return best;
}

Vec3d nearest_point(const TetMesh& mesh, const Vec3d& x) {
  Vec3d best = mesh.vertices[mesh.tets[0][0]];
  double distance = std::numeric_limits<double>::infinity();
  for (const Triangle& t : boundary_triangles(mesh)) {
    const Vec3d p = nearest_on_triangle(x, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    if (norm(p - x) < distance) distance = norm(p - x), best = p;
  }
  return best;
}

}  // namespace detail
}  // namespace glisson
