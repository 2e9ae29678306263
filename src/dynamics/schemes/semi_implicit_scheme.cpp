#include "dynamics/schemes/semi_implicit_scheme.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

namespace glisson {

SemiImplicitScheme::SemiImplicitScheme(Body body, const SimulationOptions& options)
    : ExplicitScheme(std::move(body), options, Drag::at_once), viscous_(ViscousSystem::needed(state_.body)) {
  watch_all_if_viscous();
}

void SemiImplicitScheme::watch_all_if_viscous() {
  if (!viscous_) return;
  std::vector<std::uint32_t> all(state_.body.vertex_count);
  std::iota(all.begin(), all.end(), 0U);
  watch(all);
}

void SemiImplicitScheme::attach(std::shared_ptr<Interaction> interaction, const BodyView& body) {
  if (viscous_) refuse_interactions();
  ExplicitScheme::attach(std::move(interaction), body);
}

void SemiImplicitScheme::take_over(const BodyChange& change) {
  ExplicitScheme::take_over(change);
  built_for_ = 0.0;
}

void SemiImplicitScheme::loads_changed(bool may_refuse) {
  ExplicitScheme::loads_changed(may_refuse);
  built_for_ = 0.0;
}

void SemiImplicitScheme::require_tissues(const BlockTissues& tissues) const {
  ExplicitScheme::require_tissues(tissues);
  for (const auto& [block, tissue] : tissues) {
    if (!(tissue.viscosity > 0.0) || interactions_.empty()) continue;
    throw std::invalid_argument("tissue \"" + tissue.name + "\": viscosity = " + std::to_string(tissue.viscosity) +
                                " Pa s, but the integrator semi_implicit does not support viscosity beside "
                                "instruments, needles and membranes; " +
                                "take integrator = central_difference, or model relaxation by maxwell branches");
  }
}

void SemiImplicitScheme::take_tissues(const TissueChange& change) {
  ExplicitScheme::take_tissues(change);
  viscous_ = ViscousSystem::needed(state_.body);
  watch_all_if_viscous();
  built_for_ = 0.0;
}

std::size_t SemiImplicitScheme::holding() const {
  const auto holds = [](const auto& base) { return !base.empty(); };
  return static_cast<std::size_t>(std::count_if(state_.base.begin(), state_.base.end(), holds));
}

void SemiImplicitScheme::build(double h) {
  built_holding_ = holding();
  for (auto* field : {&impulse_, &change_, &drag_}) field->assign(state_.body.vertex_count, Vec3d{});
  system_.build(state_.body, state_.gamma, h, state_.held_components(), state_.loads.dashpots());
  built_for_ = h;
}

void SemiImplicitScheme::archive_motion(Archive& ar) {
  ExplicitScheme::archive_motion(ar);
  double h = built_for_;
  std::vector<double> last = system_.last();
  ar(h, last);
  if (!ar.reads()) return;
  viscous_ = ViscousSystem::needed(state_.body);
  ar.check(!viscous_ || moving_->active().size() == state_.body.vertex_count);
  built_for_ = 0.0;
  if (!(h > 0.0)) return;
  build(h);
  ar.check(system_.set_last(last));
}

void SemiImplicitScheme::kick(double h) {
  if (!viscous_) {
    ExplicitScheme::kick(h);
    return;
  }
  if (h != built_for_ || holding() != built_holding_) build(h);
  const std::span<ActiveVertex> active = moving_->active();  // all vertices, in their order
  const std::span<const Vec3d> loads = kick_.loads(active);
  for (std::size_t i = 0; i < active.size(); ++i) {
    ActiveVertex& w = active[i];
    const Vec3d load = kick_.keep(i, w, loads);
    const ActiveKick::Kicked& at = kick_.all()[i];
    impulse_[i] = (w.elastic + w.viscous + at.weight + load - at.drag(w.velocity)) * h;
  }
  kick_.impose_motions(active);
  for (std::size_t i = 0; i < active.size(); ++i) {  // held components of the change are known now, others 0
    if (!(state_.body.masses[i] > 0.0)) active[i].velocity = {};
    change_[i] = active[i].velocity - kick_.all()[i].velocity_before;
  }
  system_.solve(impulse_, change_);
  system_.held_drag(change_, drag_);
  for (std::size_t i = 0; i < active.size(); ++i) {
    ActiveVertex& w = active[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double inertia = kick_.all()[i].mass + h * (kick_.all()[i].damping + kick_.all()[i].dashpot[axis]);
      const bool free = system_.is_free(3 * i + axis);
      if (free) w.velocity[axis] = kick_.all()[i].velocity_before[axis] + change_[i][axis];
      // C (v₊ − v₋): of free components from the equation itself, so that the books are exact
      w.viscous[axis] -= free ? (impulse_[i][axis] - inertia * change_[i][axis]) / h : drag_[i][axis];
    }
  }
}

}  // namespace glisson
