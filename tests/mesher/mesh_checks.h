// mesh_checks.h — what every mesh of regions has to be: conforming, and of good shape.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "glisson/mesh.h"

namespace glisson::test {

struct Face {
  std::array<std::uint32_t, 3> corners;
  std::vector<int> regions;  ///< of its tets
};

inline std::vector<Face> faces_of(const TetMesh& mesh) {
  std::map<std::array<std::uint32_t, 3>, std::vector<int>> faces;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      std::array<std::uint32_t, 3> f{mesh.tets[t][(i + 1) % 4], mesh.tets[t][(i + 2) % 4], mesh.tets[t][(i + 3) % 4]};
      std::sort(f.begin(), f.end());
      faces[f].push_back(mesh.regions[t]);
    }
  }
  std::vector<Face> all;
  for (auto& [corners, regions] : faces) all.push_back({corners, regions});
  return all;
}

/// No face has more than two tets, and every edge of a region's boundary has an even number of its faces: it is closed.
inline void expect_conforming(const TetMesh& mesh) {
  ASSERT_NO_THROW(require_valid(mesh));
  std::map<std::array<std::uint32_t, 2>, std::map<int, int>> edges;
  for (const Face& f : faces_of(mesh)) {
    ASSERT_LE(f.regions.size(), 2u);
    if (f.regions.size() == 2 && f.regions[0] == f.regions[1]) continue;
    for (const int region : f.regions) {
      for (std::size_t i = 0; i < 3; ++i) {
        std::array<std::uint32_t, 2> e{f.corners[i], f.corners[(i + 1) % 3]};
        std::sort(e.begin(), e.end());
        ++edges[e][region];
      }
    }
  }
  for (const auto& [edge, counts] : edges) {
    for (const auto& [region, count] : counts) ASSERT_EQ(count % 2, 0) << "an edge of region " << region << " is open";
  }
}

/// Least altitude of a tet over that of a regular one of the edge asked for, in each tet or in all.
inline double least_altitude(const TetMesh& mesh, const std::vector<double>& edges) {
  double least = 1e9;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Tet& x = mesh.tets[t];
    double area = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3d& p = mesh.vertices[x[(i + 1) % 4]];
      area = std::max(area, norm(cross(mesh.vertices[x[(i + 2) % 4]] - p, mesh.vertices[x[(i + 3) % 4]] - p)));
    }
    least = std::min(least, six_rest_volume(mesh, t) / (area * edges[t]));
  }
  return least / std::sqrt(2.0 / 3.0);
}
inline double least_altitude(const TetMesh& mesh, double edge) {
  return least_altitude(mesh, std::vector<double>(mesh.tets.size(), edge));
}

}  // namespace glisson::test
