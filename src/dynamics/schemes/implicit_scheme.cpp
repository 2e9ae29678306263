#include "dynamics/schemes/implicit_scheme.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "dynamics/step/rigid_motions.h"

namespace glisson {
namespace {

constexpr double kDefaultStep = 0.01, kDefaultStaticStep = 0.05;  ///< [s]
constexpr double kGrowth = 1.5;                                   ///< of an automatic step after an easy one
constexpr int kMostEventCuts = 7;                                 ///< events are dated to 1/128 of a step

/// Tets up to which inverse statics factorises: one factor serves all its iterations.
constexpr std::size_t kMostFactorisedInverse = 200000;
constexpr double kResponse = 1e-6;  ///< accuracy of a response to forces

constexpr double kSameTime = 1e-9;  ///< of a step: corners so near are one
constexpr double kSliver = 1e-3;    ///< of a step: so much longer than the largest it may be

std::span<const Vec3d> view(const std::vector<Vec3d>& field) { return field; }

}  // namespace

ImplicitScheme::ImplicitScheme(Body body, const SimulationOptions& options, bool statics)
    : Scheme(std::move(body), options), statics_(statics),
      relaxes_(statics && options.branches != StaticBranches::follow),
      tissue_(state_.body, StepKind::implicit,
              options.threads > 0 ? options.threads : detail::threads_for(state_.body.elements.size())),
      solver_(state_, tissue_, now_, statics, relaxes_),
      largest_(options.implicit.largest_step.value_or(statics ? kDefaultStaticStep : kDefaultStep)) {
  pace_.step = options.step.value_or(largest_);
  if (is_slow() && !options.implicit.largest_step) largest_ = std::numeric_limits<double>::infinity();
  info_ = {.instruction_set = "double, element by element", .threads = tissue_.threads()};
  now_.resize(state_.body.vertex_count);
}

/// Where a coming automatic step ends at the latest [s].
double ImplicitScheme::next_end() const {
  const double here =
      state_.time + kSameTime * pace_.step + 4.0 * std::numeric_limits<double>::epsilon() * std::abs(state_.time);
  const double corner = next_corner(here);
  return step_end_ > here ? std::min(step_end_, corner) : corner;
}

double ImplicitScheme::step_size() const {
  const double left = state_.options.step ? std::numeric_limits<double>::infinity() : next_end() - state_.time;
  if (!std::isfinite(left)) return pace_.step;
  const double even = left / std::max(1.0, std::ceil(left / pace_.step - kSliver)),
               last = is_slow() ? pace_.planned : last_h_;
  return std::abs(even - last) <= kSameTime * last ? last : even;  // to the last bit, so that the factor is kept
}

double ImplicitScheme::stable_step() const { return std::numeric_limits<double>::infinity(); }

void ImplicitScheme::take_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) {
  now_.u.assign(displacement.begin(), displacement.end());
  now_.v.assign(velocity.begin(), velocity.end());
  if (statics_) std::fill(now_.v.begin(), now_.v.end(), Vec3d{});
  last_h_ = 0.0;
  fresh_ = true;
  std::fill(now_.contact.begin(), now_.contact.end(), Vec3d{});
  solver_.contact().state_set(now_.u);
  tissue_.advance_memory({now_.u, now_.v, std::numeric_limits<double>::infinity()});  // a state that is set has relaxed
  if (!state_.options.track_energies) return;
  double kinetic = 0.0;
  for (std::size_t i = 0; i < now_.v.size(); ++i) kinetic += 0.5 * state_.body.masses[i] * dot(now_.v[i], now_.v[i]);
  ledger_.reset(kinetic, tissue_.energy(now_.u) + solver_.contact().energy_at(now_.u));
}

void ImplicitScheme::take_over(const BodyChange& change) {
  for (const MovedVertex& m : change.moved) now_.u[m.vertex] = m.displacement, now_.v[m.vertex] = m.velocity;
  for (auto* field : {&now_.u, &now_.v, &now_.a}) {
    for (const std::uint32_t origin : change.origins) field->push_back(Vec3d((*field)[origin]));
  }
  now_.resize(state_.body.vertex_count);
  tissue_.body_changed();
  last_change_.clear();
  last_h_ = 0.0;
  fresh_ = true;
}

void ImplicitScheme::take_tissues(const TissueChange& change) {
  tissue_.tissues_changed(change.blocks, now_.u);
  for (std::size_t i = 0; i < change.blocks.size(); ++i) {
    tissue_.set_branch_stresses(change.blocks[i], change.branch_stresses[i], now_.u);
  }
  solver_.tissues_changed();
  fresh_ = true;
}

