// tet_links.h — conductances between the corners of a tet, for conductivity 1.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "glisson/mesh.h"

namespace glisson::heat {

inline constexpr std::array<std::array<std::size_t, 2>, 6> kEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

struct TetLinks {
  std::array<Vec3d, 4> slopes;  ///< gradients of the four linear functions times 6 V [m²]
  double six_volume = 0.0;      ///< [m³]
  std::array<double, 6> w{};    ///< −V ∇φ_i·∇φ_j of each edge [m]
};

/// @param at  of all vertices [m]
inline TetLinks links_of(std::span<const Vec3d> at, const Tet& t) {
  const Vec3d &a = at[t[0]], &b = at[t[1]], &c = at[t[2]], &d = at[t[3]];
  TetLinks x;
  auto& g = x.slopes;
  g[1] = cross(c - a, d - a), g[2] = cross(d - a, b - a), g[3] = cross(b - a, c - a);
  g[0] = (g[1] + g[2] + g[3]) * -1.0;
  x.six_volume = dot(b - a, g[1]);
  for (std::size_t e = 0; e < 6; ++e) x.w[e] = -dot(g[kEdges[e][0]], g[kEdges[e][1]]) / (6.0 * x.six_volume);
  return x;
}

}  // namespace glisson::heat
