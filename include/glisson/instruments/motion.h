// motion.h — the press of a tool.
#pragma once

#include "glisson/math.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

/// Press along a direction to a depth, optionally hold, optionally return.
struct PressMotion {
  static constexpr std::string_view kName = "press";
  Vec3d direction{0.0, 0.0, -1.0};  ///< need not be a unit vector; not zero
  double velocity = 0.01;           ///< speed [m/s]
  double depth = 0.01;              ///< [m]
  double start = 0.0;               ///< time at which the motion begins [s]; give it to drive() as `from` too
  double ramp = 0.0;     ///< time of a linear rise of the speed from 0 [s]; 0: a sudden start, as in the paper
  double hold = 0.0;     ///< rest at depth [s]
  bool returns = false;  ///< withdraw at the same speed after the hold

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("direction", &PressMotion::direction, "-", "direction of pressing, of any length").direction(),
                field("velocity", &PressMotion::velocity, "mm/s", above(0), "speed"),
                field("depth", &PressMotion::depth, "mm", above(0), "how far it presses"),
                field("start", &PressMotion::start, "s", at_least(0), "start of the motion"),
                field("ramp", &PressMotion::ramp, "s", at_least(0),
                      "time over which the speed rises from 0; 0: a sudden start, as in the paper"),
                field("hold", &PressMotion::hold, "s", at_least(0), "rest at depth"),
                field("returns", &PressMotion::returns, "withdraw at the same speed after the hold"));
  }
};

/// Depth along the direction at time t [m].
double press_depth(const PressMotion& motion, double time);
/// Time at which the motion has ended [s].
double press_end(const PressMotion& motion);
/// Where its speed or acceleration jumps.
CornerTimes press_corners(const PressMotion& motion);
/// The motion as displacement for Simulation::drive.
/// @throws std::invalid_argument naming the field, its value and the allowed range
Motion press(const PressMotion& motion);

}  // namespace glisson
