#include "glisson/instrument.h"

#include <stdexcept>

namespace glisson {

Instrument::Instrument(std::string name, std::shared_ptr<ToolDriver> driver, const Vec3d& direction)
    : name_(std::move(name)), driver_(std::move(driver)), direction_(direction) {
  if (driver_ == nullptr) throw std::invalid_argument("instrument " + name_ + ": no driver was given");
  if (!(norm(direction) > 0.0)) throw std::invalid_argument("instrument " + name_ + ": its direction is zero");
  direction_ = direction * (1.0 / norm(direction));
  pose_ = before_ = driver_->start();
  start_ = pose_.position;
}

double Instrument::depth() const { return dot(pose_.position - start_, direction_); }

void Instrument::drive(const InteractionStep& step) {
  force_depth_ = depth();
  before_ = pose_;
  pose_ = driver_->advance(step.time, step.h, {-forces_.total(), -forces_.torque});
}

void Instrument::save_motion(std::vector<double>& past) const {
  for (const Pose* pose : {&pose_, &before_}) {
    past.insert(past.end(), {pose->position.x, pose->position.y, pose->position.z});
    for (const auto& row : pose->axes.m) past.insert(past.end(), row.begin(), row.end());
  }
  for (const Vec3d* f : {&forces_.normal, &forces_.friction, &forces_.cutting, &forces_.torque}) {
    past.insert(past.end(), {f->x, f->y, f->z});
  }
  past.push_back(force_depth_);
  const std::vector<double> driver = driver_->past();
  past.push_back(static_cast<double>(driver.size()));
  past.insert(past.end(), driver.begin(), driver.end());
}

bool Instrument::restore_motion(std::span<const double>& past) {
  constexpr std::size_t kOwn = 2 * 12 + 4 * 3 + 2;
  if (past.size() < kOwn) return false;
  std::size_t at = 0;
  for (Pose* pose : {&pose_, &before_}) {
    for (std::size_t i = 0; i < 3; ++i) pose->position[i] = past[at++];
    for (auto& row : pose->axes.m) {
      for (double& a : row) a = past[at++];
    }
  }
  for (Vec3d* f : {&forces_.normal, &forces_.friction, &forces_.cutting, &forces_.torque}) {
    for (std::size_t i = 0; i < 3; ++i) (*f)[i] = past[at++];
  }
  force_depth_ = past[at++];
  const double size = past[at++];
  past = past.subspan(at);
  if (!(size >= 0.0 && size <= static_cast<double>(past.size()))) return false;
  const auto n = static_cast<std::size_t>(size);
  if (!driver_->restore(past.first(n))) return false;
  past = past.subspan(n);
  return true;
}

}  // namespace glisson
