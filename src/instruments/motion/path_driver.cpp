// path_driver.cpp — paths that follow from the time alone: steady, strokes, sine.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/require_fields.h"
#include "glisson/instruments/tool_motion.h"

namespace glisson {
namespace {

/// A move of length L with a speed that rises and falls linearly over `ramp`, or as far as it comes.
struct Move {
  double length, velocity, ramp;  // of the speed: what it would be, or the peak of a short move

  Move(double length_of, const Stroke& stroke) : length(length_of), velocity(stroke.velocity), ramp(stroke.ramp) {
    if (length >= velocity * ramp) return;
    const double acceleration = velocity / ramp;
    ramp = std::sqrt(length / acceleration);
    velocity = acceleration * ramp;
  }
  double time() const { return length > 0.0 ? length / velocity + ramp : 0.0; }
  /// Where its speed or acceleration jumps, in a motion that it begins at a time.
  CornerTimes corners(double begin) const {
    return CornerTimes({begin, begin + ramp, begin + time() - ramp, begin + time()});
  }
  /// Way gone after time t of the move [m].
  double gone(double t) const {
    if (t <= 0.0) return 0.0;
    if (t >= time()) return length;
    if (t < ramp) return 0.5 * velocity * t * t / ramp;
    const double left = time() - t;
    if (left < ramp) return length - 0.5 * velocity * left * left / ramp;
    return velocity * (t - 0.5 * ramp);
  }
};

}  // namespace

PathDriver::PathDriver(const Pose& start, ToolPath path) : start_(start), path_(std::move(path)) {
  if (!path_.displacement) throw std::invalid_argument("path of a tool: no displacement was given");
}

Pose PathDriver::advance(double time, double h, const Wrench&) {
  return {start_.position + path_.displacement(time + h), start_.axes};
}

ToolPath press_path(const PressMotion& motion) { return {press(motion), press_end(motion)}; }

ToolPath steady_path(const SteadyMotion& m) {
  detail::require_fields("steady motion", m);
  const Vec3d velocity = m.direction * (m.velocity / norm(m.direction));
  const auto displacement = [m, velocity](double time) {
    const double t = std::max(0.0, time - m.start);
    return velocity * (t < m.ramp ? 0.5 * t * t / m.ramp : t - 0.5 * m.ramp);
  };
  return {{displacement, CornerTimes({m.start, m.start + m.ramp})}, {}};
}

Fault StrokeMotion::check() const { return {strokes.empty() ? "none were given; give one or more" : ""}; }

ToolPath stroke_path(const StrokeMotion& motion) {
  detail::require_fields("strokes", motion);
  double end = motion.start;
  Vec3d at{};
  CornerTimes corners;
  for (const Stroke& stroke : motion.strokes) {
    const Move move(norm(stroke.to - at), stroke);
    corners = corners.with(move.corners(end));
    end += move.time() + stroke.rest;
    at = stroke.to;
  }
  const auto displacement = [motion](double time) {
    double begin = motion.start;
    Vec3d from{};
    for (const Stroke& stroke : motion.strokes) {
      const Move move(norm(stroke.to - from), stroke);
      if (time < begin + move.time()) return from + (stroke.to - from) * (move.gone(time - begin) / move.length);
      begin += move.time() + stroke.rest;
      from = stroke.to;
      if (time < begin) break;
    }
    return from;
  };
  return {{displacement, corners}, end};
}

ToolPath sine_path(const SineMotion& m) {
  detail::require_fields("sine motion", m);
  const auto displacement = [m, along = unit(m.direction)](double time) {
    const double t = std::clamp(time - m.start, 0.0, m.duration);
    const double x = m.ramp > 0.0 ? std::min(1.0, t / m.ramp) : (t > 0.0 ? 1.0 : 0.0);
    const double depth = m.mean + m.amplitude * std::sin(2.0 * std::numbers::pi * m.frequency * t);
    return along * (x * x * (3.0 - 2.0 * x) * depth);
  };
  CornerTimes corners({m.start, m.start + std::min(m.ramp, m.duration), m.start + m.duration});
  corners.add_every(0.5 / m.frequency, m.start + 0.25 / m.frequency, m.start + m.duration);
  return {{displacement, corners}, m.start + m.duration};
}

}  // namespace glisson
