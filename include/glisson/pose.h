// pose.h — where a rigid body is and how it is turned.
#pragma once

#include <optional>

#include "glisson/field.h"
#include "glisson/math.h"
#include "glisson/time_function.h"

namespace glisson {

/// Position and rotation of a tool.
struct Pose {
  Vec3d position{};                 ///< of the tool's origin (its tip) [m]
  Mat3d axes = identity<double>();  ///< columns: the tool's own x, y, z in space; a rotation

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(no_key("position", &Pose::position, "m", Range{}), no_key("axes", &Pose::axes));
  }
  bool is_sound() const;  ///< all numbers are finite and the axes a rotation, to 1e-6
  Fault check() const;

  /// Where a point of the tool, given in its own coordinates, is in space, and back [m].
  Vec3d to_space(const Vec3d& own) const { return position + axes * own; }
  Vec3d to_own(const Vec3d& place) const { return transposed(axes) * (place - position); }
};

/// Rigid motion of space: a place x at its start is at position + axes x at time t.
using PoseMotion = TimeFunction<Pose>;

/// A rigid motion and its end [s]; none: it does not end.
struct RigidPath {
  PoseMotion pose;
  std::optional<double> end;
};

}  // namespace glisson
