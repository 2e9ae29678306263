#include "dynamics/schemes/implicit_scheme.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include "dynamics/step/rigid_motions.h"

namespace glisson {
namespace {

constexpr double kDefaultStep = 0.01, kDefaultStaticStep = 0.05;  ///< [s]
constexpr double kGrowth = 1.5;                                   ///< of an automatic step after an easy one
constexpr int kEasy = 6;                                          ///< iterations up to which a step was easy
constexpr double kSmallStrain = 1e-6;  ///< forces at this strain are the least that a residual is measured by
constexpr double kForcing = 1e-3;      ///< accuracy of a linear solve within Newton's method
constexpr int kMostPatience = 7;       ///< iterations with definite tangents before an exact one is tried again
constexpr double kRounding = 1e-15;    ///< of u⁺ − u over u, which very short steps cannot do better than
constexpr int kMostHalvings = 12;      ///< of a line search
constexpr double kDifference = 1e-3;   ///< of h, for the velocity of a motion

std::span<const Vec3d> view(const std::vector<Vec3d>& field) { return field; }

/// Norm of the forces that a strain of 1 would give.
double unit_force(const Body& body) {
  double sum = 0.0;
  for (const TissueBlock& block : body.blocks) {
    const double modulus = block.elastic.lambda + 2.0 * block.elastic.mu;
    for (std::size_t e = block.begin; e < block.end; ++e) {
      for (const Vec3d& s : body.rest[e].s) sum += std::pow(modulus * body.rest[e].volume * norm(s), 2);
    }
  }
  return std::sqrt(sum);
}

}  // namespace

ImplicitScheme::ImplicitScheme(Body body, const SimulationOptions& options)
    : Scheme(std::move(body), options), tissue_(body_), system_(tissue_, options.implicit.preconditioner),
      unit_force_(unit_force(body_)),
      largest_(options.implicit.largest_step.value_or(is_static() ? kDefaultStaticStep : kDefaultStep)) {
  if (options.step && !(*options.step > 0.0 && std::isfinite(*options.step))) {
    throw std::invalid_argument("step = " + std::to_string(*options.step) +
                                " s is outside the allowed range, > 0 and finite, or \"auto\"");
  }
  step_ = options.step.value_or(largest_);
  info_ = {.instruction_set = "double, element by element", .threads = 1};
  for (Moment* m : {&now_, &next_}) {
    for (auto* field : {&m->u, &m->v, &m->a, &m->elastic, &m->viscous, &m->external}) {
      field->assign(body_.vertex_count, Vec3d{});
    }
  }
}

double ImplicitScheme::stable_step() const { return std::numeric_limits<double>::infinity(); }

void ImplicitScheme::take_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) {
  now_.u.assign(displacement.begin(), displacement.end());
  now_.v.assign(velocity.begin(), velocity.end());
  if (is_static()) std::fill(now_.v.begin(), now_.v.end(), Vec3d{});
  last_h_ = 0.0;
  fresh_ = true;
  tissue_.advance_memory({now_.u, now_.v, std::numeric_limits<double>::infinity()});  // a state that is set has relaxed
  if (!options_.track_energies) return;
  energies_ = {};
  for (std::size_t i = 0; i < now_.v.size(); ++i)
    energies_.kinetic += 0.5 * body_.masses[i] * dot(now_.v[i], now_.v[i]);
  energies_.elastic = tissue_.energy(now_.u);
  energies_.initial = energies_.kinetic + energies_.elastic;
}

void ImplicitScheme::take_over(const BodyChange& change) {
  for (const MovedVertex& m : change.moved) now_.u[m.vertex] = m.displacement, now_.v[m.vertex] = m.velocity;
  for (auto* field : {&now_.u, &now_.v, &now_.a}) {
    for (const std::uint32_t origin : change.origins) field->push_back(Vec3d((*field)[origin]));
  }
  tissue_.body_changed();
  unit_force_ = unit_force(body_);
  last_h_ = 0.0;
  fresh_ = true;
}

void ImplicitScheme::take_out(double kinetic, double elastic) {
  energies_.removed += kinetic + elastic;
  energies_.kinetic -= kinetic;
  energies_.elastic -= elastic;
}

