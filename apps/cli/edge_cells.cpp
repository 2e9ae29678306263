// edge_cells.cpp — see edge_cells.h.
#include "cli/edge_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <vector>

namespace glisson::app {
namespace {

/// A point of the edge and its outward normal, in the plane of the face.
struct EdgePoint {
  double x, y, normal_x, normal_y;
};

struct Edge {
  std::vector<EdgePoint> points;
  double size = 0.0, rounding = 0.0;  // [m]
};

Edge edge_of(const FlatPunch& punch) {
  constexpr int kPoints = 32;
  Edge edge{.points = {}, .size = punch.radius, .rounding = punch.edge_radius};
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / kPoints, c = std::cos(angle), s = std::sin(angle);
    edge.points.push_back({punch.radius * c, punch.radius * s, c, s});
  }
  return edge;
}

Edge edge_of(const Block& block) {
  constexpr int kPoints = 8;  // a side
  const double a = 0.5 * block.size.x, b = 0.5 * block.size.y;
  Edge edge{.points = {}, .size = std::min(a, b), .rounding = block.edge_radius};
  for (int i = 0; i < kPoints; ++i) {
    const double along = 2.0 * (i + 0.5) / kPoints - 1.0;
    for (const double side : {-1.0, 1.0}) {
      edge.points.push_back({side * a, along * b, side, 0.0});
      edge.points.push_back({along * a, side * b, 0.0, side});
    }
  }
  return edge;
}

template <class Other>
Edge edge_of(const Other&) {
  return {};
}

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

/// Extent across the edge of the first triangle that the point would meet; 0: none.
double extent_at(const EdgePoint& p, const std::vector<Corners>& surface) {
  const Corners* t = met_by(p, surface);
  if (!t) return 0.0;
  const auto across = [&](const Vec3d& x) { return x.x * p.normal_x + x.y * p.normal_y; };
  const auto [low, high] = std::minmax({across((*t)[0]), across((*t)[1]), across((*t)[2])});
  return high - low;
}

double mean_edge(const Corners& t) { return (norm(t[1] - t[0]) + norm(t[2] - t[1]) + norm(t[0] - t[2])) / 3.0; }

/// Half the extent of an instrument's footprint along its own x and y; 0: it has none.
struct Footprint {
  double x = 0.0, y = 0.0;
  bool round = true;
};
Footprint footprint_of(const FlatPunch& s) { return {s.radius, s.radius}; }
Footprint footprint_of(const Ball& s) { return {s.radius, s.radius}; }
Footprint footprint_of(const NeedleShape& s) { return {0.5 * s.diameter, 0.5 * s.diameter}; }
Footprint footprint_of(const Block& s) { return {0.5 * s.size.x, 0.5 * s.size.y, false}; }
template <class Other>
Footprint footprint_of(const Other&) {
  return {};
}

void add(PressedFaces& faces, const Corners& t) { ++faces.count, faces.edge += mean_edge(t); }

/// The surface in the axes of the instrument at its start, whose own z axis points back along its direction.
std::vector<Corners> seen_from(const Pose& pose, const TetMesh& mesh) {
  std::vector<Corners> surface;
  for (const Triangle& t : boundary_triangles(mesh)) {
    Corners corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d from = mesh.vertices[t[i]] - pose.position;
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t k = 0; k < 3; ++k) corners[i][axis] += pose.axes(k, axis) * from[k];
    }
    surface.push_back(corners);
  }
  return surface;
}

/// Nine points a side are more than kFew faces.
PressedFaces faces_in(const Footprint& print, const std::vector<Corners>& surface) {
  constexpr int kSide = 9;
  std::set<const Corners*> met;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const double a = 2.0 * (i + 0.5) / kSide - 1.0, b = 2.0 * (j + 0.5) / kSide - 1.0;
      if (print.round && a * a + b * b > 1.0) continue;
      if (const Corners* t = met_by(Vec3d{a * print.x, b * print.y, 0.0}, surface)) met.insert(t);
    }
  }
  PressedFaces faces{.size = 2.0 * std::min(print.x, print.y)};
  for (const Corners* t : met) add(faces, *t);
  if (faces.count > 0) faces.edge /= static_cast<double>(faces.count);
  return faces;
}

