#include "dynamics/schemes/viscous_drag.h"

namespace glisson {

void StagedDrag::begin(MovingBody& moving) {
  tell_held(moving);
  moving.push_in_stages(outer_);
  tell_rows(moving);
}

/// Tells the body what supports and motions hold by now.
void StagedDrag::tell_held(MovingBody& moving) {
  std::vector<char> holding;
  for (std::size_t c = 0; c < state_.base.size(); ++c) holding.push_back(state_.holds(c) ? 1 : 0);
  if (told_ == holding) return;
  held_components_ = state_.held_components();
  moving.hold_in_stages(held_components_);
  told_ = std::move(holding);
}

/// Tells it what interactions held in the last step.
void StagedDrag::tell_rows(MovingBody& moving) {
  if (rows_.empty()) return moving.project_stages(nullptr);
  inverse_mass_.clear();
  for (const ActiveVertex& w : moving.active()) {
    const double m = state_.body.inertia(w.vertex);
    Vec3d& inverse = inverse_mass_.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      inverse[axis] = m > 0.0 && held_components_[3 * w.vertex + axis] == 0 ? 1.0 / m : 0.0;
    }
  }
  holds_.set(rows_, moving.active(), inverse_mass_);
  moving.project_stages(holds_.empty() ? nullptr : &holds_);
}

void StagedDrag::tissue_pushed(std::span<const ActiveVertex> active) {
  tissue_.clear();
  for (const ActiveVertex& w : active) tissue_.push_back(w.elastic + w.viscous);
}

void StagedDrag::end(std::span<const ActiveVertex> active, const ActiveKick& kick, const Interactions& interactions) {
  outer_.clear();
  for (std::size_t k = 0; k < active.size(); ++k) {
    const ActiveKick::Kicked& at = kick.all()[k];
    outer_.push_back(active[k].elastic + active[k].viscous - tissue_[k] + at.load + at.contact);
  }
  interactions.list_held(rows_);
}

void StagedDrag::follow(std::span<const std::uint32_t> before, std::span<const ActiveVertex> active) {
  if (!outer_.empty()) follow_active(before, active, outer_, outer_before_);
}

void StagedDrag::state_set() {
  outer_.clear();
  rows_.clear();
}

void StagedDrag::archive(Archive& ar, std::size_t active_count) {
  auto known = static_cast<std::uint32_t>(outer_.size());
  ar(known);
  ar.check(known == 0 || known == active_count);
  outer_.resize(known);
  ar.same_size(outer_);
  ar(rows_);
}

}  // namespace glisson
