// recorded_motion.cpp — a measured path, joined by cubics that do not go beyond its points.
#include "base/require_fields.h"
#include "glisson/instruments/tool_motion.h"
#include "instruments/motion/monotone_cubic.h"
#include "instruments/motion/record_corners.h"

namespace glisson {

Fault RecordedMotion::check() const {
  if (times.size() < 2 || times.size() != positions.size()) {
    return {std::to_string(times.size()) + " times and " + std::to_string(positions.size()) +
            " positions; give as many of both, two or more"};
  }
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (!(times[i] > times[i - 1])) return {"point " + std::to_string(i) + " is not later than the one before it"};
  }
  return {};
}

namespace {

CornerTimes corners_of(const RecordedMotion& m, double shift) {
  const std::vector<Vec3d>& x = m.positions;
  const double extent = extent_of(x, [](const Vec3d& a, const Vec3d& b) { return norm(a - b); });
  std::vector<double> times = m.times;
  for (double& time : times) time -= shift;
  return record_corners(times, [&](std::size_t i, std::size_t a, std::size_t b, double share) {
    return extent > 0.0 ? norm(x[i] - x[a] - (x[b] - x[a]) * share) / extent : 0.0;
  });
}

}  // namespace

ToolPath recorded_path(const RecordedMotion& motion) {
  detail::require_fields("recorded motion", motion);
  const auto record = std::make_shared<const MonotoneCubic<Vec3d>>(motion.times, motion.positions);
  const double shift = motion.times.front() - motion.start;
  const auto displacement = [record, shift](double time) {
    return record->at(time + shift) - record->points().front();
  };
  return {{displacement, corners_of(motion, shift)}, motion.times.back() - shift};
}

}  // namespace glisson
