// rigid_path.cpp — see rigid_motion.h.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>

#include "base/require_fields.h"
#include "glisson/instruments/motion.h"
#include "glisson/instruments/rigid_motion.h"
#include "instruments/motion/monotone_cubic.h"
#include "instruments/motion/record_corners.h"

namespace glisson {
namespace {

using Quaternion = std::array<double, 4>;  // w, x, y, z

Mat3d matrix_of(const Quaternion& q) {
  const auto [w, x, y, z] = q;
  return {{{{1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)},
            {2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)},
            {2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)}}}};
}

Quaternion turn_about(const Vec3d& axis, double angle) {
  const double s = std::sin(0.5 * angle);
  return {std::cos(0.5 * angle), s * axis.x, s * axis.y, s * axis.z};
}

double dot4(const Quaternion& a, const Quaternion& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]; }

/// a* b: the turn from a to b, as seen in a.
Quaternion from_to(const Quaternion& a, const Quaternion& b) {
  const Vec3d u{-a[1], -a[2], -a[3]}, v{b[1], b[2], b[3]};
  const Vec3d w = v * a[0] + u * b[0] + cross(u, v);
  return {a[0] * b[0] - dot(u, v), w.x, w.y, w.z};
}

/// Rotation by `share` of the shortest turn from a to b, both of length 1 and on the same side.
Mat3d between(const Quaternion& a, const Quaternion& b, double share) {
  const Quaternion turn = from_to(a, b);
  const Vec3d axis{turn[1], turn[2], turn[3]};
  const double s = norm(axis);
  if (!(s > 0.0)) return matrix_of(a);
  const double angle = 2.0 * std::atan2(s, turn[0]);
  return matrix_of(a) * matrix_of(turn_about(axis * (1.0 / s), share * angle));
}

/// The press that has this angle for its depth, in degrees.
PressMotion as_press(const RotationMotion& m) {
  return {.velocity = m.rate_deg_s,
          .depth = m.angle_deg,
          .start = m.start,
          .ramp = m.ramp,
          .hold = m.hold,
          .returns = m.returns};
}

/// The place of the first time that is not later than the one before it, from 1 on; 0: they ascend.
std::size_t not_later(std::span<const double> times) {
  const auto at = std::adjacent_find(times.begin(), times.end(), std::not_fn(std::less<>()));
  return at == times.end() ? 0 : static_cast<std::size_t>(at - times.begin()) + 2;
}

}  // namespace

Fault PosesMotion::check() const {
  const std::size_t n = times.size();
  if (n < 2 || positions.size() != n || quaternions.size() != n) {
    return {std::to_string(n) + " times, " + std::to_string(positions.size()) + " positions and " +
            std::to_string(quaternions.size()) + " quaternions; give as many of each, two or more"};
  }
  if (const std::size_t k = not_later(times); k > 0)
    return {"pose " + std::to_string(k) + " is not later than the one before it"};
  for (std::size_t i = 0; i < n; ++i) {
    const double size = std::sqrt(dot4(quaternions[i], quaternions[i]));
    if (std::isfinite(times[i]) && std::isfinite(norm(positions[i])) && size > 1e-9 && std::isfinite(size)) continue;
    return {
        "pose " + std::to_string(i + 1) +
        " has numbers that are too large or a quaternion of length 0; the rotation by 0 is qw = 1, qx = qy = qz = 0"};
  }
  return {};
}

Fault RotationMotion::check() const {
  if (times.empty() && angles_deg.empty()) return {};
  if (times.size() < 2 || times.size() != angles_deg.size()) {
    return {std::to_string(times.size()) + " times and " + std::to_string(angles_deg.size()) +
                " angles; give as many of both, two or more",
            "times"};
  }
  if (const std::size_t k = not_later(times); k > 0)
    return {"number " + std::to_string(k) + " is not later than the one before it", "times"};
  return {};
}

double rotation_angle(const RotationMotion& m, double time) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  if (m.times.empty()) return kDegree * press_depth(as_press(m), time);
  return kDegree * MonotoneCubic<double>(m.times, m.angles_deg).at(time);
}

