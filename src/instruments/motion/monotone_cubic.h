// monotone_cubic.h — points in time joined by cubics whose slopes keep between the points.
//
// The slope at a point is that of the parabola through it and its neighbours, cut to twice the smaller of the two chords
// and 0 where these differ in sign: a cubic with such slopes at its ends is monotone.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "glisson/math.h"

namespace glisson {

/// Slope at the middle of three points, from the chords before and after and the widths they span.
inline double slope_between(double before, double after, double width_before, double width_after) {
  if (before * after <= 0.0) return 0.0;
  const double parabola = (before * width_after + after * width_before) / (width_before + width_after);
  const double most = 2.0 * std::min(std::abs(before), std::abs(after));
  return std::copysign(std::min(std::abs(parabola), most), before);
}
inline Vec3d slope_between(const Vec3d& before, const Vec3d& after, double width_before, double width_after) {
  Vec3d slope;
  for (std::size_t k = 0; k < 3; ++k) slope[k] = slope_between(before[k], after[k], width_before, width_after);
  return slope;
}

/// A curve through points of type V, double or Vec3d; constant before the first and after the last.
template <class V>
class MonotoneCubic {
 public:
  /// @param times  ascending, one or more @param points  as many
  MonotoneCubic(std::vector<double> times, std::vector<V> points)
      : times_(std::move(times)), points_(std::move(points)), slopes_(times_.size()) {
    const std::size_t n = times_.size();
    if (n < 2) return;
    const auto chord = [&](std::size_t i) { return (points_[i + 1] - points_[i]) * (1.0 / width(i)); };
    for (std::size_t i = 1; i + 1 < n; ++i) slopes_[i] = slope_between(chord(i - 1), chord(i), width(i - 1), width(i));
    slopes_.front() = chord(0);
    slopes_.back() = chord(n - 2);
  }

  V at(double time) const {
    if (time <= times_.front()) return points_.front();
    if (time >= times_.back()) return points_.back();
    const std::size_t i = piece(time);
    const double w = width(i), s = (time - times_[i]) / w, s2 = s * s, s3 = s2 * s, to = 3.0 * s2 - 2.0 * s3;
    return points_[i] + (points_[i + 1] - points_[i]) * to + slopes_[i] * (w * (s3 - 2.0 * s2 + s)) +
           slopes_[i + 1] * (w * (s3 - s2));
  }
  /// Its derivative; at the ends that from within, 0 beyond them.
  V slope(double time) const {
    if (times_.size() < 2 || time < times_.front() || time > times_.back()) return V{};
    const std::size_t i = time == times_.back() ? times_.size() - 2 : piece(time);
    const double w = width(i), s = (time - times_[i]) / w;
    return (points_[i + 1] - points_[i]) * (6.0 * s * (1.0 - s) / w) + slopes_[i] * ((3.0 * s - 4.0) * s + 1.0) +
           slopes_[i + 1] * ((3.0 * s - 2.0) * s);
  }

  const std::vector<double>& times() const { return times_; }
  const std::vector<V>& points() const { return points_; }

 private:
  double width(std::size_t i) const { return times_[i + 1] - times_[i]; }
  std::size_t piece(double time) const {
    return static_cast<std::size_t>(std::upper_bound(times_.begin(), times_.end(), time) - times_.begin()) - 1;
  }

  std::vector<double> times_;
  std::vector<V> points_, slopes_;
};

}  // namespace glisson