void ImplicitScheme::take_tissues(const TissueChange& change) {
  tissue_.tissues_changed(change.blocks, now_.u);
  for (std::size_t i = 0; i < change.blocks.size(); ++i) {
    tissue_.set_branch_stresses(change.blocks[i], change.branch_stresses[i], now_.u);
  }
  system_.tissues_changed();
  unit_force_ = unit_force(body_);
  fresh_ = true;
}

/// Which components are held, and what the linear system is then on.
void ImplicitScheme::find_free() {
  held_.assign(3 * body_.vertex_count, 0);
  for (std::size_t i = 0; i < body_.vertex_count; ++i) {
    if (!(body_.masses[i] > 0.0)) held_[3 * i] = held_[3 * i + 1] = held_[3 * i + 2] = 1;
  }
  for (std::size_t c = 0; c < base_.size(); ++c) {
    if (!holds(c)) continue;
    for (const std::uint32_t v : constraints_.all()[c].vertices) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (has_axis(constraints_.all()[c].axes, axis)) held_[3 * v + axis] = 1;
      }
    }
  }
  std::vector<char> free(held_.size());
  for (std::size_t i = 0; i < free.size(); ++i) free[i] = held_[i] == 0 ? 1 : 0;
  system_.set_free(std::move(free));
}

/// Memory for as many vertices as there are now.
void ImplicitScheme::make_room() {
  for (auto* field : {&now_.elastic, &now_.viscous, &change_, &held_velocity_, &at_u_, &at_v_, &out_of_balance_}) {
    field->resize(body_.vertex_count);
  }
  diagonal_.assign(body_.vertex_count, 0.0);
  next_ = now_;
}

/// Forces and accelerations of a state that this scheme did not make itself.
void ImplicitScheme::start_fresh() {
  make_room();
  if (last_h_ == 0.0) last_change_.assign(body_.vertex_count, Vec3d{});
  find_free();
  tissue_.forces({now_.u, now_.v, is_static() ? std::numeric_limits<double>::infinity() : 0.0}, now_.elastic,
                 now_.viscous, watch_);
  const std::span<const Vec3d> loads = loads_.at(time_);
  now_.external.assign(loads.begin(), loads.end());
  now_.gravity = gravity_at(time_);
  for (std::size_t i = 0; i < body_.vertex_count; ++i) {
    const double m = body_.masses[i];
    now_.a[i] = {};
    if (!(m > 0.0) || is_static()) continue;
    const Vec3d force = now_.elastic[i] + now_.viscous[i] + now_.external[i] + now_.v[i] * -gamma_[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (held_[3 * i + axis] == 0) now_.a[i][axis] = force[axis] / m + now_.gravity[axis];
    }
  }
  fresh_ = false;
}

/// Where held components are to be at t + h, and how fast.
void ImplicitScheme::prescribe(const TimeStep& s) {
  std::fill(change_.begin(), change_.end(), Vec3d{});
  std::fill(held_velocity_.begin(), held_velocity_.end(), Vec3d{});
  const bool of_change = options_.implicit.scheme == TimeScheme::backward_euler;
  for (std::size_t c = 0; c < base_.size(); ++c) {
    const Constraint& constraint = constraints_.all()[c];
    if (!holds(c) || !constraint.motion) continue;
    const double d = kDifference * s.h;
    const Vec3d target = constraint.motion(time_ + s.h);
    const Vec3d speed = is_static() || of_change
                            ? Vec3d{}
                            : (constraint.motion(time_ + s.h + d) - constraint.motion(time_ + s.h - d)) * (0.5 / d);
    for (std::size_t k = 0; k < constraint.vertices.size(); ++k) {
      const std::uint32_t v = constraint.vertices[k];
      const Vec3d change = base_[c][k] + target - now_.u[v];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!has_axis(constraint.axes, axis)) continue;
        change_[v][axis] = change[axis];
        held_velocity_[v][axis] = of_change && !is_static() ? change[axis] / s.h : speed[axis];
      }
    }
  }
}

