// layer_mesh.h — a quarter of a wide layer under a round punch, fine where the punch ends.
//
// A box split alternately, bent into a quarter of a cylinder: cells (i, j, k) go along radius, angle and height. Cells
// at the axis lose an edge, and the tetrahedra that become flat by that are left out.
//
//            a
//   axis ────────┬─┬─┬──┬────┬───────  R      rings grow by a constant ratio away from r = a on both sides,
//    │       │ │││ │ │  │    │                layers downward from the surface
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "glisson/mesh.h"

namespace glisson::test {

/// Places from 0 to `length` of n cells of which each is `ratio` times as wide as the one before.
inline std::vector<double> graded(double length, int n, double ratio) {
  std::vector<double> at{0.0};
  double width = 1.0;
  for (int i = 0; i < n; ++i, width *= ratio) at.push_back(at.back() + width);
  for (double& x : at) x *= length / at.back();
  at.back() = length;
  return at;
}
/// The ratio at which n cells whose first is `first` wide fill `length`.
inline double grading(double length, int n, double first) {
  double low = 1.0, high = 10.0;
  for (int k = 0; k < 100; ++k) {
    const double q = 0.5 * (low + high), sum = (std::pow(q, n) - 1.0) / (q - 1.0);
    (sum * first < length ? low : high) = q;
  }
  return 0.5 * (low + high);
}

struct LayerOptions {
  double a = 1.0;                                       ///< radius of the punch [m]
  double h = 1.0;                                       ///< height [m]
  double R = 10.0;                                      ///< [m]
  double edge = 0.1;                                    ///< width of the cells at the punch's edge [m]
  double top = 0.1;                                     ///< height of the cells at the surface [m]
  int inside = 5, outside = 8, around = 5, layers = 6;  ///< cells
};

/// With the vertex sets punch (r ≤ a on top), rim (those at r = a), bottom, wall, x_plane, y_plane.
inline TetMesh layer_mesh(const LayerOptions& o) {
  std::vector<double> r;
  for (const double x : graded(o.a, o.inside, grading(o.a, o.inside, o.edge))) r.push_back(o.a - x);
  std::reverse(r.begin(), r.end());
  for (const double x : graded(o.R - o.a, o.outside, grading(o.R - o.a, o.outside, o.edge))) {
    if (x > 0.0) r.push_back(o.a + x);
  }
  std::vector<double> depth = graded(o.h, o.layers, grading(o.h, o.layers, o.top));
  const int rings = o.inside + o.outside;
  const TetMesh box = box_mesh({.cells = {rings, o.around, o.layers},
                                .size = {1.0 * rings, 1.0 * o.around, 1.0 * o.layers},
                                .split = BoxSplit::alternating});
  TetMesh mesh;
  std::vector<std::uint32_t> number;
  std::map<std::size_t, std::uint32_t> on_axis;
  for (const Vec3d& x : box.vertices) {
    const auto i = static_cast<std::size_t>(std::lround(x.x)), j = static_cast<std::size_t>(std::lround(x.y)),
               k = static_cast<std::size_t>(std::lround(x.z));
    const auto next = static_cast<std::uint32_t>(mesh.vertices.size());
    if (i == 0 && on_axis.count(k) != 0) {
      number.push_back(on_axis[k]);
      continue;
    }
    if (i == 0) on_axis[k] = next;
    number.push_back(next);
    const double angle = 0.5 * std::numbers::pi * static_cast<double>(j) / o.around;
    const std::size_t from_top = static_cast<std::size_t>(o.layers) - k;
    mesh.vertices.push_back({r[i] * std::cos(angle), r[i] * std::sin(angle), o.h - depth[from_top]});
    const auto inside = static_cast<std::size_t>(o.inside);
    if (from_top == 0 && i <= inside) mesh.vertex_sets["punch"].push_back(next);
    if (from_top == 0 && i == inside) mesh.vertex_sets["rim"].push_back(next);
    if (k == 0) mesh.vertex_sets["bottom"].push_back(next);
    if (i == static_cast<std::size_t>(rings)) mesh.vertex_sets["wall"].push_back(next);
    if (i == 0 || j == static_cast<std::size_t>(o.around)) mesh.vertex_sets["x_plane"].push_back(next);
    if (i == 0 || j == 0) mesh.vertex_sets["y_plane"].push_back(next);
  }
  for (const Tet& t : box.tets) {
    Tet mapped{number[t[0]], number[t[1]], number[t[2]], number[t[3]]};
    Tet sorted = mapped;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) continue;
    mesh.tets.push_back(mapped);
    if (six_rest_volume(mesh, mesh.tets.size() - 1) < 0.0) std::swap(mesh.tets.back()[2], mesh.tets.back()[3]);
  }
  return mesh;
}

}  // namespace glisson::test
