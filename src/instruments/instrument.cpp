#include "glisson/instruments/instrument.h"

#include <stdexcept>

#include "base/past.h"

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
  PastWriter put(past);
  for (const Pose* pose : {&pose_, &before_}) {
    put(pose->position);
    for (const auto& row : pose->axes.m) past.insert(past.end(), row.begin(), row.end());
  }
  for (const Vec3d* f : {&forces_.normal, &forces_.friction, &forces_.cutting, &forces_.torque}) put(*f);
  put(force_depth_);
  put(static_cast<double>(events_.size()));
  for (const InstrumentEvent& e : events_) {
    put(e.time), put(e.depth), put(static_cast<double>(e.event.size()));
    past.insert(past.end(), e.event.begin(), e.event.end());
  }
  const std::vector<double> driver = driver_->past();
  put(static_cast<double>(driver.size()));
  past.insert(past.end(), driver.begin(), driver.end());
}

bool Instrument::restore_motion(std::span<const double>& past) {
  PastReader get(past);
  for (Pose* pose : {&pose_, &before_}) {
    pose->position = get.vector();
    for (auto& row : pose->axes.m) {
      for (double& a : row) a = get.number();
    }
  }
  for (Vec3d* f : {&forces_.normal, &forces_.friction, &forces_.cutting, &forces_.torque}) *f = get.vector();
  force_depth_ = get.number();
  constexpr std::size_t kEventNumbers = 3;  // or more
  events_.assign(get.count(kEventNumbers), {});
  for (InstrumentEvent& e : events_) {
    e.time = get.number(), e.depth = get.number();
    e.event.resize(get.count());
    for (char& letter : e.event) letter = static_cast<char>(get.whole());
  }
  const std::span<const double> driver = get.take(get.count());
  past = get.left();
  return get.ok() && driver_->restore(driver);
}

}  // namespace glisson