/// v⁺, a⁺ and the state that forces are asked at, for the trial u⁺.
void ImplicitScheme::try_at(const TimeStep& s) {
  for (std::size_t i = 0; i < next_.u.size(); ++i) {
    const Vec3d du = next_.u[i] - now_.u[i];
    next_.v[i] = s.velocity(du, now_.v[i], now_.a[i]);
    next_.a[i] = s.acceleration(du, now_.v[i], now_.a[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (held_[3 * i + axis] == 0) continue;
      next_.v[i][axis] = held_velocity_[i][axis];
      next_.a[i][axis] = is_static() ? 0.0 : (held_velocity_[i][axis] - now_.v[i][axis]) / s.h;
    }
    at_u_[i] = next_.u[i] * (1.0 - s.alpha_f) + now_.u[i] * s.alpha_f;
    at_v_[i] = next_.v[i] * (1.0 - s.alpha_f) + now_.v[i] * s.alpha_f;
  }
}

/// Forces out of balance at the trial u⁺.
ImplicitScheme::Balance ImplicitScheme::evaluate(const TimeStep& s) {
  try_at(s);
  const double ahead = (1.0 - s.alpha_f) * s.h;
  tissue_.forces({at_u_, at_v_, is_static() ? std::numeric_limits<double>::infinity() : ahead}, next_.elastic,
                 next_.viscous, watch_);
  const Vec3d gravity = gravity_at(time_ + ahead);
  Balance b;
  double inertial = 0.0, external = 0.0, rounding = 0.0;
  for (std::size_t i = 0; i < next_.u.size(); ++i) {
    const double m = body_.masses[i];
    Vec3d pull = next_.external[i] + gravity * m, drag{};
    if (!is_static()) {
      const Vec3d inertia = (next_.a[i] * (1.0 - s.alpha_m) + now_.a[i] * s.alpha_m) * m;
      inertial += dot(inertia, inertia);
      rounding += m * m * dot(next_.u[i], next_.u[i]);
      drag = inertia + at_v_[i] * gamma_[i];
    }
    external += dot(pull, pull);
    out_of_balance_[i] = drag - next_.elastic[i] - next_.viscous[i] - pull;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (held_[3 * i + axis] != 0) out_of_balance_[i][axis] = 0.0;
    }
  }
  b.residual = flat(view(out_of_balance_)).norm();
  b.rounding = kRounding * s.a_rate * std::sqrt(rounding);
  b.scale = std::max({flat(view(next_.elastic)).norm(), flat(view(next_.viscous)).norm(), std::sqrt(inertial),
                      std::sqrt(external), kSmallStrain * unit_force_});
  return b;
}

void ImplicitScheme::linearise(const TimeStep& s, bool semidefinite) {
  for (std::size_t i = 0; i < diagonal_.size(); ++i) {
    diagonal_[i] = (1.0 - s.alpha_m) * s.a_rate * body_.masses[i] + (1.0 - s.alpha_f) * s.v_rate * gamma_[i];
  }
  const double since = is_static() ? std::numeric_limits<double>::infinity() : (1.0 - s.alpha_f) * s.h;
  system_.linearise({at_u_, at_v_, since}, {s.v_rate, 1.0 - s.alpha_f, diagonal_}, semidefinite);
}

/// A first u⁺: the motion goes on as it was. Where that turns tets inside out, from where the body is, with the change
/// of what is driven spread over the body by the tangent there.
bool ImplicitScheme::start(const TimeStep& s) {
  const std::size_t inverted = watch_.inverted.size();
  const double scale = last_h_ > 0.0 ? s.h / last_h_ : 0.0;
  for (std::size_t i = 0; i < next_.u.size(); ++i) {
    const Vec3d on = is_static() ? last_change_[i] * scale : now_.v[i] * s.h;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      next_.u[i][axis] = now_.u[i][axis] + (held_[3 * i + axis] != 0 ? change_[i][axis] : on[axis]);
    }
  }
  const Balance there = evaluate(s);
  if (std::isfinite(there.residual) && watch_.inverted.size() <= inverted) return true;
  next_.u = now_.u;
  if (!std::isfinite(evaluate(s).residual)) return false;
  linearise(s, false);
  std::vector<Vec3d> spread(change_.size());
  system_.apply(change_, spread);
  Eigen::VectorXd load = -(flat(view(out_of_balance_)) + flat(view(spread))), d;
  for (std::size_t c = 0; c < held_.size(); ++c) {
    if (held_[c] != 0) load[static_cast<Eigen::Index>(c)] = 0.0;
  }
  system_.solve(load, kForcing, d);
  flat(std::span<Vec3d>(next_.u)) += d + flat(view(change_));
  return d.allFinite();
}

