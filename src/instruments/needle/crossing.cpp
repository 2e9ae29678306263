#include "instruments/needle/crossing.h"

#include <algorithm>

namespace glisson {
namespace {

constexpr double kSamePlace = 1e-9;  ///< [m]: hits of one side that are nearer to each other are one
constexpr double kNoGap = 1e-7;      ///< [m]: less between two stretches is none, as a tip of 0.1 µm would not feel

}  // namespace

std::optional<SurfaceHit> meet(const Vec3d& from, const Vec3d& direction, const std::array<Vec3d, 3>& present,
                               const std::array<Vec3d, 3>& rest) {
  const Vec3d e1 = present[1] - present[0], e2 = present[2] - present[0], p = cross(direction, e2);
  const double det = dot(e1, p);  // −direction · (e1 × e2)
  if (det == 0.0) return {};
  const Vec3d t = from - present[0], q = cross(t, e1);
  const double u = dot(t, p) / det, v = dot(direction, q) / det;
  if (!(u >= -1e-9 && v >= -1e-9 && u + v <= 1.0 + 1e-9)) return {};
  return SurfaceHit{dot(e2, q) / det, rest[0] * (1.0 - u - v) + rest[1] * u + rest[2] * v, det > 0.0};
}

void put_in_order(std::vector<SurfaceHit>& hits) {
  std::ranges::stable_sort(hits, {}, &SurfaceHit::way);
  const auto same = [](const SurfaceHit& a, const SurfaceHit& b) {
    return a.goes_in == b.goes_in && b.way - a.way < kSamePlace;
  };
  hits.erase(std::unique(hits.begin(), hits.end(), same), hits.end());
}

std::vector<TissueInterval> find_intervals(std::span<const SurfaceHit> hits, double length, bool inside) {
  std::vector<TissueInterval> all;
  int within = 0;  // bodies: pieces may overlap
  const auto go_in = [&](double way) {
    if (within++ > 0) return;
    const bool goes_on = !all.empty() && way - all.back().to < kNoGap;
    if (!goes_on) all.push_back({way, length});
  };
  const auto come_out = [&](double way) {
    if (within > 0 && --within == 0) all.back().to = way;
  };
  if (inside) go_in(0.0);
  for (const SurfaceHit& hit : hits) {
    if (inside && hit.goes_in && hit.way < kNoGap) continue;  // the surface at which it begins
    hit.goes_in ? go_in(hit.way) : come_out(hit.way);
  }
  if (within > 0) all.back().to = length;
  std::erase_if(all, [](const TissueInterval& i) { return i.to - i.from < kNoGap; });
  return all;
}

}  // namespace glisson
