#include "dynamics/state/active_kick.h"

#include <algorithm>
#include <array>

namespace glisson {

namespace {

/// 1/(m + γ h) of a vertex with mass.
Vec3d inverse_inertia(const ActiveKick::Kicked& k, double h) {
  if (k.dashpot == Vec3d{}) {
    const double inverse = 1.0 / (k.mass + k.damping * h);
    return {inverse, inverse, inverse};
  }
  const auto inverse = [&](double dashpot) { return 1.0 / (k.mass + (k.damping + dashpot) * h); };
  return {inverse(k.dashpot.x), inverse(k.dashpot.y), inverse(k.dashpot.z)};
}

}  // namespace

void ActiveKick::follow(std::span<const std::uint32_t> before, std::span<const ActiveVertex> active) {
  follow_active(before, active, kicked_, kicked_before_);
  const std::span<const Constraint> constraints = state_.constraints.all();
  places_.resize(constraints.size());
  for (std::size_t c = 0; c < places_.size(); ++c) {
    places_[c].clear();
    for (const std::uint32_t v : constraints[c].vertices) {
      const auto at = std::lower_bound(active.begin(), active.end(), v,
                                       [](const ActiveVertex& w, std::uint32_t vertex) { return w.vertex < vertex; });
      places_[c].push_back(static_cast<std::uint32_t>(at - active.begin()));
    }
  }
}

void ActiveKick::begin(double h) {
  step_ = h;
  time_ = state_.time;
  gravity_ = state_.gravity_at(state_.time);
}

Vec3d ActiveKick::keep(std::size_t k, const ActiveVertex& w, std::span<const Vec3d> loads) {
  const double m = state_.body.inertia(w.vertex);
  const Vec3d load = m > 0.0 ? loads[w.vertex] : Vec3d{};
  kicked_[k] = {m,
                state_.gamma[w.vertex],
                gravity_ * state_.body.masses[w.vertex],
                w.velocity,
                load,
                {},
                state_.loads.dashpot(w.vertex),
                {}};
  if (m > 0.0) kicked_[k].mobility = inverse_inertia(kicked_[k], step_);
  return load;
}

std::span<const Vec3d> ActiveKick::loads(std::span<const ActiveVertex> active) {
  if (state_.loads.depends_on_state()) {
    displacement_.resize(state_.body.vertex_count);
    for (const ActiveVertex& w : active) displacement_[w.vertex] = w.displacement;
  }
  return state_.loads_at(state_.time, displacement_);
}

void ActiveKick::kick(std::span<ActiveVertex> active) {
  const std::span<const Vec3d> of_loads = loads(active);
  for (std::size_t k = 0; k < active.size(); ++k) {
    ActiveVertex& w = active[k];
    const Vec3d load = keep(k, w, of_loads);
    const double m = kicked_[k].mass;
    const Vec3d force = w.elastic + w.viscous + kicked_[k].weight + load;
    // v₊ = (m v₋ + h F) / (m + γ h) [Schwartz2002, eq. 4]
    w.velocity = m > 0.0 ? component_product(w.velocity * m + force * step_, kicked_[k].mobility) : Vec3d{};
  }
}

void ActiveKick::impose_motions(std::span<ActiveVertex> active) const {
  for (std::size_t c = 0; c < places_.size(); ++c) {
    if (!state_.holds(c)) continue;
    const Constraint& constraint = state_.constraints.all()[c];
    const Target target(constraint, state_.time + step_);
    for (std::size_t k = 0; k < places_[c].size(); ++k) {
      ActiveVertex& w = active[places_[c][k]];
      Vec3d wanted{};
      if (constraint.moves()) {
        const Vec3d there = target.displacement(state_.base[c][k], state_.body.rest_positions[w.vertex]);
        wanted = (there - w.displacement) * (1.0 / step_);
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (has_axis(constraint.axes_of(k), axis)) w.velocity[axis] = wanted[axis];
      }
    }
  }
}

std::span<const Vec3d> ActiveKick::mobility() {
  mobility_.clear();
  for (const Kicked& k : kicked_) mobility_.push_back(k.mobility);
  for (std::size_t c = 0; c < places_.size(); ++c) {
    if (!state_.holds(c)) continue;
    for (std::size_t k = 0; k < places_[c].size(); ++k) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (has_axis(state_.constraints.all()[c].axes_of(k), axis)) mobility_[places_[c][k]][axis] = 0.0;
      }
    }
  }
  return mobility_;
}

void ActiveKick::push(std::span<const Vec3d> impulses) {
  for (std::size_t k = 0; k < kicked_.size(); ++k) kicked_[k].contact = impulses[k] * (1.0 / step_);
}

