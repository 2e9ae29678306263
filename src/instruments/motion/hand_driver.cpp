// hand_driver.cpp — the spring between a device and the tool, taken at the end of each step: it only loses energy.
//
//   (m + h c + h² k) v⁺ = m v + h (k (x − y) + f),   y⁺ = y + h v⁺
#include <cmath>
#include <sstream>

#include "glisson/archive.h"
#include "glisson/instruments/tool_motion.h"
#include "instruments/motion/motion_check.h"

namespace glisson {

double largest_passive_stiffness(const HandCoupling& x) {
  const double c = x.damping;
  return (std::sqrt(c * c + 4.0 * x.device_damping * c) - c) / x.period;
}

HandDriver::HandDriver(const Pose& start, const HandCoupling& coupling)
    : start_(start), target_(start), coupling_(coupling), position_(start.position) {
  require_number("hand: stiffness [N/m]", coupling.stiffness, Sign::positive);
  require_number("hand: damping [N s/m]", coupling.damping, Sign::positive);
  require_number("hand: mass [kg]", coupling.mass, Sign::positive);
  require_number("hand: period [s]", coupling.period, Sign::positive);
  require_number("hand: device_damping [N s/m]", coupling.device_damping, Sign::not_negative);
  const double most = largest_passive_stiffness(coupling);
  if (coupling.stiffness <= most) return;
  std::ostringstream text;
  text << "hand: stiffness = " << coupling.stiffness << " N/m is not passive: with damping = " << coupling.damping
       << " N s/m, device_damping = " << coupling.device_damping << " N s/m and period = " << coupling.period
       << " s it may be at most " << most
       << " N/m, or the device could swing up; give less stiffness, a shorter period or a device with more damping";
  throw std::invalid_argument(text.str());
}

Vec3d HandDriver::device_force() const { return (position_ - target_.position) * coupling_.stiffness; }

Pose HandDriver::advance(double, double h, const Wrench& on_tool) {
  const auto& [k, c, m, period, device] = coupling_;
  const Vec3d impulse = ((target_.position - position_) * k + on_tool.force) * h;
  velocity_ = (velocity_ * m + impulse) * (1.0 / (m + h * c + h * h * k));
  position_ += velocity_ * h;
  return {position_, target_.axes};
}

void HandDriver::archive(Archive& ar) { ar(position_, velocity_, target_); }

}  // namespace glisson