void ImplicitScheme::attach(std::shared_ptr<Interaction> interaction, const BodyView& body) {
  require_long_steps(*interaction);
  if (!statics_ && state_.options.implicit.scheme != TimeScheme::backward_euler) {
    throw std::invalid_argument(
        "attach: " + interaction->label() + " needs scheme = backward_euler under implicit; " +
        std::string(word_of(state_.options.implicit.scheme)) +
        " lets tissue that meets a tool ring. Or take integrator = " + supporting_integrators());
  }
  attach_for_long_steps(*interaction, body);
  if (interaction->constrains_long_steps()) solver_.need_factor();
  const bool adds_forces = !interaction->constrains_long_steps();
  solver_.contact().add(std::move(interaction));
  fresh_ = fresh_ || adds_forces || !solver_.contact().interactions().held_still().empty();
}

void ImplicitScheme::tell_change(const BodyView& body, std::span<const std::uint32_t> origins) {
  if (solver_.contact().acts()) solver_.contact().body_changed(body, origins);
}

void ImplicitScheme::follow(std::span<const std::uint32_t> origins, std::uint32_t first_new) {
  solver_.contact().follow(origins, first_new);
  fresh_ = true;
}

/// Forces and accelerations of a state that this scheme did not make itself.
void ImplicitScheme::start_fresh() {
  now_.resize(state_.body.vertex_count);
  solver_.begin();
  if (last_h_ == 0.0) last_change_.assign(state_.body.vertex_count, Vec3d{});
  tissue_.forces({now_.u, now_.v, relaxes_ ? std::numeric_limits<double>::infinity() : 0.0}, now_.elastic, now_.viscous,
                 watch());
  solver_.contact().add_forces_at(now_.u, now_.elastic);
  solver_.contact().add_viscous_forces_at(now_.u, now_.v, now_.viscous);
  const std::span<const Vec3d> loads = state_.loads_at(state_.time, now_.u);
  now_.external.assign(loads.begin(), loads.end());
  now_.gravity = state_.gravity_at(state_.time);
  for (std::size_t i = 0; i < state_.body.vertex_count; ++i) {
    const double m = state_.body.masses[i];
    now_.a[i] = {};
    if (!(m > 0.0) || statics_) continue;
    const Vec3d force =
        now_.elastic[i] + now_.viscous[i] + now_.external[i] - component_product(state_.damping(i), now_.v[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (solver_.held()[3 * i + axis] == 0) now_.a[i][axis] = force[axis] / m + now_.gravity[axis];
    }
  }
  fresh_ = false;
}

std::vector<char> ImplicitScheme::held_or_sprung() const {
  std::vector<char> held = solver_.held();
  for (std::size_t c = 0; c < held.size(); ++c) held[c] = held[c] != 0 || state_.loads.spring(c / 3)[c % 3] > 0.0;
  return held;
}

/// One part of a step, of h [s]. Where it is not made, nothing has changed.
ImplicitScheme::Part ImplicitScheme::part(double h, bool dates_events) {
  if (is_slow()) return slow_part(h, dates_events);
  return stage(statics_ ? static_step(h) : time_step(state_.options.implicit, h), dates_events);
}

ImplicitScheme::Part ImplicitScheme::stage(const TimeStep& s, bool dates_events) {
  if (!solver_.solve(s, last_change_, last_h_)) return Part::no_balance;
  if (dates_events && solver_.contact().overshoots(solver_.next().u, solver_.next().v)) {
    solver_.give_up();
    return Part::overshoots;
  }
  finish(s);
  return Part::made;
}

void ImplicitScheme::finish(const TimeStep& s) {
  Moment& next = solver_.next();
  const double since = relaxes_ ? std::numeric_limits<double>::infinity() : s.h;
  if (s.alpha_f != 0.0) tissue_.forces({next.u, next.v, since}, next.elastic, next.viscous, watch());
  const std::span<const Vec3d> loads = state_.loads_at(state_.time + s.h, next.u);
  next.external.assign(loads.begin(), loads.end());
  next.gravity = state_.gravity_at(state_.time + s.h);
  tissue_.advance_memory({next.u, next.v, since});
  for (std::size_t i = 0; i < next.u.size(); ++i) last_change_[i] = next.u[i] - now_.u[i];
  last_h_ = s.h;
  std::swap(now_, next);
  if (solver_.contact().acts()) solver_.contact().made(now_.u, now_.v, resting());
  if (!state_.options.track_energies) return;
  book(next);
  if (solver_.contact().acts()) ledger_.store_in_instruments(solver_.contact().interactions().tool_energy());
}

/// What interactions hold still, and what acts on it besides them, where no support holds it.
std::vector<RestingVertex> ImplicitScheme::resting() const {
  std::vector<RestingVertex> all;
  const std::vector<char> supported = state_.held_components();
  for (const std::uint32_t v : solver_.contact().interactions().held_still()) {
    Vec3d force =
        now_.elastic[v] + now_.viscous[v] + now_.external[v] + now_.contact[v] + now_.gravity * state_.body.masses[v];
    for (std::size_t axis = 0; axis < 3; ++axis) force[axis] = supported[3 * v + axis] != 0 ? 0.0 : force[axis];
    all.push_back({v, force});
  }
  return all;
}

/// Works of a part: with the forces at its end (backward Euler) or the mean of both ends.
void ImplicitScheme::book(const Moment& before) {
  const bool at_end = !statics_ && state_.options.implicit.scheme == TimeScheme::backward_euler;
  const double w = at_end ? 0.0 : 0.5;
  double elastic = 0.0, viscous = 0.0, damping = 0.0, loads = 0.0, tools = 0.0, kinetic = 0.0, change = 0.0,
         sudden = 0.0, contact = 0.0;
  for (std::size_t i = 0; i < now_.u.size(); ++i) {
    const Vec3d &du = last_change_[i], dv = now_.v[i] - before.v[i];
    const double m = state_.body.masses[i], moving = statics_ ? 0.0 : m;
    const Vec3d drag = state_.damping(i, statics_);
    const auto mean = [&](const Vec3d& a, const Vec3d& b) { return a * w + b * (1.0 - w); };
    const Vec3d viscous_force = mean(before.viscous[i], now_.viscous[i]),
                drag_force = -component_product(drag, mean(before.v[i], now_.v[i]));
    const Vec3d pull = mean(before.external[i] + before.gravity * m, now_.external[i] + now_.gravity * m);
    const Vec3d touch = mean(before.contact[i], now_.contact[i]);
    contact += dot(touch, du);
    const Vec3d elastic_force = mean(before.elastic[i], now_.elastic[i]);
    elastic += 0.5 * dot(before.elastic[i] + now_.elastic[i], du);
    viscous += dot(viscous_force, du);
    damping += dot(drag_force, du);
    loads += dot(pull, du);
    kinetic += 0.5 * moving * dot(now_.v[i], now_.v[i]);
    if (at_end) change += 0.5 * m * dot(dv, dv) - 0.5 * dot(now_.elastic[i] - before.elastic[i], du);
    const Vec3d others = elastic_force + viscous_force + drag_force + pull + touch;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (solver_.held()[3 * i + axis] == 0) {
        const double out = before.elastic[i][axis] + before.viscous[i][axis] - drag[axis] * before.v[i][axis] +
                           before.external[i][axis] + before.contact[i][axis] + before.gravity[axis] * m;
        if (statics_) sudden += 0.5 * out * du[axis];
        continue;
      }
      const double gain =
          at_end ? m * now_.a[i][axis] * du[axis]
                 : 0.5 * moving * (now_.v[i][axis] * now_.v[i][axis] - before.v[i][axis] * before.v[i][axis]);
      tools += gain - others[axis] * du[axis];
    }
  }
  if (!statics_ && state_.options.implicit.scheme == TimeScheme::generalised_alpha) {
    change = tools + loads + elastic + viscous + damping - (kinetic - ledger_.now().kinetic);
  }
  Energies& energies = ledger_.books();
  if (solver_.contact().acts()) {
    const auto [impact, slip, cut] = solver_.contact().lost();
    energies.contact += impact, energies.friction += slip, energies.fracture += cut;
    tools += contact + impact + slip + cut;
  }
  energies.elastic -= elastic;
  energies.dissipated -= viscous + damping;
  (only_relaxes(state_.body) ? energies.maxwell : energies.viscous) -= viscous;
  energies.damping -= damping;
  energies.work_loads += loads;
  energies.work_tools += tools;
  energies.numerical += change + sudden;
  energies.kinetic = kinetic;
}

