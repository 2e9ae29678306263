// press_motion.cpp — ramp, press, hold and return as depth against time.
#include <algorithm>
#include <cmath>

#include "base/require_fields.h"
#include "glisson/instruments/motion.h"

namespace glisson {
namespace {

/// Path covered after time t when the speed rises linearly over `ramp` [m].
double path(const PressMotion& m, double t) {
  if (t <= 0.0) return 0.0;
  if (t < m.ramp) return 0.5 * m.velocity * t * t / m.ramp;
  return m.velocity * (t - 0.5 * m.ramp);
}

/// Time from the start of the motion until the depth is reached [s].
double press_time(const PressMotion& m) {
  const double ramp_depth = 0.5 * m.velocity * m.ramp;
  if (m.depth < ramp_depth) return std::sqrt(2.0 * m.depth * m.ramp / m.velocity);
  return m.depth / m.velocity + 0.5 * m.ramp;
}

}  // namespace

double press_depth(const PressMotion& m, double time) {
  const double t = time - m.start, arrival = press_time(m), departure = arrival + m.hold;
  if (t <= arrival) return std::min(m.depth, path(m, t));
  if (!m.returns || t <= departure) return m.depth;
  return std::max(0.0, m.depth - path(m, t - departure));
}

double press_end(const PressMotion& m) {
  const double there = m.start + press_time(m) + m.hold;
  return m.returns ? there + press_time(m) : there;
}

CornerTimes press_corners(const PressMotion& m) {
  const double arrival = m.start + press_time(m), departure = arrival + m.hold;
  const double ramp = std::min(m.ramp, press_time(m));
  CornerTimes corners({m.start, m.start + ramp, arrival});
  return m.returns ? corners.with(CornerTimes({departure, departure + ramp, press_end(m)})) : corners;
}

Motion press(const PressMotion& m) {
  detail::require_fields("press motion", m);
  return {[m, along = unit(m.direction)](double time) { return along * press_depth(m, time); }, press_corners(m)};
}

}  // namespace glisson
