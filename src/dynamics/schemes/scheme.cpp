#include "dynamics/schemes/scheme.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "glisson/archive.h"

namespace glisson {
namespace {

/// Where the motion of a constraint counts from, which is `now` at present. @return per vertex [m]
std::vector<Vec3d> find_base(const Scheme& scheme, const Constraint& constraint, const Target& now) {
  std::vector<Vec3d> base;
  for (const std::uint32_t v : constraint.vertices) {
    base.push_back(now.base_of(scheme.body().rest_positions[v], scheme.displacement_of(v)));
  }
  return base;
}

}  // namespace

/// A motion is asked first where it begins at once: what it throws changes nothing.
ConstraintId Scheme::add_constraint(Constraint constraint) {
  std::optional<Target> now;
  if (constraint.from <= state_.time) now.emplace(constraint, state_.time);
  const ConstraintId id = state_.constraints.add(std::move(constraint));
  state_.base.emplace_back();
  const Constraint& added = state_.constraints.at(id);
  acts_on(added.vertices);
  if (now) state_.base[id.index] = find_base(*this, added, *now);
  return id;
}

void Scheme::add_load(std::span<const std::uint32_t> vertices, const SurfaceLoad& load, TimeFunction<double> scale) {
  const std::vector<std::uint32_t> acted = state_.loads.add(state_.body, vertices, load, std::move(scale));
  try {
    loads_changed(true);
  } catch (...) {
    state_.loads.take_back_last(state_.body);
    loads_changed(false);
    throw;
  }
  acts_on(acted);
}

double Scheme::next_corner(double after) const {
  double first = state_.loads.next_corner(after);
  const auto take = [&](double corner) { first = corner > after ? std::min(first, corner) : first; };
  if (state_.options.gravity != Vec3d{}) take(state_.options.gravity_ramp);
  for (const Constraint& c : state_.constraints.all()) {
    take(c.from);
    take(std::min(c.motion.corners.after(after), c.rigid.corners.after(after)));
  }
  for (const auto& interaction : interactions()) take(interaction->next_corner(after));
  return first;
}

void Scheme::require_tissues(const BlockTissues& tissues) const {
  for (const auto& [b, tissue] : tissues) {
    require_valid(tissue);
    require_fibres(state_.body, state_.body.blocks[b], tissue);
  }
}

void Scheme::attach(std::shared_ptr<Interaction>, const BodyView&) { refuse_interactions(); }

std::string Scheme::not_finite_at(double time) {
  return "a force is not finite at " + std::to_string(time) +
         " s: the tissue has been deformed beyond the range of its law or its precision, or a motion, load or "
         "interaction gave a number that is not finite. Ways out: look at the last frame, press less deep or more "
         "slowly, soften the law, precision = \"double\", or integrator = \"implicit\"";
}

void Scheme::require_long_steps(const Interaction& interaction) const {
  const std::string why = interaction.refuses_long_steps();
  if (why.empty()) return;
  throw std::invalid_argument("attach: integrator = " + std::string(word_of(state_.options.integrator)) +
                              " does not support " + interaction.label() + ", which " + why);
}

void Scheme::attach_for_long_steps(Interaction& interaction, const BodyView& body) {
  interaction.set_long_steps(true);
  try {
    interaction.attached(body, state_.time);
  } catch (...) {
    interaction.set_long_steps(false);
    throw;
  }
  if (state_.options.track_energies) ledger_.bring_in(0.0, interaction.energy());
}

void Scheme::refuse_interactions() {
  throw std::invalid_argument(
      "attach: instruments, needles and membranes need integrator = " + supporting_integrators() +
      "; this simulation has another. Relaxation can be modelled by maxwell branches, which work with explicit steps");
}

bool Scheme::take_hold(double h) {
  bool any = false;
  for (std::size_t c = 0; c < state_.base.size(); ++c) {
    if (state_.holds(c) || state_.constraints.all()[c].from > state_.time + 0.5 * h) continue;
    rebase(c);
    any = true;
  }
  return any;
}

/// Lets a constraint's motion count from where its vertices are now.
void Scheme::rebase(std::size_t constraint) {
  const Constraint& c = state_.constraints.all()[constraint];
  state_.base[constraint] = find_base(*this, c, Target(c, state_.time));
}

void Scheme::set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) {
  if (displacement.size() != body().vertex_count || velocity.size() != body().vertex_count) {
    throw std::invalid_argument("set_state: " + std::to_string(displacement.size()) + " displacements and " +
                                std::to_string(velocity.size()) + " velocities given, the mesh has " +
                                std::to_string(body().vertex_count) + " vertices");
  }
  take_state(displacement, velocity);
  for (std::size_t c = 0; c < state_.base.size(); ++c) {
    if (state_.holds(c)) rebase(c);
  }
}

void Scheme::archive_body(Archive& ar) {
  if (!ar.reads()) {
    state_.archive(ar);
    take_body(ar);
    return;
  }
  BodyState before = state_;
  try {
    state_.archive(ar);
    take_body(ar);
  } catch (...) {
    state_ = std::move(before);
    throw;
  }
}

}  // namespace glisson