/// What an automatic step is next.
void ImplicitScheme::adapt(double h, double smallest) {
  if (state_.options.step) return;
  if (smallest < h) {
    pace_.step = smallest;
  } else if (is_easy()) {
    pace_.step = std::min(kGrowth * pace_.step, largest_);
  }
}

StepResult ImplicitScheme::failed(double smallest) {
  std::ostringstream text;
  text << "no balance of forces was found within " << state_.options.implicit.most_iterations
       << " iterations at a step of " << smallest << " s, the step having been cut "
       << state_.options.implicit.most_cuts << " times. Ways out: slower motions, "
       << (statics_ ? "the integrator \"implicit\", whose inertia carries the body over where statics has no answer"
                    : "more iterations or a coarser tolerance");
  message_ = text.str();
  return {StepStatus::not_converged, watch().inverted, message_};
}

ImplicitScheme::Backup ImplicitScheme::backup() {
  return {now_, tissue_.memory(), ledger_, last_change_, state_.time, last_h_, solver_.contact().backup()};
}

void ImplicitScheme::restore(Backup before) {
  const auto held_still = [this] {
    const auto held = solver_.contact().interactions().held_still();
    return std::vector<std::uint32_t>(held.begin(), held.end());
  };
  const std::vector<std::uint32_t> held = held_still();
  now_ = std::move(before.now);
  tissue_.set_memory(std::move(before.memory));
  ledger_ = before.ledger, last_change_ = std::move(before.last_change);
  state_.time = before.time, last_h_ = before.last_h;
  solver_.contact().restore(before.contact);
  if (held != held_still()) solver_.begin();
}

