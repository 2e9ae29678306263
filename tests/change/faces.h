// faces.h — faces to split a test's body along, and what is seen of a mesh that was split.
#pragma once

#include <algorithm>
#include <set>
#include <vector>

#include "glisson/simulation/simulation.h"

namespace glisson::test {

/// Inner faces whose three vertices lie at this coordinate of the axis, in ascending vertices each.
inline std::vector<Triangle> faces_on_plane(const TetMesh& mesh, std::size_t axis, double at) {
  const auto on_plane = [&](std::uint32_t v) { return std::abs(mesh.vertices[v][axis] - at) < 1e-9; };
  std::set<Triangle> seen, inner;
  for (const Tet& t : mesh.tets) {
    for (std::size_t skip = 0; skip < 4; ++skip) {
      Triangle face{t[(skip + 1) % 4], t[(skip + 2) % 4], t[(skip + 3) % 4]};
      if (!std::all_of(face.begin(), face.end(), on_plane)) continue;
      std::sort(face.begin(), face.end());
      if (!seen.insert(face).second) inner.insert(face);
    }
  }
  return {inner.begin(), inner.end()};
}

/// The faces with their centroid where `inside` says.
template <class Inside>
std::vector<Triangle> faces_where(const std::vector<Triangle>& faces, const TetMesh& mesh, const Inside& inside) {
  std::vector<Triangle> chosen;
  for (const Triangle& f : faces) {
    const Vec3d sum = mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]];
    if (inside(sum * (1.0 / 3.0))) chosen.push_back(f);
  }
  return chosen;
}

/// Per vertex: whether it belongs to a tet with its rest centroid where `inside` says.
template <class Inside>
std::vector<char> vertices_of(const TetMesh& mesh, const Inside& inside) {
  std::vector<char> chosen(mesh.vertices.size(), 0);
  for (const Tet& t : mesh.tets) {
    const Vec3d sum = mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]] + mesh.vertices[t[3]];
    if (!inside(sum * 0.25)) continue;
    for (const std::uint32_t v : t) chosen[v] = 1;
  }
  return chosen;
}

/// Rest position and number of tets of every vertex, in order: equal for meshes that differ in numbers alone.
inline std::multiset<std::array<double, 4>> star_sizes(const Simulation& s) {
  std::vector<std::size_t> size(s.mesh().vertices.size(), 0);
  for (const Tet& t : s.present_mesh().tets) {
    for (const std::uint32_t v : t) ++size[v];
  }
  std::multiset<std::array<double, 4>> stars;
  for (std::size_t v = 0; v < size.size(); ++v) {
    const Vec3d& x = s.mesh().vertices[v];
    stars.insert({x.x, x.y, x.z, static_cast<double>(size[v])});
  }
  return stars;
}

}  // namespace glisson::test
