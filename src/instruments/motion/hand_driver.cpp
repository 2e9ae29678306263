// hand_driver.cpp — the spring between a device and the tool, taken at the end of each step: it only loses energy.
//
//   (m + h c + h² k) v⁺ = m v + h (k (x − y) + f),   y⁺ = y + h v⁺
#include <cmath>
#include <memory>
#include <sstream>

#include "base/require_fields.h"
#include "glisson/archive.h"
#include "glisson/instruments/tool_motion.h"

namespace glisson {

double largest_passive_stiffness(const HandCoupling& x) {
  const double c = x.damping;
  return (std::sqrt(c * c + 4.0 * x.device_damping * c) - c) / x.period;
}

HandDriver::HandDriver(const Pose& start, const HandCoupling& coupling) : start_(start), coupling_(coupling) {
  detail::require_fields("hand", coupling);
  detail::require_fields("hand: start", start);
  target_ = start, position_ = start.position;
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
  const double k = coupling_.stiffness, c = coupling_.damping, m = coupling_.mass;
  const Vec3d impulse = ((target_.position - first_position_) * k + on_tool.force) * h;
  velocity_ = (first_velocity_ * m + impulse) * (1.0 / (m + h * c + h * h * k));
  position_ = first_position_ + velocity_ * h;
  return {position_, target_.axes};
}

/// Why a target makes no sense; empty where it does.
std::string HandDriver::fault_of(const Pose& target) const {
  if (!bounds_.holds(target)) return bounds_.fault_of(target);
  const double speed = norm(target.position - target_.position) / (static_cast<double>(missed_ + 1) * coupling_.period);
  if (!coupling_.most_speed || speed <= *coupling_.most_speed) return {};
  std::ostringstream text;
  text << "it is " << speed
       << " m/s from the last good target, where the allowed range is 0 to most_speed = " << *coupling_.most_speed
       << " m/s; raise most_speed, or leave such poses out";
  return text.str();
}

void HandDriver::set_target(const Pose& target) {
  const std::string fault = fault_of(target);
  if (!fault.empty()) {
    ++missed_;
    throw std::invalid_argument("set_target: " + fault);
  }
  take(target);
}

void HandDriver::take(const Pose& target) {
  target_ = target;
  missed_ = 0;
}

void HandDriver::set_bounds(const PoseBounds& bounds) {
  bounds_ = bounds;
  if (bounds_.holds(target_)) return;
  ++rejected_;
  target_ = start_;
}

bool HandDriver::offer_target(const Pose& target) {
  if (!fault_of(target).empty()) {
    ++rejected_, ++missed_;
    return false;
  }
  take(target);
  return true;
}

std::shared_ptr<const void> HandDriver::save_state() const {
  return std::make_shared<const HandState>(static_cast<const HandState&>(*this));
}

void HandDriver::load_state(const std::shared_ptr<const void>& state) {
  static_cast<HandState&>(*this) = *std::static_pointer_cast<const HandState>(state);
}

void HandDriver::archive(Archive& ar) { ar(position_, velocity_, target_, first_position_, first_velocity_); }

}  // namespace glisson
