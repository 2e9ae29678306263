// surface_tree.cpp — see surface_tree.h.
#include "mesher/implicit/surface_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace glisson::detail {
namespace {

constexpr std::size_t kLeaf = 6;  // triangles
constexpr double kFar =
    2.0;  // times its reach, from where a node counts as a dipole: w is off by 0.09 at most (measured)

double squared_to_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const Vec3d along = b - a;
  const double t = std::clamp(dot(p - a, along) / squared(along), 0.0, 1.0);
  return squared(p - a - along * t);
}

/// Within the prism over the triangle its plane is nearest, elsewhere one of its edges.
double squared_to_triangle(const Vec3d& p, const Corners& t) {
  const Vec3d n = cross(t[1] - t[0], t[2] - t[0]);
  bool over = true;
  for (std::size_t i = 0; i < 3 && over; ++i) over = dot(cross(n, t[(i + 1) % 3] - t[i]), p - t[i]) >= 0.0;
  if (over) {
    const double height = dot(n, p - t[0]);
    return height * height / squared(n);
  }
  return std::min(
      {squared_to_segment(p, t[0], t[1]), squared_to_segment(p, t[1], t[2]), squared_to_segment(p, t[2], t[0])});
}

/// [VanOosteromStrackee1983, eq. 8]
double solid_angle(const Vec3d& p, const Corners& t) {
  const Vec3d a = t[0] - p, b = t[1] - p, c = t[2] - p;
  const double x = norm(a), y = norm(b), z = norm(c);
  return 2.0 * std::atan2(dot(a, cross(b, c)), x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y);
}

double squared_to_box(const Vec3d& p, const Bounds& box) {
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double off = std::max({box.min[k] - p[k], 0.0, p[k] - box.max[k]});
    sum += off * off;
  }
  return sum;
}

}  // namespace

SurfaceTree::SurfaceTree(std::vector<Corners> triangles) : triangles_(std::move(triangles)) {
  nodes_.reserve(2 * triangles_.size() / kLeaf + 2);
  build(0, triangles_.size());
}

double SurfaceTree::distance(const Vec3d& p) const {
  double best = std::numeric_limits<double>::infinity();
  nearest(0, p, best);
  const double size = std::sqrt(best);
  const bool inside = squared_to_box(p, box()) == 0.0 && winding(0, p) >= 0.5 * 4.0 * std::numbers::pi;
  return inside ? -size : size;
}

std::size_t SurfaceTree::build(std::size_t first, std::size_t count) {
  const std::size_t at = nodes_.size();
  nodes_.push_back(node_of(first, count));
  if (count <= kLeaf) return at;
  const Vec3d size = nodes_[at].box.max - nodes_[at].box.min;
  const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const auto begin = triangles_.begin() + static_cast<std::ptrdiff_t>(first);
  const auto half = static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(begin, begin + half, begin + static_cast<std::ptrdiff_t>(count),
                   [&](const Corners& a, const Corners& b) { return middle_of(a)[axis] < middle_of(b)[axis]; });
  build(first, count / 2);
  const std::size_t second = build(first + count / 2, count - count / 2);
  nodes_[at].second = second;
  return at;
}

SurfaceTree::Node SurfaceTree::node_of(std::size_t first, std::size_t count) const {
  Node node{
      .box = {triangles_[first][0], triangles_[first][0]}, .area = {}, .middle = {}, .first = first, .count = count};
  double weight = 0.0;
  for (std::size_t i = first; i < first + count; ++i) {
    const Vec3d area = area_vector(triangles_[i]);
    node.area += area;
    node.middle += middle_of(triangles_[i]) * norm(area);
    weight += norm(area);
    for (const Vec3d& x : triangles_[i]) {
      for (std::size_t k = 0; k < 3; ++k) {
        node.box.min[k] = std::min(node.box.min[k], x[k]);
        node.box.max[k] = std::max(node.box.max[k], x[k]);
      }
    }
  }
  node.middle *= 1.0 / weight;
  for (std::size_t i = first; i < first + count; ++i) {
    for (const Vec3d& x : triangles_[i]) node.reach = std::max(node.reach, norm(x - node.middle));
  }
  return node;
}

void SurfaceTree::nearest(std::size_t at, const Vec3d& p, double& best) const {
  const Node& node = nodes_[at];
  if (node.second == 0) {
    for (std::size_t i = node.first; i < node.first + node.count; ++i)
      best = std::min(best, squared_to_triangle(p, triangles_[i]));
    return;
  }
  std::array<std::size_t, 2> below{at + 1, node.second};
  std::array<double, 2> off{squared_to_box(p, nodes_[below[0]].box), squared_to_box(p, nodes_[below[1]].box)};
  if (off[1] < off[0]) std::swap(below[0], below[1]), std::swap(off[0], off[1]);
  for (std::size_t i = 0; i < 2; ++i) {
    if (off[i] < best) nearest(below[i], p, best);
  }
}

double SurfaceTree::winding(std::size_t at, const Vec3d& p) const {
  const Node& node = nodes_[at];
  const Vec3d to = node.middle - p;
  const double away = norm(to);
  if (away > kFar * node.reach) return dot(node.area, to) / (away * away * away);
  if (node.second != 0) return winding(at + 1, p) + winding(node.second, p);
  double sum = 0.0;
  for (std::size_t i = node.first; i < node.first + node.count; ++i) sum += solid_angle(p, triangles_[i]);
  return sum;
}

}  // namespace glisson::detail