/// What a constraint exerts on one of its vertices, in the components that it holds.
ForceParts ActiveKick::force_on(std::span<const ActiveVertex> active, std::size_t constraint, std::size_t k) const {
  const std::uint32_t place = places_[constraint][k];
  return force_at(active[place], place, state_.constraints.all()[constraint].axes_of(k));
}

ForceParts ActiveKick::force_at(const ActiveVertex& w, std::size_t place, const Axes& axes) const {
  const Kicked& k = kicked_[place];
  const Vec3d inertial = step_ > 0.0 ? (w.velocity - k.velocity_before) * (k.mass / step_) : Vec3d{};
  return {masked(-w.elastic, axes), masked(-w.viscous, axes),      masked(k.drag(w.velocity), axes),
          masked(inertial, axes),   masked(k.weight * -1.0, axes), masked(-k.load - k.contact, axes)};
}

ForceParts ActiveKick::force(std::span<const ActiveVertex> active, std::size_t constraint) const {
  ForceParts sum;
  if (!state_.holds(constraint)) return sum;
  for (std::size_t k = 0; k < places_[constraint].size(); ++k) sum += force_on(active, constraint, k);
  return sum;
}

Vec3d ActiveKick::torque(std::span<const ActiveVertex> active, std::size_t constraint, const Vec3d& about) const {
  Vec3d sum{};
  if (!state_.holds(constraint)) return sum;
  for (std::size_t k = 0; k < places_[constraint].size(); ++k) {
    const ActiveVertex& w = active[places_[constraint][k]];
    const Vec3d then = state_.body.rest_positions[w.vertex] + w.displacement - w.velocity * (state_.time - time_);
    sum += cross(then - about, force_on(active, constraint, k).total());
  }
  return sum;
}

ActiveKick::Outer ActiveKick::outer_action(std::span<const ActiveVertex> active) const {
  Outer sum;
  for (std::size_t k = 0; k < kicked_.size(); ++k) {
    sum.force += norm(kicked_[k].contact) + norm(kicked_[k].load);
    sum.power += dot(kicked_[k].contact + kicked_[k].load, active[k].velocity);
  }
  for (std::size_t c = 0; c < places_.size(); ++c) {
    if (!state_.holds(c)) continue;
    for (std::size_t k = 0; k < places_[c].size(); ++k) {
      const Vec3d force = force_on(active, c, k).total();
      sum.force += norm(force);
      sum.power += dot(force, active[places_[c][k]].velocity);
    }
  }
  return sum;
}

KickWork ActiveKick::work(std::span<const ActiveVertex> active) const {
  KickWork work;
  for (std::size_t k = 0; k < active.size(); ++k) {
    const ActiveVertex& w = active[k];
    const Kicked& at = kicked_[k];
    const auto power = [&](const Vec3d& v) {
      return KickPower{.elastic = dot(w.elastic, v),
                       .viscous = dot(w.viscous, v),
                       .damping = -at.damping * dot(w.velocity, v) - dot(component_product(w.velocity, at.dashpot), v),
                       .tools = dot(at.contact, v),
                       .loads = dot(at.weight + at.load, v)};
    };
    add(work.before, power(at.velocity_before));
    add(work.after, power(w.velocity));
    work.kinetic += 0.5 * at.mass * dot(at.velocity_before, w.velocity);
  }
  for (std::size_t c = 0; c < places_.size(); ++c) {
    if (!state_.holds(c)) continue;
    for (std::size_t k = 0; k < places_[c].size(); ++k) {
      const std::uint32_t place = places_[c][k];
      const Vec3d f = force_on(active, c, k).total();
      work.before.tools += dot(f, kicked_[place].velocity_before);
      work.after.tools += dot(f, active[place].velocity);
    }
  }
  return work;
}

/// J·(V − v)/h with either velocity: 0 where the tissue goes with the tool.
void ActiveKick::add_interface(std::span<const ActiveVertex> active, const InterfaceBook& book, KickWork& work) const {
  constexpr std::array<double KickPower::*, 3> kSinks{&KickPower::contact, &KickPower::friction, &KickPower::fracture};
  for (std::size_t sink = 0; sink < kSinks.size(); ++sink) {
    const InterfaceBook::Page& page = book.pages[sink];
    double before = page.tools_before, after = page.tools_after;
    for (std::size_t k = 0; k < active.size(); ++k) {
      before -= dot(page.impulses[k], kicked_[k].velocity_before);
      after -= dot(page.impulses[k], active[k].velocity);
    }
    work.before.*kSinks[sink] += before / step_;
    work.after.*kSinks[sink] += after / step_;
  }
}

void ActiveKick::archive(Archive& ar) {
  ar.same_size(kicked_);
  ar(step_, time_, gravity_);
}

}  // namespace glisson