/// Takes what has changed from outside into account; a status other than ok where no step can be made.
StepResult ImplicitScheme::begin() {
  start_fresh();
  if (statics_ && !(message_ = free_rigid_motion(state_.body, held_or_sprung())).empty()) {
    message_ = "quasi_static: " + message_ + ", or take the integrator \"implicit\"";
    fresh_ = true;
    return {StepStatus::not_held, {}, message_};
  }
  if (!flat(view(now_.elastic)).allFinite() || !flat(view(now_.viscous)).allFinite()) {
    fresh_ = true;
    message_ = not_finite_at(state_.time);
    return {StepStatus::not_finite, watch().inverted, message_};
  }
  return {};
}

/// Where a step of h ends: at a corner to the last bit.
double ImplicitScheme::end_of(double h) const {
  const double corner = state_.options.step ? state_.time : next_end();
  return std::abs(corner - (state_.time + h)) < 0.5 * h ? corner : state_.time + h;
}

/// Goes on by h, to `end`, in parts where it has to. @param before  where to go back to if it fails; none: here
/// @param shortest  the shortest part [s] @return false where there is no balance: all is as it was before
bool ImplicitScheme::advance(double h, double end, std::optional<Backup>& before, double& shortest) {
  const double begin = state_.time;
  std::uint64_t left = 1;  // parts of h / 2^cuts
  int cuts = 0, most = 0;
  bool dated = false;  // the cuts are those of an event
  while (left > 0) {
    const double length = std::ldexp(h, -cuts);
    if (left > 1 && !before) before = backup();
    const Part outcome = part(length, cuts < kMostEventCuts);
    if (outcome == Part::made) {
      --left;
      state_.time = left > 0 ? begin + (h - static_cast<double>(left) * length) : end;
      if (left > 0 && left % 2 == 0 && (dated || is_easy())) left /= 2, --cuts;
      continue;
    }
    if (outcome == Part::overshoots) {
      left *= 2, ++cuts, dated = true;
      continue;
    }
    dated = false;
    shortest = length;
    if (cuts >= state_.options.implicit.most_cuts || solver_.interrupt().is_wanted()) {
      if (before) restore(*std::move(before));
      fresh_ = true;
      return false;
    }
    left *= 2, ++cuts;
    most = std::max(most, cuts);
  }
  shortest = std::ldexp(h, -most);
  return true;
}

StepResult ImplicitScheme::made() {
  ++state_.steps;
  return {watch().inverted.empty() ? StepStatus::ok : StepStatus::inverted,
          watch().inverted,
          {},
          solver_.contact().is_met()};
}

/// That a step was not made because its end was asked for, which has left nothing behind.
StepResult ImplicitScheme::interrupted() {
  const StepProgress& at = solver_.interrupt().progress();
  std::ostringstream text;
  text << "the step from " << state_.time << " s was interrupted, in iteration " << at.iteration << " of a part of "
       << at.h << " s that begins at " << at.time << " s; nothing has changed, and step() makes it anew";
  message_ = text.str();
  solver_.interrupt().rethrow();
  return {StepStatus::interrupted, watch().inverted, message_};
}

