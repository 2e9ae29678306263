// keep_volume.cpp — moves vertices off curved surfaces by so much that the regions keep their volumes.
#include "mesher/lattice/operations.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace glisson::lattice {
namespace {

constexpr double kMostShift = 0.09;  ///< of the edge: within the tenth of it that interfaces keep

/// Neighbours in the interface: those that have the surface and a face of it with the vertex.
void interface_neighbours(const TetComplex& c, std::uint32_t v, std::vector<std::uint32_t>& out) {
  out.clear();
  for (const std::uint32_t t : c.stars[v]) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (c.tets[t][i] == v) continue;
      const std::uint32_t other = c.across(t, i);
      if (other != ~0u && c.labels[other] == c.labels[t]) continue;
      for (std::size_t j = 0; j < 4; ++j) {
        if (j != i && c.tets[t][j] != v) out.push_back(c.tets[t][j]);
      }
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
}

}  // namespace

void keep_volume(Workspace& w, double floor) {
  TetComplex& c = w.complex;
  struct Shift {
    std::uint32_t vertex;
    Vec3d to;
  };
  std::vector<Shift> shifts;
  std::vector<std::uint32_t> around;
  for (std::uint32_t v = 0; v < c.points.size(); ++v) {
    const Mask surfaces = surfaces_of(c.masks[v]);
    if (c.stars[v].empty() || std::popcount(surfaces) != 1 || (c.masks[v] & kMarks)) continue;
    const auto k = static_cast<std::size_t>(std::countr_zero(surfaces));
    const Vec3d p = c.points[v], g = w.fields.gradient(k, p, w.edge(v));
    const double slope = norm(g);
    if (slope < 0.1) continue;
    interface_neighbours(c, v, around);
    double sum = 0.0;
    for (const std::uint32_t n : around) sum += w.fields.value(k, (p + c.points[n]) * 0.5);
    const double mean = sum / (slope * static_cast<double>(std::max<std::size_t>(1, around.size())));
    const double most = kMostShift * w.edge(v);
    shifts.push_back({v, p - g * (std::clamp(mean, -most, most) / slope)});
  }
  for (const Shift& s : shifts) {
    const double before = w.star_quality(s.vertex);
    const Vec3d from = c.points[s.vertex];
    for (const double part : {1.0, 0.5, 0.25}) {
      c.points[s.vertex] = from + (s.to - from) * part;
      if (w.star_quality(s.vertex) >= std::min(before, floor)) break;
      c.points[s.vertex] = from;
    }
  }
}

}  // namespace glisson::lattice