namespace {

CornerTimes corners_of(const RotationMotion& m) {
  if (m.times.empty()) return press_corners(as_press(m));
  const std::vector<double>& x = m.angles_deg;
  const double extent = extent_of(x, [](double a, double b) { return std::abs(a - b); });
  return record_corners(m.times, [&](std::size_t i, std::size_t a, std::size_t b, double share) {
    return extent > 0.0 ? std::abs(x[i] - std::lerp(x[a], x[b], share)) / extent : 0.0;
  });
}

double apart(const Quaternion& a, const Quaternion& b) {
  return std::sqrt(std::pow(a[0] - b[0], 2) + std::pow(a[1] - b[1], 2) + std::pow(a[2] - b[2], 2) +
                   std::pow(a[3] - b[3], 2));
}

/// Places and turns each over their own extent. @param times  of the run
CornerTimes corners_of(const std::vector<double>& times, const std::vector<Vec3d>& x,
                       const std::vector<Quaternion>& q) {
  const double far = extent_of(x, [](const Vec3d& a, const Vec3d& b) { return norm(a - b); });
  const double turned = extent_of(q, apart);
  return record_corners(times, [&](std::size_t i, std::size_t a, std::size_t b, double share) {
    Quaternion between;
    for (std::size_t k = 0; k < 4; ++k) between[k] = std::lerp(q[a][k], q[b][k], share);
    const double size = std::sqrt(dot4(between, between));
    for (double& part : between) part = size > 0.0 ? part / size : part;
    const double moved = far > 0.0 ? norm(x[i] - x[a] - (x[b] - x[a]) * share) / far : 0.0;
    return std::max(moved, turned > 0.0 ? apart(q[i], between) / turned : 0.0);
  });
}

}  // namespace

RigidPath rotation_path(const RotationMotion& m) {
  detail::require_fields("rotation", m);
  const auto turned = [m, axis = unit(m.axis)](double time) {
    Pose pose;
    pose.axes = matrix_of(turn_about(axis, rotation_angle(m, time)));
    pose.position = m.center - pose.axes * m.center;
    return pose;
  };
  return {{turned, corners_of(m)}, m.times.empty() ? press_end(as_press(m)) : m.times.back()};
}

RigidPath poses_path(const PosesMotion& motion) {
  detail::require_fields("poses", motion);
  std::vector<Quaternion> q = motion.quaternions;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const double size = std::sqrt(dot4(q[i], q[i]));
    const double sign = i > 0 && dot4(q[i - 1], q[i]) < 0.0 ? -1.0 : 1.0;
    for (double& x : q[i]) x *= sign / size;
  }
  const auto places = std::make_shared<const MonotoneCubic<Vec3d>>(motion.times, motion.positions);
  const auto moved = [places, q, shift = motion.times.front() - motion.start](double time) {
    const std::vector<double>& t = places->times();
    const double at = std::clamp(time + shift, t.front(), t.back());
    const auto after = std::upper_bound(t.begin() + 1, t.end() - 1, at) - t.begin();
    const auto i = static_cast<std::size_t>(after);
    Pose pose;
    pose.axes = between(q[i - 1], q[i], (at - t[i - 1]) / (t[i] - t[i - 1])) * transposed(matrix_of(q.front()));
    pose.position = places->at(at) - pose.axes * places->points().front();
    return pose;
  };
  std::vector<double> times = motion.times;
  for (double& time : times) time += motion.start - motion.times.front();
  return {{moved, corners_of(times, motion.positions, q)}, times.back()};
}

RigidDriver::RigidDriver(const Pose& start, RigidPath path) : start_(start), path_(std::move(path)) {
  if (!path_.pose) throw std::invalid_argument("rigid motion of a tool: no motion was given");
}

Pose RigidDriver::advance(double time, double h, const Wrench&) {
  const Pose motion = path_.pose(time + h);
  return {motion.to_space(start_.position), motion.axes * start_.axes};
}

}  // namespace glisson
