#include "dynamics/pace/stiff_masses.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace glisson {
namespace {

constexpr double kForceMemory = 0.999;   ///< a step, of the largest force that inertia is held against
constexpr double kEnergyForMass = 0.01;  ///< of the work of tools and loads, that mass may have as kinetic energy

}  // namespace

double StiffMasses::take(std::span<const VertexMass> wanted, MovingBody& moving) {
  Body& body = state_.body;
  if (wanted.empty() && heavy_.empty()) return 0.0;
  body.stiff_mass.resize(body.vertex_count, 0.0);
  changed_.clear(), changes_.clear();
  double present = 0.0;
  const auto give = [&](std::uint32_t v, double mass) {
    if (body.stiff_mass[v] == mass) return;
    changed_.push_back(v), changes_.push_back(mass - body.stiff_mass[v]);
    body.stiff_mass[v] = mass;
  };
  known_.swap(heavy_);
  heavy_.clear();
  auto known = known_.begin();
  const auto drop_below = [&](std::uint32_t vertex) {
    for (; known != known_.end() && *known < vertex; ++known) give(*known, 0.0);
  };
  for (const VertexMass& m : wanted) {
    drop_below(m.vertex);
    if (known != known_.end() && *known == m.vertex) ++known;
    give(m.vertex, m.mass);
    heavy_.push_back(m.vertex);
    present += m.mass;
  }
  drop_below(std::numeric_limits<std::uint32_t>::max());
  const double kinetic = changed_.empty() ? 0.0 : change(moving);
  velocities_.resize(heavy_.size());
  moving.read_velocities(heavy_, velocities_);
  state_.mass_scaling.present = present;
  state_.mass_scaling.largest = std::max(state_.mass_scaling.largest, present);
  return kinetic;
}

/// Lets the body follow the changes of mass. @return what its kinetic energy changes by
double StiffMasses::change(MovingBody& moving) {
  now_.resize(changed_.size());
  moving.read_velocities(changed_, now_);
  double comes = 0.0, goes = 0.0;
  for (std::size_t k = 0; k < changed_.size(); ++k) {
    const double change = 0.5 * changes_[k] * dot(now_[k], now_[k]);
    (change > 0.0 ? comes : goes) += std::abs(change);
  }
  energy_ += goes;
  const bool paid = comes <= energy_;
  if (paid) energy_ -= comes;
  for (std::size_t k = 0; !paid && k < changed_.size(); ++k) {
    if (!(changes_[k] > 0.0)) continue;
    const double after = state_.body.inertia(changed_[k]);
    moving.set_velocity(changed_[k], now_[k] * std::sqrt((after - changes_[k]) / after));
  }
  moving.inertia_changed(changed_);
  if (paid) return comes - goes;
  for (ActiveVertex& w : moving.active()) w.velocity = moving.velocity_of(w.vertex);
  return -goes;
}

double StiffMasses::weigh(const ActiveKick::Outer& outer, const MovingBody& moving) {
  now_.resize(heavy_.size());
  moving.read_velocities(heavy_, now_);
  double inertia = 0.0;
  for (std::size_t k = 0; k < heavy_.size(); ++k) {
    inertia += state_.body.stiff_mass[heavy_[k]] * norm(now_[k] - velocities_[k]);
  }
  velocities_.swap(now_);
  largest_force_ = std::max(outer.force, kForceMemory * largest_force_);
  energy_ += kEnergyForMass * std::max(0.0, outer.power * last_step_);
  const double impulse = largest_force_ * last_step_;
  return impulse > 0.0 ? inertia / impulse : 0.0;
}

void StiffMasses::archive(Archive& ar, MovingBody& moving) {
  std::vector<double>& masses = state_.body.stiff_mass;
  auto count = static_cast<std::uint32_t>(masses.size());
  ar(count);
  ar.check(count <= state_.body.vertex_count);
  masses.resize(count);
  ar.same_size(masses);
  ar(heavy_, velocities_, largest_force_, last_step_, energy_, state_.mass_scaling.present,
     state_.mass_scaling.largest);
  if (!ar.reads()) return;
  ar.check(velocities_.size() == heavy_.size());
  for (const std::uint32_t v : heavy_) ar.check(v < count);
  if (state_.options.mass_scaling != MassScalingKind::variable) return;
  // The layout may be that of another version of the body, kept when other vertices were heavy.
  std::vector<std::uint32_t> all(state_.body.vertex_count);
  std::iota(all.begin(), all.end(), 0U);
  moving.inertia_changed(all);
}

}  // namespace glisson
