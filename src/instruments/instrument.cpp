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
  past.push_back(static_cast<double>(events_.size()));
  for (const InstrumentEvent& e : events_) {
    past.insert(past.end(), {e.time, e.depth, static_cast<double>(e.event.size())});
    past.insert(past.end(), e.event.begin(), e.event.end());
  }
  const std::vector<double> driver = driver_->past();
  past.push_back(static_cast<double>(driver.size()));
  past.insert(past.end(), driver.begin(), driver.end());
}

/// Takes a list of events off the front of `past`.
bool Instrument::restore_events(std::span<const double>& past) {
  const auto take = [&](double most) {
    const double value = past.empty() ? -1.0 : past.front();
    if (!past.empty()) past = past.subspan(1);
    return value >= 0.0 && value <= most ? static_cast<std::size_t>(value) : std::size_t(-1);
  };
  const std::size_t count = take(static_cast<double>(past.size()));
  if (count == std::size_t(-1)) return false;
  events_.assign(count, {});
  for (InstrumentEvent& e : events_) {
    if (past.size() < 3) return false;
    e.time = past[0], e.depth = past[1];
    past = past.subspan(2);
    const std::size_t letters = take(static_cast<double>(past.size()));
    if (letters > past.size()) return false;
    for (const double letter : past.first(letters)) e.event.push_back(static_cast<char>(letter));
    past = past.subspan(letters);
  }
  return true;
}

bool Instrument::restore_motion(std::span<const double>& past) {
  constexpr std::size_t kOwn = 2 * 12 + 4 * 3 + 1;
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
  past = past.subspan(at);
  if (!restore_events(past) || past.empty()) return false;
  const double size = past.front();
  past = past.subspan(1);
  if (!(size >= 0.0 && size <= static_cast<double>(past.size()))) return false;
  const auto n = static_cast<std::size_t>(size);
  if (!driver_->restore(past.first(n))) return false;
  past = past.subspan(n);
  return true;
}

}  // namespace glisson