/// Goes along the direction as far as it leads towards balance.
/// @return false, with u⁺ as before, where it does not
bool ImplicitScheme::search_line(const TimeStep& s, const Eigen::VectorXd& direction, Balance& balance) {
  const std::vector<Vec3d> from = next_.u;
  const double before = flat(view(out_of_balance_)).dot(direction), residual = balance.residual;
  double a = 1.0;
  for (int i = 0; i < kMostHalvings; ++i) {
    flat(std::span<Vec3d>(next_.u)) = flat(view(from)) + a * direction;
    const Balance there = evaluate(s);
    const double slope = flat(view(out_of_balance_)).dot(direction);
    const bool finite = std::isfinite(there.residual);
    // descent that has not gone past the valley, or not far; or simply less out of balance
    const bool along = before < 0.0 && slope <= 0.8 * std::abs(before);
    if (finite && (along || there.residual <= (1.0 - 1e-4 * a) * residual)) {
      balance = there;
      return true;
    }
    a *= finite && before < 0.0 && slope > 0.0 ? std::clamp(before / (before - slope), 0.1, 0.5) : 0.25;
  }
  next_.u = from;
  balance = evaluate(s);
  return false;
}

bool ImplicitScheme::newton(const TimeStep& s) {
  const ImplicitOptions& options = options_.implicit;
  Balance balance = evaluate(s);
  bool semidefinite = false;
  int patience = 0, wait = 0;      // iterations with definite tangents before the exact one is tried again
  double mark = balance.residual;  // to be halved within so many iterations
  int deadline = options.most_iterations;
  Eigen::VectorXd direction;
  for (iterations_ = 0; iterations_ < deadline; ++iterations_) {
    if (!std::isfinite(balance.residual)) return false;
    if (balance.met(options.tolerance)) return true;
    linearise(s, semidefinite);
    const double exact = std::max(1e-12, 0.1 * options.tolerance * balance.scale / balance.residual);
    const double accuracy = system_.is_linear() ? exact : std::max(exact, kForcing);
    const KrylovResult solved = system_.solve(-flat(view(out_of_balance_)), std::min(accuracy, 0.1), direction);
    const bool usable = direction.allFinite() && direction.squaredNorm() > 0.0;
    const bool nearer = usable && search_line(s, direction, balance);
    if (!nearer && semidefinite) return false;
    if (!semidefinite) patience = nearer && !solved.curved ? 0 : std::min(2 * patience + 1, kMostPatience);
    wait = semidefinite ? wait - 1 : patience;
    semidefinite = wait > 0;
    if (balance.residual < 0.5 * mark) mark = balance.residual, deadline = iterations_ + 1 + options.most_iterations;
  }
  return balance.met(options.tolerance);
}

/// One part of a step, of h [s]; false where no balance is found: nothing has changed then.
bool ImplicitScheme::part(double h) {
  const TimeStep s = is_static() ? static_step(h) : time_step(options_.implicit, h);
  const std::span<const Vec3d> loads = loads_.at(time_ + (1.0 - s.alpha_f) * h);
  next_.external.assign(loads.begin(), loads.end());
  const ElementWatch watch = watch_;
  prescribe(s);
  if (start(s) && newton(s)) {
    finish(s);
    return true;
  }
  watch_ = watch;
  return false;
}

void ImplicitScheme::finish(const TimeStep& s) {
  const double since = is_static() ? std::numeric_limits<double>::infinity() : s.h;
  if (s.alpha_f != 0.0) tissue_.forces({next_.u, next_.v, since}, next_.elastic, next_.viscous, watch_);
  const std::span<const Vec3d> loads = loads_.at(time_ + s.h);
  next_.external.assign(loads.begin(), loads.end());
  next_.gravity = gravity_at(time_ + s.h);
  tissue_.advance_memory({next_.u, next_.v, since});
  for (std::size_t i = 0; i < next_.u.size(); ++i) last_change_[i] = next_.u[i] - now_.u[i];
  last_h_ = s.h;
  std::swap(now_, next_);
  if (options_.track_energies) book(next_);
}

