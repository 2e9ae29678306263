#include "glisson/instruments/instrument.h"

#include <stdexcept>

#include "glisson/archive.h"

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

void archive(Archive& ar, Pose& pose) { ar(pose.position, pose.axes); }
void archive(Archive& ar, InstrumentEvent& event) { ar(event.time, event.depth, event.event); }

void Instrument::archive_motion(Archive& ar) {
  ar(pose_, before_, forces_.normal, forces_.friction, forces_.cutting, forces_.torque, force_depth_, events_);
  driver_->archive(ar);
}

}  // namespace glisson
