#include "dynamics/schemes/stiff_masses.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glisson {
namespace {

constexpr double kForceMemory = 0.999;   ///< a step, of the largest force that inertia is held against
constexpr double kEnergyForMass = 0.01;  ///< of the work of tools and loads, that mass may have as kinetic energy

}  // namespace

double StiffMasses::take(std::span<const VertexMass> wanted, MovingBody& moving) {
  Body& body = state_.body;
  if (wanted.empty() && heavy_.empty()) return 0.0;
  body.stiff_mass.resize(body.vertex_count, 0.0);
  std::vector<Heavy> heavy;
  changes_.clear();
  double present = 0.0;
  const auto give = [&](std::uint32_t v, double mass) {
    if (body.stiff_mass[v] == mass) return;
    changes_.push_back({v, mass - body.stiff_mass[v]});
    body.stiff_mass[v] = mass;
  };
  auto known = heavy_.begin();
  const auto drop_below = [&](std::uint32_t vertex) {
    for (; known != heavy_.end() && known->vertex < vertex; ++known) give(known->vertex, 0.0);
  };
  for (const VertexMass& m : wanted) {
    drop_below(m.vertex);
    if (known != heavy_.end() && known->vertex == m.vertex) ++known;
    give(m.vertex, m.mass);
    heavy.push_back({m.vertex, {}});
    present += m.mass;
  }
  drop_below(std::numeric_limits<std::uint32_t>::max());
  heavy_ = std::move(heavy);
  const double kinetic = changes_.empty() ? 0.0 : change(moving);
  for (Heavy& h : heavy_) h.velocity = moving.velocity_of(h.vertex);
  state_.mass_scaling.present = present;
  state_.mass_scaling.largest = std::max(state_.mass_scaling.largest, present);
  return kinetic;
}

/// Lets the body follow the changes of mass. @return what its kinetic energy changes by
double StiffMasses::change(MovingBody& moving) {
  double comes = 0.0, goes = 0.0;
  for (const VertexMass& m : changes_) {
    const Vec3d velocity = moving.velocity_of(m.vertex);
    const double change = 0.5 * m.mass * dot(velocity, velocity);
    (change > 0.0 ? comes : goes) += std::abs(change);
  }
  energy_ += goes;
  const bool paid = comes <= energy_;
  if (paid) energy_ -= comes;
  std::vector<std::uint32_t> changed;
  for (const VertexMass& m : changes_) {
    changed.push_back(m.vertex);
    if (paid || !(m.mass > 0.0)) continue;
    const double after = state_.body.inertia(m.vertex);
    moving.set_velocity(m.vertex, moving.velocity_of(m.vertex) * std::sqrt((after - m.mass) / after));
  }
  moving.inertia_changed(changed);
  for (ActiveVertex& w : moving.active()) w.velocity = moving.velocity_of(w.vertex);
  return (paid ? comes : 0.0) - goes;
}

double StiffMasses::weigh(const ActiveKick::Outer& outer, const MovingBody& moving) {
  double inertia = 0.0;
  for (Heavy& heavy : heavy_) {
    const Vec3d velocity = moving.velocity_of(heavy.vertex);
    inertia += state_.body.stiff_mass[heavy.vertex] * norm(velocity - heavy.velocity);
    heavy.velocity = velocity;
  }
  largest_force_ = std::max(outer.force, kForceMemory * largest_force_);
  energy_ += kEnergyForMass * std::max(0.0, outer.power * last_step_);
  const double impulse = largest_force_ * last_step_;
  return impulse > 0.0 ? inertia / impulse : 0.0;
}

void StiffMasses::archive(Archive& ar, MovingBody& moving) {
  const std::vector<Heavy> here = heavy_;
  std::vector<double>& masses = state_.body.stiff_mass;
  auto count = static_cast<std::uint32_t>(masses.size());
  ar(count);
  ar.check(count <= state_.body.vertex_count);
  masses.resize(count);
  ar.same_size(masses);
  ar(heavy_, largest_force_, last_step_, energy_, state_.mass_scaling.present, state_.mass_scaling.largest);
  if (!ar.reads()) return;
  std::vector<std::uint32_t> touched;
  for (const Heavy& h : here) touched.push_back(h.vertex);
  for (const Heavy& h : heavy_) {
    ar.check(h.vertex < count);
    touched.push_back(h.vertex);
  }
  moving.inertia_changed(touched);
}

}  // namespace glisson
