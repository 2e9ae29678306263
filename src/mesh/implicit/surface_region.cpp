// surface_region.cpp — a tree of boxes over the triangles of a surface: the nearest one, and how often the surface winds about a point.
//
//   node   box of its triangles for the distance; their common area vector A = Σ n area, its place c and reach r for the winding number:
//          beyond 3 r a node counts as one dipole,  A·(c − p) / (4π |c − p|³)
#include "glisson/surface_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace glisson {
namespace {

constexpr std::size_t kLeaf = 6;  // triangles
constexpr double kFar = 3.0;      // times its reach, from where a node counts as a dipole

using Corners = std::array<Vec3d, 3>;

Vec3d area_of(const Corners& t) { return cross(t[1] - t[0], t[2] - t[0]) * 0.5; }
Vec3d middle_of(const Corners& t) { return (t[0] + t[1] + t[2]) * (1.0 / 3.0); }

double squared(const Vec3d& x) { return dot(x, x); }

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

class SurfaceTree {
 public:
  explicit SurfaceTree(std::vector<Corners> triangles) : triangles_(std::move(triangles)) {
    nodes_.reserve(2 * triangles_.size() / kLeaf + 2);
    build(0, triangles_.size());
  }

  double distance(const Vec3d& p) const {
    double best = std::numeric_limits<double>::infinity();
    nearest(0, p, best);
    const double size = std::sqrt(best);
    return winding(0, p) >= 0.5 * 4.0 * std::numbers::pi ? -size : size;
  }
  const Bounds& box() const { return nodes_.front().box; }

 private:
  struct Node {
    Bounds box;
    Vec3d area, middle;
    double reach = 0.0;
    std::size_t first = 0, count = 0;  ///< of its triangles; of an inner node all below it
    std::size_t second = 0;            ///< the second node below it, the first follows itself; 0: a leaf
  };

  std::size_t build(std::size_t first, std::size_t count) {
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

  Node node_of(std::size_t first, std::size_t count) const {
    Node node{
        .box = {triangles_[first][0], triangles_[first][0]}, .area = {}, .middle = {}, .first = first, .count = count};
    double weight = 0.0;
    for (std::size_t i = first; i < first + count; ++i) {
      const Vec3d area = area_of(triangles_[i]);
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

  static double squared_to_box(const Vec3d& p, const Bounds& box) {
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double off = std::max({box.min[k] - p[k], 0.0, p[k] - box.max[k]});
      sum += off * off;
    }
    return sum;
  }

  void nearest(std::size_t at, const Vec3d& p, double& best) const {
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

  /// Solid angle of a node's triangles from p [sr].
  double winding(std::size_t at, const Vec3d& p) const {
    const Node& node = nodes_[at];
    const Vec3d to = node.middle - p;
    const double away = norm(to);
    if (away > kFar * node.reach) return dot(node.area, to) / (away * away * away);
    if (node.second != 0) return winding(at + 1, p) + winding(node.second, p);
    double sum = 0.0;
    for (std::size_t i = node.first; i < node.first + node.count; ++i) sum += solid_angle(p, triangles_[i]);
    return sum;
  }

  std::vector<Corners> triangles_;
  std::vector<Node> nodes_;
};

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw std::invalid_argument("surface \"" + name + "\": " + what);
}

std::string place_text(const Vec3d& x) {
  std::ostringstream text;
  text << "(" << x.x << ", " << x.y << ", " << x.z << ") m";
  return text.str();
}

/// The number of the first point at the same place, of each point.
std::vector<std::uint32_t> welded(const std::string& name, std::span<const Vec3d> points) {
  std::map<std::array<double, 3>, std::uint32_t> places;
  std::vector<std::uint32_t> same;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Vec3d& x = points[i];
    if (!std::isfinite(x.x + x.y + x.z))
      refuse(name, "point " + std::to_string(i) + " is not finite; repair the file that it is from");
    same.push_back(places.try_emplace({x.x, x.y, x.z}, i).first->second);
  }
  return same;
}

/// Every edge is gone along as often in one direction as in the other.
void require_closed(const std::string& name, std::span<const Vec3d> points, const std::vector<Triangle>& triangles) {
  struct Edge {
    int sum = 0, count = 0;
  };
  std::map<std::array<std::uint32_t, 2>, Edge> edges;
  for (const Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      Edge& edge = edges[{std::min(a, b), std::max(a, b)}];
      edge.sum += a < b ? 1 : -1, ++edge.count;
    }
  }
  std::size_t open = 0, turned = 0;
  std::string first;
  for (const auto& [ends, edge] : edges) {
    if (edge.sum == 0) continue;
    ++(edge.count % 2 != 0 ? open : turned);
    if (first.empty()) first = place_text((points[ends[0]] + points[ends[1]]) * 0.5);
  }
  if (open > 0)
    refuse(name, "is open at " + std::to_string(open) + " edges, the first at " + first +
                     "; close its holes in the program that it is from, and join points that should be one");
  if (turned > 0)
    refuse(name, "has triangles that turn against their neighbours at " + std::to_string(turned) +
                     " edges, the first at " + first + "; orient its triangles alike in the program that it is from");
}

}  // namespace

BodyRegion surface_region(const std::string& name, std::span<const Vec3d> points, std::span<const Triangle> triangles) {
  const std::vector<std::uint32_t> same = welded(name, points);
  std::vector<Triangle> kept;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Triangle corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (triangles[t][i] >= points.size())
        refuse(name, "triangle " + std::to_string(t) + " has point " + std::to_string(triangles[t][i]) +
                         "; there are " + std::to_string(points.size()) + ", counted from 0");
      corners[i] = same[triangles[t][i]];
    }
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]) kept.push_back(corners);
  }
  if (kept.empty()) refuse(name, "has no triangles; give a closed surface");
  require_closed(name, points, kept);
  std::vector<Corners> placed;
  double volume = 0.0, extent = 0.0;
  for (const Triangle& t : kept) {
    const Corners c{points[t[0]], points[t[1]], points[t[2]]};
    for (const Vec3d& x : c) extent = std::max(extent, norm(x - points[kept.front()[0]]));
    const Vec3d from = points[kept.front()[0]];
    volume += dot(c[0] - from, cross(c[1] - from, c[2] - from)) / 6.0;
    if (squared(area_of(c)) > 0.0) placed.push_back(c);
  }
  if (!(std::abs(volume) > 1e-12 * extent * extent * extent))
    refuse(name, "has no volume within; give one that bounds a body");
  if (volume < 0.0) {
    for (Corners& c : placed) std::swap(c[1], c[2]);
  }
  const auto tree = std::make_shared<const SurfaceTree>(std::move(placed));
  const Vec3d air = (tree->box().max - tree->box().min) * 0.02;
  return {name, [tree](const Vec3d& p) { return tree->distance(p); }, {tree->box().min - air, tree->box().max + air}};
}

}  // namespace glisson
