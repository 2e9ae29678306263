#include "dynamics/schemes/semi_implicit_scheme.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

namespace glisson {

SemiImplicitScheme::SemiImplicitScheme(Body body, const SimulationOptions& options)
    : ExplicitScheme(std::move(body), options, Drag::at_once), viscous_(ViscousSystem::needed(body_)) {
  watch_all_if_viscous();
}

void SemiImplicitScheme::watch_all_if_viscous() {
  if (!viscous_) return;
  std::vector<std::uint32_t> all(body_.vertex_count);
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

void SemiImplicitScheme::require_tissues(const BlockTissues& tissues) const {
  ExplicitScheme::require_tissues(tissues);
  for (const auto& [block, tissue] : tissues) {
    if (!(tissue.viscosity > 0.0) || !has_interactions()) continue;
    throw std::invalid_argument(
        "tissue \"" + tissue.name + "\": viscosity = " + std::to_string(tissue.viscosity) +
        " Pa s, but the integrator semi_implicit does not bear viscosity beside instruments, needles and membranes; " +
        "take integrator = explicit, or model relaxation by maxwell branches");
  }
}

void SemiImplicitScheme::take_tissues(const TissueChange& change) {
  ExplicitScheme::take_tissues(change);
  viscous_ = ViscousSystem::needed(body_);
  watch_all_if_viscous();
  built_for_ = 0.0;
}

void SemiImplicitScheme::build(double h) {
  std::vector<char> held(3 * body_.vertex_count, 0);
  for (std::size_t i = 0; i < body_.vertex_count; ++i) {
    if (!(body_.masses[i] > 0.0)) held[3 * i] = held[3 * i + 1] = held[3 * i + 2] = 1;
  }
  built_holding_ = 0;
  for (std::size_t c = 0; c < base_.size(); ++c) {
    if (!holds(c)) continue;
    ++built_holding_;
    for (const std::uint32_t v : constraints_.all()[c].vertices) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (has_axis(constraints_.all()[c].axes, axis)) held[3 * v + axis] = 1;
      }
    }
  }
  for (auto* field : {&impulse_, &change_, &drag_}) field->assign(body_.vertex_count, Vec3d{});
  system_.build(body_, gamma_, h, std::move(held));
  built_for_ = h;
}

void SemiImplicitScheme::save(CheckpointWriter& out) const {
  ExplicitScheme::save(out);
  out.put(built_for_);
  out.put(system_.last());
}

void SemiImplicitScheme::load(CheckpointReader& in) {
  ExplicitScheme::load(in);
  const auto h = in.get<double>();
  std::vector<double> last;
  in.get(last);
  built_for_ = 0.0;
  if (!(h > 0.0)) return;
  build(h);
  if (!system_.set_last(last)) CheckpointReader::fail();
}

void SemiImplicitScheme::kick(double h) {
  if (!viscous_) {
    ExplicitScheme::kick(h);
    return;
  }
  const std::size_t holding = static_cast<std::size_t>(
      std::count_if(base_.begin(), base_.end(), [](const auto& base) { return !base.empty(); }));
  if (h != built_for_ || holding != built_holding_) build(h);
  const std::span<WatchedVertex> watched = moving_->watched();  // all vertices, in their order
  const std::span<const Vec3d> loads = loads_.at(time_);
  for (std::size_t i = 0; i < watched.size(); ++i) {
    WatchedVertex& w = watched[i];
    const double m = body_.masses[i], gamma = gamma_[i];
    const Vec3d load = m > 0.0 ? loads[i] : Vec3d{};
    kicked_[i] = {m, gamma, w.velocity, load, {}};
    impulse_[i] = (w.elastic + w.viscous + gravity_ * m + load + w.velocity * -gamma) * h;
  }
  impose_motions(h);
  for (std::size_t i = 0; i < watched.size(); ++i) {  // held components of the change are known now, others 0
    if (!(body_.masses[i] > 0.0)) watched[i].velocity = {};
    change_[i] = watched[i].velocity - kicked_[i].velocity_before;
  }
  system_.solve(impulse_, change_);
  system_.held_drag(change_, drag_);
  for (std::size_t i = 0; i < watched.size(); ++i) {
    WatchedVertex& w = watched[i];
    const double inertia = kicked_[i].mass + h * kicked_[i].damping;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool free = system_.is_free(3 * i + axis);
      if (free) w.velocity[axis] = kicked_[i].velocity_before[axis] + change_[i][axis];
      // C (v₊ − v₋): of free components from the equation itself, so that the books are exact
      w.viscous[axis] -= free ? (impulse_[i][axis] - inertia * change_[i][axis]) / h : drag_[i][axis];
    }
  }
}

}  // namespace glisson
