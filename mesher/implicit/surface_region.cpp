// surface_region.cpp — a closed surface of triangles as a shape: what is checked before it is one.
#include "glisson/surface_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "base/text.h"
#include "mesher/implicit/shape_node.h"
#include "mesher/implicit/surface_edges.h"
#include "mesher/implicit/surface_tree.h"

namespace glisson {
namespace {

using namespace detail;

class SurfaceNode final : public Solid::Node {
 public:
  explicit SurfaceNode(SurfaceTree tree) : Node(tree.box()), tree_(std::move(tree)) {}
  double formula(const Vec3d& p) const override { return tree_.distance(p); }

 private:
  SurfaceTree tree_;
};

[[noreturn]] void refuse_surface(const std::string& what) { throw std::invalid_argument(what); }

/// A kind of edge at which a surface does not close: how many there are, and where the first is.
struct Faults {
  std::size_t count = 0;
  std::string first;

  void add(const Vec3d& at) {
    if (++count == 1) first = place_text(at);
  }
  std::string text() const { return count_text(count, "edge", "edges") + ", the first at " + first; }
};

/// Every edge is gone along as often in one direction as in the other.
void require_closed(std::span<const Vec3d> points, const std::vector<Triangle>& triangles) {
  Faults open, turned, crowded;
  for (const auto& [ends, edge] : edge_uses(triangles)) {
    if (edge.sum == 0) continue;
    Faults& kind = edge.count == 1 ? open : edge.count == 2 ? turned : crowded;
    kind.add((points[ends[0]] + points[ends[1]]) * 0.5);
  }
  if (crowded.count > 0)
    refuse_surface(
        "has three or more triangles that bound nothing at " + crowded.text() +
        " (non-manifold); remove sheets within the body, or what is there twice, in the program that it is from");
  if (turned.count > 0)
    refuse_surface("has triangles that turn against their neighbours at " + turned.text() +
                   "; orient its triangles alike in the program that it is from");
  if (open.count > 0)
    refuse_surface("is open at " + open.text() +
                   "; repair_surface closes it, or the program that it is from: join points that should be one");
}

/// The corners of triangles with an area, their normals outward.
std::vector<Corners> outward(std::span<const Vec3d> points, const std::vector<Triangle>& triangles) {
  std::vector<Corners> placed;
  double volume = 0.0, extent = 0.0;
  const Vec3d from = points[triangles.front()[0]];
  for (const Triangle& t : triangles) {
    const Corners c{points[t[0]], points[t[1]], points[t[2]]};
    for (const Vec3d& x : c) extent = std::max(extent, norm(x - from));
    volume += dot(c[0] - from, cross(c[1] - from, c[2] - from)) / 6.0;
    if (squared(area_vector(c)) > 0.0) placed.push_back(c);
  }
  if (!(std::abs(volume) > 1e-12 * extent * extent * extent) || placed.empty())
    refuse_surface("has no volume within; give one that bounds a body");
  if (volume < 0.0) {
    for (Corners& c : placed) std::swap(c[1], c[2]);
  }
  return placed;
}

}  // namespace

Solid surface_solid(std::span<const Vec3d> points, std::span<const Triangle> triangles) {
  const std::vector<Triangle> kept = distinct_triangles(points, triangles);
  require_closed(points, kept);
  return Solid(std::make_shared<SurfaceNode>(SurfaceTree(outward(points, kept))));
}

BodyRegion surface_region(const std::string& name, std::span<const Vec3d> points, std::span<const Triangle> triangles) {
  try {
    return region_of(name, surface_solid(points, triangles));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("surface \"" + name + "\": " + error.what());
  }
}

}  // namespace glisson
