// recorded_motion.cpp — a measured way, joined by cubics that do not go beyond its points.
#include <cmath>

#include "glisson/instruments/tool_motion.h"
#include "instruments/motion/monotone_cubic.h"
#include "instruments/motion/motion_check.h"

namespace glisson {
namespace {

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
  const auto record = std::make_shared<const MonotoneCubic<Vec3d>>(motion.times, motion.positions);
  const double shift = motion.times.front() - motion.start;
  const auto way = [record, shift](double time) { return record->at(time + shift) - record->points().front(); };
  return {way, motion.times.back() - shift};
}

}  // namespace glisson
