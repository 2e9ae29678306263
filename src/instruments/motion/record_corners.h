// record_corners.h — which points of a record are its corners: those that a line through fewer of them would miss.
//
// A record of a thousand points a second is no reason for a thousand steps: where it is straight, or straight but for noise, its
// points are no corners. A line through those kept is within a share of the record's extent of all points [DouglasPeucker1973].
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "glisson/time_function.h"

namespace glisson {

inline constexpr double kCornerShare = 0.005;  ///< of the extent of a record

/// @param times  ascending, two or more [s]
/// @param off  how far point i is off the line from point a to b, `share` of the way, over the extent of the record [-]
template <class Off>
CornerTimes record_corners(const std::vector<double>& times, const Off& off) {
  std::vector<double> kept{times.front(), times.back()};
  std::vector<std::pair<std::size_t, std::size_t>> spans{{0, times.size() - 1}};
  while (!spans.empty()) {
    const auto [a, b] = spans.back();
    spans.pop_back();
    double most = kCornerShare;
    std::size_t worst = a;
    for (std::size_t i = a + 1; i < b; ++i) {
      const double distance = off(i, a, b, (times[i] - times[a]) / (times[b] - times[a]));
      if (distance > most) most = distance, worst = i;
    }
    if (worst == a) continue;
    kept.push_back(double(times[worst]));
    spans.emplace_back(a, worst), spans.emplace_back(worst, b);
  }
  return CornerTimes(std::move(kept));
}

/// The largest distance of points from the first of them; `size` is the norm of a difference.
template <class V, class Size>
double extent_of(const std::vector<V>& points, const Size& size) {
  double most = 0.0;
  for (const V& p : points) {
    const double distance = size(p, points.front());
    most = distance > most ? distance : most;
  }
  return most;
}

}  // namespace glisson
