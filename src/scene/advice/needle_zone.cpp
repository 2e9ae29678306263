#include "scene/advice/needle_zone.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glisson::advice {
namespace {

/// Of a regular tet of that volume [m].
double regular_edge(double volume) { return std::cbrt(6.0 * std::numbers::sqrt2 * volume); }

}  // namespace

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

}  // namespace glisson::advice
