// hand_driver.cpp — the spring between a device and the tool, taken at the end of each step: it only loses energy.
//
//   (m + h c + h² k) v⁺ = m v + h (k (x − y) + f),   y⁺ = y + h v⁺
#include <cmath>
#include <sstream>

#include "base/require_fields.h"
#include "glisson/archive.h"
#include "glisson/instruments/tool_motion.h"

namespace glisson {

double largest_passive_stiffness(const HandCoupling& x) {
  const double c = x.damping;
  return (std::sqrt(c * c + 4.0 * x.device_damping * c) - c) / x.period;
}

HandDriver::HandDriver(const Pose& start, const HandCoupling& coupling)
    : start_(start), target_(start), coupling_(coupling), position_(start.position) {
  detail::require_fields("hand", coupling);
}

Fault HandCoupling::check() const {
  const double most = largest_passive_stiffness(*this);
  if (stiffness <= most) return {};
  std::ostringstream text;
  text << stiffness << " N/m is not passive: with damping = " << damping
       << " N s/m, device_damping = " << device_damping << " N s/m and period = " << period << " s it may be at most "
       << most
       << " N/m, or the device could swing up; give less stiffness, a shorter period or a device with more damping";
  return {text.str(), "stiffness"};
}

Vec3d HandDriver::device_force() const { return (position_ - target_.position) * coupling_.stiffness; }

Pose HandDriver::advance(double time, double h, const Wrench& on_tool) {
  first_position_ = position_, first_velocity_ = velocity_;
  return advance_under(time, h, on_tool);
}

Pose HandDriver::advance_under(double, double h, const Wrench& on_tool) {
  const auto& [k, c, m, period, device] = coupling_;
  const Vec3d impulse = ((target_.position - first_position_) * k + on_tool.force) * h;
  velocity_ = (first_velocity_ * m + impulse) * (1.0 / (m + h * c + h * h * k));
  position_ = first_position_ + velocity_ * h;
  return {position_, target_.axes};
}

void HandDriver::archive(Archive& ar) { ar(position_, velocity_, target_, first_position_, first_velocity_); }

}  // namespace glisson
