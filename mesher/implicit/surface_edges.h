// surface_edges.h — how the triangles of a surface meet at its edges.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "glisson/mesh.h"

namespace glisson::detail {

/// An edge closes where the sum is 0.
struct EdgeUse {
  int sum = 0;    ///< triangles that go along it from its lower point on, less those that go the other way
  int count = 0;  ///< triangles
};
using EdgeUses = std::map<std::array<std::uint32_t, 2>, EdgeUse>;  // by the edge's points in ascending order

EdgeUses edge_uses(std::span<const Triangle> triangles);

inline std::array<std::uint32_t, 2> edge_of(std::uint32_t a, std::uint32_t b) {
  return a < b ? std::array{a, b} : std::array{b, a};
}

/// Triangles whose corners at exactly the same place are one point; those with a corner twice are left out.
/// @throws std::invalid_argument for points that are not finite or not there, and where none is left
std::vector<Triangle> distinct_triangles(std::span<const Vec3d> points, std::span<const Triangle> triangles);

/// `(x, y, z) m`.
std::string place_text(const Vec3d& x);

}  // namespace glisson::detail
