// push_driver.cpp — a mass that is pushed, and a step of it that stiff contact cannot throw back.
//
//   (m + h c + h² k̂) v⁺ = m v + h (F + f),   y⁺ = y + h v⁺        f the tissue's answer of the last step
//
// An answer f = −k y is borne where h² k < 4 m + 2 h² k̂, a mass that is dragged along where it is lighter than m. Both show in
// the change of the answer over the last displacement, k̂ = −Δf·Δy/Δy²; it is used where h² k̂ > m only. In a long step f is the answer
// at its end, which is found with the rows of the tool (contact/tool_yield.h), and k̂ serves the first guess alone.
#include <algorithm>
#include <cmath>

#include "base/require_fields.h"
#include "glisson/archive.h"
#include "glisson/instruments/tool_motion.h"

namespace glisson {
namespace {

constexpr double kForgets = 0.98;       // of k̂, each step
constexpr double kLeastTravel = 1e-10;  // over which a change of force says something [m]

}  // namespace

PushDriver::PushDriver(const Pose& start, PushMotion motion) : start_(start), motion_(std::move(motion)) {
  if (!motion_.force) throw std::invalid_argument("push: no force was given");
  detail::require_fields("push", motion_);
  motion_.direction *= 1.0 / norm(motion_.direction);
}

void PushDriver::learn_stiffness(const Vec3d& force) {
  const Vec3d moved = travel_ - last_travel_;
  const double squared = dot(moved, moved);
  stiffness_ *= kForgets;
  if (squared > kLeastTravel * kLeastTravel) {
    stiffness_ = std::max(stiffness_, -dot(force - last_force_, moved) / squared);
  }
  last_travel_ = travel_;
  last_force_ = force;
}

/// What of a force moves the tool.
Vec3d PushDriver::along(const Vec3d& force) const {
  const Vec3d& d = motion_.direction;
  return motion_.guided ? d * dot(force, d) : force;
}

Pose PushDriver::advance(double time, double h, const Wrench& on_tool) {
  const Vec3d answer = along(on_tool.force);
  if (std::isfinite(norm(answer))) learn_stiffness(answer);
  first_travel_ = travel_, first_velocity_ = velocity_;
  const double stiff = h * h * stiffness_ > motion_.mass ? h * h * stiffness_ : 0.0;
  return go(motion_.force(time), h, answer, stiff);
}

Pose PushDriver::advance_under(double time, double h, const Wrench& at_end) {
  return go(motion_.force(time + h), h, along(at_end.force), 0.0);
}

/// From the start of the step.
Pose PushDriver::go(double push, double h, const Vec3d& answer, double stiff) {
  const Vec3d& d = motion_.direction;
  const Vec3d impulse = (d * push + answer) * h;
  if (!std::isfinite(norm(impulse))) {  // the tool rejects it for its pose, and stays
    travel_ = first_travel_, velocity_ = {};
    return {impulse, start_.axes};
  }
  velocity_ = (first_velocity_ * motion_.mass + impulse) * (1.0 / (motion_.mass + h * motion_.damping + stiff));
  travel_ = first_travel_ + velocity_ * h;
  const double beyond = motion_.stop ? dot(travel_, d) - *motion_.stop : 0.0;
  if (beyond > 0.0) {
    travel_ = travel_ - d * beyond;
    velocity_ = velocity_ - d * std::max(0.0, dot(velocity_, d));
  }
  return {start_.position + travel_, start_.axes};
}

std::shared_ptr<const void> PushDriver::save_state() const {
  return std::make_shared<const PushState>(static_cast<const PushState&>(*this));
}

void PushDriver::load_state(const std::shared_ptr<const void>& state) {
  static_cast<PushState&>(*this) = *std::static_pointer_cast<const PushState>(state);
}

void PushDriver::archive(Archive& ar) {
  ar(travel_, velocity_, last_travel_, last_force_, stiffness_, first_travel_, first_velocity_);
}

}  // namespace glisson
