// surface_edges.cpp — see surface_edges.h.
#include "mesher/implicit/surface_edges.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace glisson::detail {
namespace {

[[noreturn]] void refuse_points(const std::string& what) { throw std::invalid_argument(what); }

/// The number of the first point at the same place, of each point.
std::vector<std::uint32_t> at_one_place(std::span<const Vec3d> points) {
  constexpr double kLargest = 1e30;  // [m]; squares of areas stay finite
  std::map<std::array<double, 3>, std::uint32_t> places;
  std::vector<std::uint32_t> same;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Vec3d& x = points[i];
    if (!(std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}) <= kLargest) || std::isnan(x.x + x.y + x.z))
      refuse_points("has point " + std::to_string(i) +
                    " that is not finite, or beyond 1e30 m; repair the file that it is from");
    same.push_back(places.try_emplace({x.x, x.y, x.z}, i).first->second);
  }
  return same;
}

}  // namespace

EdgeUses edge_uses(std::span<const Triangle> triangles) {
  EdgeUses edges;
  for (const Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      EdgeUse& edge = edges[edge_of(a, b)];
      edge.sum += a < b ? 1 : -1, ++edge.count;
    }
  }
  return edges;
}

std::vector<Triangle> distinct_triangles(std::span<const Vec3d> points, std::span<const Triangle> triangles) {
  const std::vector<std::uint32_t> same = at_one_place(points);
  std::vector<Triangle> kept;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Triangle corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (triangles[t][i] >= points.size())
        refuse_points("has triangle " + std::to_string(t) + " of point " + std::to_string(triangles[t][i]) +
                      "; there are " + std::to_string(points.size()) + ", counted from 0");
      corners[i] = same[triangles[t][i]];
    }
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]) kept.push_back(corners);
  }
  if (kept.empty()) refuse_points("has no triangles; give a closed surface");
  return kept;
}

std::string place_text(const Vec3d& x) {
  std::ostringstream text;
  text << "(" << x.x << ", " << x.y << ", " << x.z << ") m";
  return text.str();
}

}  // namespace glisson::detail
