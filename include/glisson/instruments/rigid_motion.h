// rigid_motion.h — tools that turn: about an axis by an angle over time, and through poses of a table.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "glisson/instruments/instrument.h"
#include "glisson/pose.h"

namespace glisson {

/// Rotation about an axis that is fixed in space, by an angle over time: at a speed to an angle and, optionally, back, or
/// through angles of a table. Positive by the right hand along `axis`.
struct RotationMotion {
  static constexpr std::string_view kName = "rotation";
  Vec3d axis{};              ///< of any length, not zero
  Vec3d center{};            ///< a point of the axis [m]
  double angle_deg = 90.0;   ///< [°]
  double rate_deg_s = 90.0;  ///< angular speed [°/s]
  double start = 0.0;        ///< [s]
  double ramp = 0.0;         ///< time over which the speed rises from 0 [s]
  double hold = 0.0;         ///< rest at the angle [s]
  bool returns = false;      ///< turns back at the same speed after the hold
  /// In place of angle, speed, start, ramp, hold and return: angles at times, cubic between them with a continuous speed, without
  /// overshoot; constant before and after. Two or more [s, °].
  std::vector<double> times{}, angles_deg{};

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(
        field("axis", &RotationMotion::axis, "-", "direction of the axis, of any length; positive by the right hand")
            .direction()
            .must(),
        field("center", &RotationMotion::center, "m", "a point of the axis"),
        field("angle_deg", &RotationMotion::angle_deg, "deg", above(0), "how far it turns").keyed("angle_deg"),
        field("rate_deg_s", &RotationMotion::rate_deg_s, "deg/s", above(0), "angular speed").keyed("rate_deg_s"),
        field("start", &RotationMotion::start, "s", at_least(0), "start of the motion"),
        field("ramp", &RotationMotion::ramp, "s", at_least(0), "time over which the speed rises from 0"),
        field("hold", &RotationMotion::hold, "s", at_least(0), "rest at the angle"),
        field("returns", &RotationMotion::returns, "turn back at the same speed after the hold"),
        field("times", &RotationMotion::times, "s", "times of `angles_deg`, ascending, in place of the keys above")
            .otherwise("none"),
        field("angles_deg", &RotationMotion::angles_deg, "deg",
              "angles at `times_s`, joined smoothly without overshoot; constant before and after")
            .keyed("angles_deg")
            .otherwise("none"));
  }
  Fault check() const;
};

/// Angle at time t [rad]. @throws std::invalid_argument as rotation_path
double rotation_angle(const RotationMotion& motion, double time);
/// The rotation as a rigid motion. @throws std::invalid_argument naming the field, its value and the allowed range
RigidPath rotation_path(const RotationMotion& motion);

/// Poses of a table: positions joined by cubics without overshoot, rotations by the shortest turn at a constant angular
/// velocity between two poses.
struct PosesMotion {
  std::vector<double> times;                       ///< ascending [s], two or more
  std::vector<Vec3d> positions;                    ///< of the tool's origin [m]
  std::vector<std::array<double, 4>> quaternions;  ///< w, x, y, z, of any length but 0; q and −q are the same rotation
  double start = 0.0;                              ///< time of the run at which the first pose is taken [s]

  template <class Take>
  static constexpr auto fields(Take take) {
    using M = PosesMotion;
    return take(no_key("times", &M::times), no_key("positions", &M::positions), no_key("quaternions", &M::quaternions),
                no_key("start", &M::start, "s", at_least(0)));
  }
  Fault check() const;
};
/// The motion from the first pose: the tool's origin is at the first position then. @throws std::invalid_argument naming what is wrong
RigidPath poses_path(const PosesMotion& motion);

/// A tool that follows a rigid motion from its start.
class RigidDriver final : public ToolDriver {
 public:
  RigidDriver(const Pose& start, RigidPath path);
  Pose start() const override { return start_; }
  Pose advance(double time, double h, const Wrench& on_tool) override;
  std::optional<double> end() const override { return path_.end; }
  CornerTimes corners() const override { return path_.pose.corners; }

 private:
  Pose start_;
  RigidPath path_;
};

}  // namespace glisson