/// Of a regular tet of that volume [m].
double regular_edge(double volume) { return std::cbrt(6.0 * std::numbers::sqrt2 * volume); }

}  // namespace

double PressedFaces::finer() const {
  const double by_count = std::sqrt(static_cast<double>(kFew) / static_cast<double>(std::max<std::size_t>(count, 1)));
  return std::max(by_count, size > 0.0 ? edge / (kCoarse * size) : 1.0);
}

PressedFaces faces_of_pad(const TetMesh& mesh, const std::string& set) {
  const auto found = mesh.vertex_sets.find(set);
  PressedFaces faces;
  if (found == mesh.vertex_sets.end()) return faces;
  const auto held = [&](std::uint32_t v) { return std::binary_search(found->second.begin(), found->second.end(), v); };
  double area = 0.0;
  for (const Triangle& t : boundary_triangles(mesh)) {
    if (!std::all_of(t.begin(), t.end(), held)) continue;
    const Corners corners{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    add(faces, corners);
    area += 0.5 * norm(cross(corners[1] - corners[0], corners[2] - corners[0]));
  }
  if (faces.count > 0) faces.edge /= static_cast<double>(faces.count);
  faces.size = std::sqrt(4.0 * area / std::numbers::pi);
  return faces;
}

std::optional<PressedFaces> faces_under(const TetMesh& mesh, const InstrumentSpec& instrument) {
  const auto* contact = std::get_if<ContactOptions>(&instrument.what);
  if (!contact) return {};
  const Footprint print = std::visit([](const auto& shape) { return footprint_of(shape); }, contact->shape);
  if (print.x == 0.0) return {};
  const PressedFaces faces = faces_in(print, seen_from(start_pose(instrument, mesh), mesh));
  if (faces.count == 0) return {};
  return faces;
}

std::optional<EdgeCells> cells_under_edge(const TetMesh& mesh, const InstrumentSpec& instrument) {
  const auto* contact = std::get_if<ContactOptions>(&instrument.what);
  if (!contact) return {};
  const Edge edge = std::visit([](const auto& shape) { return edge_of(shape); }, contact->shape);
  if (edge.points.empty()) return {};
  const std::vector<Corners> surface = seen_from(start_pose(instrument, mesh), mesh);
  std::vector<double> extents;
  for (const EdgePoint& p : edge.points) {
    if (const double extent = extent_at(p, surface); extent > 0.0) extents.push_back(extent);
  }
  if (extents.empty()) return {};
  const auto middle = extents.begin() + static_cast<std::ptrdiff_t>(extents.size() / 2);
  std::nth_element(extents.begin(), middle, extents.end());
  if (*middle <= edge.rounding) return {};
  return EdgeCells{.across = *middle, .size = edge.size};
}

std::optional<ZoneEdges> edges_in_zone(const TetMesh& mesh, const InstrumentSpec& instrument) {
  const auto* needle = std::get_if<NeedleOptions>(&instrument.what);
  if (!needle) return {};
  const Vec3d tip = start_pose(instrument, mesh).position, along = unit(needle->direction);
  double volume = 0.0, count = 0.0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Vec3d centre;
    for (const std::uint32_t v : mesh.tets[t]) centre += mesh.vertices[v] * 0.25;
    const Vec3d from = centre - tip;
    const double depth = dot(from, along), own = six_rest_volume(mesh, t) / 6.0;
    if (depth < 0.0 || norm(from - along * depth) > std::max(needle->zone, regular_edge(own))) continue;
    volume += own;
    count += 1.0;
  }
  if (count == 0.0) return {};
  return ZoneEdges{.edge = regular_edge(volume / count), .zone = needle->zone};
}

}  // namespace glisson::app
