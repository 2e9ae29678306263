// recorded_motion.cpp — a measured way, joined by cubics whose slopes keep between the points.
//
// The slope at a point is that of the parabola through it and its neighbours, cut to twice the smaller of the two chords
// and 0 where these differ in sign: a cubic with such slopes at its ends is monotone.
#include <algorithm>
#include <cmath>

#include "glisson/tool_motion.h"
#include "instruments/motion_check.h"

namespace glisson {
namespace {

/// Slope at the middle of three points, from the chords before and after and the widths they span.
double slope_between(double before, double after, double width_before, double width_after) {
  if (before * after <= 0.0) return 0.0;
  const double parabola = (before * width_after + after * width_before) / (width_before + width_after);
  const double most = 2.0 * std::min(std::abs(before), std::abs(after));
  return std::copysign(std::min(std::abs(parabola), most), before);
}

struct Record {
  std::vector<double> times;
  std::vector<Vec3d> points, slopes;

  explicit Record(const RecordedMotion& motion)
      : times(motion.times), points(motion.positions), slopes(motion.times.size()) {
    for (std::size_t i = 1; i + 1 < times.size(); ++i) {
      const double a = times[i] - times[i - 1], b = times[i + 1] - times[i];
      for (std::size_t k = 0; k < 3; ++k) {
        slopes[i][k] =
            slope_between((points[i][k] - points[i - 1][k]) / a, (points[i + 1][k] - points[i][k]) / b, a, b);
      }
    }
    slopes.front() = (points[1] - points[0]) * (1.0 / (times[1] - times[0]));
    const std::size_t n = times.size();
    slopes.back() = (points[n - 1] - points[n - 2]) * (1.0 / (times[n - 1] - times[n - 2]));
  }

  /// Position at a time of the record.
  Vec3d at(double time) const {
    if (time <= times.front()) return points.front();
    if (time >= times.back()) return points.back();
    const auto next = std::upper_bound(times.begin(), times.end(), time);
    const auto i = static_cast<std::size_t>(next - times.begin()) - 1;
    const double width = times[i + 1] - times[i], s = (time - times[i]) / width;
    const double s2 = s * s, s3 = s2 * s, to = 3.0 * s2 - 2.0 * s3;
    return points[i] + (points[i + 1] - points[i]) * to + slopes[i] * (width * (s3 - 2.0 * s2 + s)) +
           slopes[i + 1] * (width * (s3 - s2));
  }
};

void require_record(const RecordedMotion& m) {
  require_number("recorded motion: start [s]", m.start, Sign::not_negative);
  if (m.times.size() < 2 || m.times.size() != m.positions.size()) {
    throw std::invalid_argument("recorded motion: " + std::to_string(m.times.size()) + " times and " +
                                std::to_string(m.positions.size()) + " positions; give as many of both, two or more");
  }
  for (std::size_t i = 0; i < m.times.size(); ++i) {
    const bool finite = std::isfinite(m.times[i]) && std::isfinite(norm(m.positions[i]));
    if (finite && (i == 0 || m.times[i] > m.times[i - 1])) continue;
    throw std::invalid_argument("recorded motion: point " + std::to_string(i) +
                                " is not finite or not later than the one before it");
  }
}

}  // namespace

ToolPath recorded_path(const RecordedMotion& motion) {
  require_record(motion);
  const auto record = std::make_shared<const Record>(motion);
  const double shift = motion.times.front() - motion.start;
  const auto way = [record, shift](double time) { return record->at(time + shift) - record->points.front(); };
  return {way, motion.times.back() - shift};
}

}  // namespace glisson
