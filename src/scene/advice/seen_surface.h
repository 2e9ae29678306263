// seen_surface.h — the surface of a body at rest as an instrument sees it from its start.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "glisson/mesh.h"
#include "glisson/pose.h"

namespace glisson::advice {

using Corners = std::array<Vec3d, 3>;  // of a surface triangle, in the instrument's own axes

/// Whether the triangle lies over the point, seen along the tool.
template <class Point>
bool covers(const Corners& t, const Point& p) {
  const auto turn = [&](const Vec3d& a, const Vec3d& b) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
  };
  const double ab = turn(t[0], t[1]), bc = turn(t[1], t[2]), ca = turn(t[2], t[0]);
  return std::min({ab, bc, ca}) >= 0.0 || std::max({ab, bc, ca}) <= 0.0;
}

/// The first triangle that the point would meet; null: none.
template <class Point>
const Corners* met_by(const Point& p, const std::vector<Corners>& surface) {
  double highest = -std::numeric_limits<double>::infinity();
  const Corners* met = nullptr;
  for (const Corners& t : surface) {
    const double height = std::max({t[0].z, t[1].z, t[2].z});
    if (height <= highest || !covers(t, p)) continue;
    highest = height, met = &t;
  }
  return met;
}

/// The surface in the axes of the instrument at its start, whose own z axis points back along its direction.
std::vector<Corners> seen_from(const Pose& pose, const TetMesh& mesh);

}  // namespace glisson::advice
