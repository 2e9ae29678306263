// press_motion.cpp — ramp, press, hold and return as depth against time.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

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

void require(bool ok, const char* field, double value, const char* range) {
  if (ok) return;
  std::ostringstream text;
  text << "press motion: " << field << " = " << value << " is outside the allowed range, " << range;
  throw std::invalid_argument(text.str());
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

Motion press(const PressMotion& m) {
  require(m.velocity > 0.0 && std::isfinite(m.velocity), "velocity [m/s]", m.velocity, "> 0");
  require(m.depth > 0.0 && std::isfinite(m.depth), "depth [m]", m.depth, "> 0");
  require(m.start >= 0.0 && std::isfinite(m.start), "start [s]", m.start, ">= 0");
  require(m.ramp >= 0.0 && std::isfinite(m.ramp), "ramp [s]", m.ramp, ">= 0");
  require(m.hold >= 0.0 && std::isfinite(m.hold), "hold [s]", m.hold, ">= 0");
  const double length = norm(m.direction);
  require(length > 0.0 && std::isfinite(length), "length of direction", length, "> 0 (the direction must not be zero)");
  const Vec3d unit = m.direction * (1.0 / length);
  return [m, unit](double time) { return unit * press_depth(m, time); };
}

}  // namespace glisson