StepResult ImplicitScheme::step() {
  const double h = step_size();
  fresh_ = take_hold(h) || fresh_;
  const bool sudden = fresh_;
  const Pace pace = pace_;
  const ElementWatch seen = watch();
  solver_.interrupt().begin();
  const StepResult result = step_of(h, sudden);
  solver_.interrupt().end();
  if (!solver_.interrupt().is_wanted()) return result;
  pace_ = pace, watch() = seen, fresh_ = sudden;
  return interrupted();
}

/// @param sudden  as fresh_ is
StepResult ImplicitScheme::step_of(double h, bool sudden) {
  if (fresh_) {
    const StepResult begun = begin();
    if (!begun.made()) return begun;
  }
  if (is_slow()) return slow_step_of(h, sudden);
  std::optional<Backup> before;
  double shortest = h;
  const bool done = advance(h, end_of(h), before, shortest);
  adapt(h, shortest);
  return done ? made() : failed(shortest);
}

void ImplicitScheme::take_body(Archive& ar) {
  if (ar.reads()) load_layout({});
}

void ImplicitScheme::load_layout(const std::shared_ptr<const void>&) {
  tissue_.body_changed();
  solver_.tissues_changed();
  now_.resize(state_.body.vertex_count);
  fresh_ = true;
}

void ImplicitScheme::archive_motion(Archive& ar) {
  bool fresh = fresh_;
  ar(now_, tissue_, watch().inverted, last_change_, last_h_, pace_.step, fresh, ledger_);
  const std::size_t vertices = state_.body.vertex_count, tets = state_.body.elements.size();
  ar.check(last_change_.size() == vertices || (last_change_.empty() && fresh && last_h_ == 0.0));
  for (const std::uint32_t t : watch().inverted) ar.check(t < tets);
  if (solver_.contact().acts()) ar(solver_.contact());  // first: what interactions hold still is held by the solver
  if (ar.reads() && !fresh) solver_.begin();
  if (!fresh) ar(solver_);
  if (is_slow()) ar(pace_.largest_stress, pace_.largest_displacement, pace_.planned);
  if (ar.reads()) fresh_ = fresh;
}

/// What holds or drives a vertex, in the components it holds.
ForceParts ImplicitScheme::vertex_force(std::uint32_t v, const Axes& axes) const {
  const double m = state_.body.masses[v];
  const Vec3d drag = component_product(state_.damping(v, statics_), now_.v[v]);
  return {masked(-now_.elastic[v], axes),
          masked(-now_.viscous[v], axes),
          masked(drag, axes),
          masked(now_.a[v] * m, axes),
          masked(now_.gravity * -m, axes),
          masked(-now_.external[v] - now_.contact[v], axes)};
}

ForceParts ImplicitScheme::force(ConstraintId constraint) const {
  const Constraint& c = state_.constraints.at(constraint);
  ForceParts sum;
  if (!state_.holds(constraint.index) || state_.steps == 0) return sum;
  for (std::size_t k = 0; k < c.vertices.size(); ++k) sum += vertex_force(c.vertices[k], c.axes_of(k));
  return sum;
}

Vec3d ImplicitScheme::torque(ConstraintId constraint, const Vec3d& about) const {
  const Constraint& c = state_.constraints.at(constraint);
  Vec3d sum{};
  if (!state_.holds(constraint.index) || state_.steps == 0) return sum;
  for (std::size_t k = 0; k < c.vertices.size(); ++k) {
    const std::uint32_t v = c.vertices[k];
    sum += cross(state_.body.rest_positions[v] + now_.u[v] - about, vertex_force(v, c.axes_of(k)).total());
  }
  return sum;
}

Imbalance StaticScheme::imbalance_at(std::span<const Vec3d> u) {
  set_state(u, std::vector<Vec3d>(u.size()));
  solver().begin();
  return solver().imbalance_at(u);
}

void StaticScheme::linearise() {
  if (body().elements.size() <= kMostFactorisedInverse) solver().need_factor();
  solver().linearise_here();
}

bool StaticScheme::is_stable() {
  if (body().elements.size() <= kMostFactorisedInverse) solver().need_factor();
  return solver().is_stable_here();
}

bool StaticScheme::respond(std::span<const Vec3d> forces, std::vector<Vec3d>& displacement) {
  return solver().respond(forces, kResponse, displacement);
}

std::string StaticScheme::free_motion() const { return free_rigid_motion(body(), held_or_sprung()); }

}  // namespace glisson
