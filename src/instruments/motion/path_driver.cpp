// path_driver.cpp — paths that follow from the time alone: steady, strokes, sine.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "glisson/instruments/tool_motion.h"
#include "instruments/motion/motion_check.h"

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

void require_stroke(const Stroke& stroke) {
  require_number("stroke: velocity [m/s]", stroke.velocity, Sign::positive);
  require_number("stroke: ramp [s]", stroke.ramp, Sign::not_negative);
  require_number("stroke: rest [s]", stroke.rest, Sign::not_negative);
  require_number("stroke: distance of `to` from the start [m]", norm(stroke.to), Sign::not_negative);
}

}  // namespace

PathDriver::PathDriver(const Pose& start, ToolPath path) : start_(start), path_(std::move(path)) {
  if (!path_.way) throw std::invalid_argument("path of a tool: no way was given");
}

Pose PathDriver::advance(double time, double h, const Wrench&) {
  return {start_.position + path_.way(time + h), start_.axes};
}

ToolPath press_path(const PressMotion& motion) { return {press(motion), press_end(motion)}; }

ToolPath steady_path(const SteadyMotion& m) {
  require_number("steady motion: velocity [m/s]", m.velocity, Sign::positive);
  require_number("steady motion: start [s]", m.start, Sign::not_negative);
  require_number("steady motion: ramp [s]", m.ramp, Sign::not_negative);
  const Vec3d velocity = unit_of("steady motion", m.direction) * m.velocity;
  const auto way = [m, velocity](double time) {
    const double t = std::max(0.0, time - m.start);
    return velocity * (t < m.ramp ? 0.5 * t * t / m.ramp : t - 0.5 * m.ramp);
  };
  return {way, {}};
}

ToolPath stroke_path(const StrokeMotion& motion) {
  require_number("strokes: start [s]", motion.start, Sign::not_negative);
  if (motion.strokes.empty()) throw std::invalid_argument("strokes: none were given; give one or more");
  double end = motion.start;
  Vec3d at{};
  for (const Stroke& stroke : motion.strokes) {
    require_stroke(stroke);
    end += Move(norm(stroke.to - at), stroke).time() + stroke.rest;
    at = stroke.to;
  }
  const auto way = [motion](double time) {
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
  return {way, end};
}

ToolPath sine_path(const SineMotion& m) {
  require_number("sine motion: amplitude [m]", m.amplitude, Sign::positive);
  require_number("sine motion: frequency [Hz]", m.frequency, Sign::positive);
  require_number("sine motion: start [s]", m.start, Sign::not_negative);
  require_number("sine motion: ramp [s]", m.ramp, Sign::not_negative);
  require_number("sine motion: duration [s]", m.duration, Sign::positive);
  require_number("sine motion: size of mean [m]", std::abs(m.mean), Sign::not_negative);
  const Vec3d unit = unit_of("sine motion", m.direction);
  const auto way = [m, unit](double time) {
    const double t = std::clamp(time - m.start, 0.0, m.duration);
    const double x = m.ramp > 0.0 ? std::min(1.0, t / m.ramp) : (t > 0.0 ? 1.0 : 0.0);
    const double depth = m.mean + m.amplitude * std::sin(2.0 * std::numbers::pi * m.frequency * t);
    return unit * (x * x * (3.0 - 2.0 * x) * depth);
  };
  return {way, m.start + m.duration};
}

}  // namespace glisson