/// Works of a part: with the forces at its end (backward Euler) or the mean of both ends.
void ImplicitScheme::book(const Moment& before) {
  const bool at_end = !is_static() && options_.implicit.scheme == TimeScheme::backward_euler;
  const double w = at_end ? 0.0 : 0.5;
  double elastic = 0.0, viscous = 0.0, damping = 0.0, loads = 0.0, tools = 0.0, kinetic = 0.0, change = 0.0,
         sudden = 0.0;
  for (std::size_t i = 0; i < now_.u.size(); ++i) {
    const Vec3d &du = last_change_[i], dv = now_.v[i] - before.v[i];
    const double m = body_.masses[i], drag = is_static() ? 0.0 : gamma_[i];
    const auto mean = [&](const Vec3d& a, const Vec3d& b) { return a * w + b * (1.0 - w); };
    const Vec3d viscous_force = mean(before.viscous[i], now_.viscous[i]),
                drag_force = mean(before.v[i], now_.v[i]) * -drag;
    const Vec3d pull = mean(before.external[i] + before.gravity * m, now_.external[i] + now_.gravity * m);
    const Vec3d elastic_force = mean(before.elastic[i], now_.elastic[i]);
    elastic += 0.5 * dot(before.elastic[i] + now_.elastic[i], du);
    viscous += dot(viscous_force, du);
    damping += dot(drag_force, du);
    loads += dot(pull, du);
    kinetic += 0.5 * m * dot(now_.v[i], now_.v[i]);
    if (at_end) change += 0.5 * m * dot(dv, dv) - 0.5 * dot(now_.elastic[i] - before.elastic[i], du);
    const Vec3d others = elastic_force + viscous_force + drag_force + pull;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (held_[3 * i + axis] == 0) {
        const double out = before.elastic[i][axis] + before.external[i][axis] + before.gravity[axis] * m;
        if (is_static()) sudden += 0.5 * out * du[axis];
        continue;
      }
      const double gain = at_end
                              ? m * now_.a[i][axis] * du[axis]
                              : 0.5 * m * (now_.v[i][axis] * now_.v[i][axis] - before.v[i][axis] * before.v[i][axis]);
      tools += gain - others[axis] * du[axis];
    }
  }
  if (!is_static() && options_.implicit.scheme == TimeScheme::generalised_alpha) {
    change = tools + loads + elastic + viscous + damping - (kinetic - energies_.kinetic);
  }
  energies_.elastic -= elastic;
  energies_.dissipated -= viscous + damping;
  energies_.work_loads += loads;
  energies_.work_tools += tools;
  energies_.numerical += change + sudden;
  energies_.kinetic = kinetic;
}

/// What an automatic step is next.
void ImplicitScheme::adapt(double h, double smallest) {
  if (options_.step) return;
  if (smallest < h) {
    step_ = smallest;
  } else if (iterations_ <= kEasy) {
    step_ = std::min(kGrowth * step_, largest_);
  }
}

StepResult ImplicitScheme::failed(double smallest) {
  std::ostringstream text;
  text << "no balance of forces was found within " << options_.implicit.most_iterations << " iterations at a step of "
       << smallest << " s, the step having been cut " << options_.implicit.most_cuts
       << " times. Ways out: slower motions, "
       << (is_static() ? "the integrator \"implicit\", whose inertia carries the body over where statics has no answer"
                       : "more iterations or a coarser tolerance");
  message_ = text.str();
  return {StepStatus::not_converged, watch_.inverted, message_};
}

