// live_path.cpp — see live_path.h.
#include "view/engine/live_path.h"

#include <algorithm>
#include <cmath>

namespace glisson::view {

LivePath::LivePath(double speed, double ramp, std::optional<ToolPath> scene)
    : speed_(speed), ramp_(ramp), scene_(std::move(scene)) {}

Vec3d LivePath::at(double time) const {
  if (playing_) return scene_->displacement(time);
  return time >= now_.time ? now_.at(time) : before_.at(std::max(time, before_.time));
}

Vec3d LivePath::next_velocity(const Vec3d& from, double frame_s) const {
  const Vec3d left = target_ - from;
  const double length = norm(left);
  if (!(length > 1e-12)) return {};
  const Vec3d towards = left * (1.0 / length);
  const double most_change = speed_ / ramp_;
  const double had = std::max(0.0, dot(now_.velocity, towards));
  const double speed = std::min({had + most_change * frame_s, speed_, std::sqrt(2.0 * most_change * length)});
  return towards * std::min(speed, length / frame_s);
}

void LivePath::plan(double time, double frame_s) {
  if (playing_) {
    target_ = scene_->displacement(time);
    before_ = now_;
    now_ = {time, target_, (scene_->displacement(time + frame_s) - target_) * (1.0 / frame_s)};
    playing_ = !scene_->end || time < *scene_->end;
    return;
  }
  const Vec3d from = at(time);
  const Vec3d velocity = next_velocity(from, frame_s);
  before_ = now_;
  now_ = {time, from, velocity};
}

void LivePath::restart() {
  before_ = now_ = {};
  target_ = {};
  playing_ = false;
}

void LivePath::set_target(const Vec3d& target) {
  playing_ = false;
  target_ = target;
}

}  // namespace glisson::view
