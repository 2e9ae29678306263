#include "scene/advice/edge_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "scene/advice/seen_surface.h"

namespace glisson::advice {
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

/// Extent across the edge of the first triangle that the point would meet; 0: none.
double extent_at(const EdgePoint& p, const std::vector<Corners>& surface) {
  const Corners* t = met_by(p, surface);
  if (!t) return 0.0;
  const auto across = [&](const Vec3d& x) { return x.x * p.normal_x + x.y * p.normal_y; };
  const auto [low, high] = std::minmax({across((*t)[0]), across((*t)[1]), across((*t)[2])});
  return high - low;
}

}  // namespace

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

}  // namespace glisson::advice