StepResult ImplicitScheme::step() {
  const double h = step_, begin = time_;
  fresh_ = take_hold(h) || fresh_;
  if (fresh_) {
    start_fresh();
    if (is_static() && !(message_ = free_rigid_motion(body_, held_)).empty()) {
      fresh_ = true;
      return {StepStatus::not_held, {}, message_};
    }
    if (!flat(view(now_.elastic)).allFinite() || !flat(view(now_.viscous)).allFinite()) {
      fresh_ = true;
      message_ = not_finite_at(time_);
      return {StepStatus::not_finite, watch_.inverted, message_};
    }
  }
  std::optional<Backup> backup;
  std::uint64_t left = 1;  // parts of h / 2^cuts
  int cuts = 0, most = 0;
  while (left > 0) {
    const double length = std::ldexp(h, -cuts);
    if (left > 1 && !backup) backup = Backup{now_, tissue_.memory(), energies_, last_change_, time_, last_h_};
    if (part(length)) {
      --left;
      time_ = begin + (h - static_cast<double>(left) * length);
      if (left > 0 && left % 2 == 0 && iterations_ <= kEasy) left /= 2, --cuts;
      continue;
    }
    if (cuts == options_.implicit.most_cuts) {
      if (backup) {
        now_ = std::move(backup->now);
        tissue_.set_memory(std::move(backup->memory));
        energies_ = backup->energies, last_change_ = std::move(backup->last_change);
        time_ = backup->time, last_h_ = backup->last_h;
      }
      fresh_ = true;
      adapt(h, length);
      return failed(length);
    }
    left *= 2, ++cuts;
    most = std::max(most, cuts);
  }
  adapt(h, std::ldexp(h, -most));
  ++steps_;
  return {watch_.inverted.empty() ? StepStatus::ok : StepStatus::inverted, watch_.inverted, {}};
}

void ImplicitScheme::save(CheckpointWriter& out) const {
  Scheme::save(out);
  for (const auto* f : {&now_.u, &now_.v, &now_.a, &now_.elastic, &now_.viscous, &now_.external}) out.put(*f);
  out.put(now_.gravity);
  std::vector<double> memory;
  append_memory(tissue_.memory(), memory);
  out.put(memory), out.put(watch_.inverted);
  out.put(last_change_), out.put(last_h_), out.put(step_), out.put(fresh_);
  out.put_doubles(energies_);
  if (!fresh_) system_.save(out);
}

void ImplicitScheme::load(CheckpointReader& in) {
  Scheme::load(in);
  std::vector<double> numbers;
  Moment now = now_;
  for (auto* f : {&now.u, &now.v, &now.a, &now.elastic, &now.viscous, &now.external}) {
    in.get(*f);
    if (f->size() != body_.vertex_count) CheckpointReader::fail();
  }
  in.get(now.gravity), in.get(numbers), in.get(watch_.inverted);
  TissueMemory memory = tissue_.memory();
  if (!take_memory(numbers, memory)) CheckpointReader::fail();
  tissue_.set_memory(std::move(memory));
  std::vector<Vec3d> last_change;
  in.get(last_change), in.get(last_h_), in.get(step_), in.get(fresh_);
  in.get_doubles(energies_);
  const bool begun = !fresh_ || last_h_ != 0.0;  // else the first step makes room
  const auto fits = [&](std::size_t size) { return size == body_.vertex_count || (size == 0 && !begun); };
  const auto is_tet = [&](std::uint32_t t) { return t < body_.elements.size(); };
  if (!fits(last_change.size()) || !std::all_of(watch_.inverted.begin(), watch_.inverted.end(), is_tet))
    CheckpointReader::fail();
  now_ = now;
  last_change_ = last_change;
  if (fresh_) return;
  make_room();
  find_free();
  system_.load(in);
}

/// What holds or drives a vertex, in the components it holds.
ForceParts ImplicitScheme::vertex_force(std::uint32_t v, const Axes& axes) const {
  const double m = body_.masses[v];
  const Vec3d drag = is_static() ? Vec3d{} : now_.v[v] * gamma_[v];
  return {masked(-now_.elastic[v], axes), masked(-now_.viscous[v], axes),  masked(drag, axes),
          masked(now_.a[v] * m, axes),    masked(now_.gravity * -m, axes), masked(-now_.external[v], axes)};
}

ForceParts ImplicitScheme::force(ConstraintId constraint) const {
  const Constraint& c = constraints_.at(constraint);
  ForceParts sum;
  if (!holds(constraint.index) || steps_ == 0) return sum;
  for (const std::uint32_t v : c.vertices) {
    const ForceParts f = vertex_force(v, c.axes);
    sum.elastic += f.elastic, sum.viscous += f.viscous, sum.damping += f.damping;
    sum.inertial += f.inertial, sum.gravity += f.gravity, sum.load += f.load;
  }
  return sum;
}

}  // namespace glisson
