#include "dynamics/solvers/balance_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace glisson {
namespace {

constexpr double kSmallStrain = 1e-6;  ///< forces at this strain are the least that a residual is measured by
constexpr double kForcing = 1e-3;      ///< accuracy of a linear solve within Newton's method
constexpr int kMostPatience = 7;       ///< iterations with definite tangents before an exact one is tried again
constexpr double kRounding = 1e-15;    ///< of u⁺ − u over u, which very short steps cannot do better than
constexpr int kMostHalvings = 12;      ///< of a line search
constexpr double kLeeway = 2.0;        ///< so much farther from balance an iteration with contact may lead …
constexpr double kLeastShare = 0.02;   ///< … and this share of it is taken where all lead too far
constexpr double kSlow = 0.35;  ///< of the residual: what an iteration with contact leaves where the factor is bad
constexpr double kQuick = 0.1;  ///< … and where the tangent is still good enough
constexpr double kDifference = 1e-3;  ///< of h, for the velocity of a motion

std::span<const Vec3d> view(const std::vector<Vec3d>& field) { return field; }

/// A share of the way from one field to another.
std::vector<Vec3d> between(const std::vector<Vec3d>& from, const std::vector<Vec3d>& to, double share) {
  std::vector<Vec3d> field(from.size());
  for (std::size_t v = 0; v < from.size(); ++v) field[v] = from[v] + (to[v] - from[v]) * share;
  return field;
}

/// Norm of the forces that a strain of 1 would give. @param tets  what interactions add to the stiffness of tets
double unit_force(const Body& body, std::span<const TetStiffness> tets) {
  std::vector<double> added(tets.empty() ? 0 : body.elements.size(), 0.0);  // per tet of the mesh
  for (const TetStiffness& t : tets) added[t.tet] += t.slope[0];
  double sum = 0.0;
  for (const TissueBlock& block : body.blocks) {
    const double own = block.elastic.lambda + 2.0 * block.elastic.mu;
    for (std::size_t e = block.begin; e < block.end; ++e) {
      const double modulus = added.empty() ? own : own + added[body.mesh_tet[e]];
      for (const Vec3d& s : body.rest[e].s) sum += std::pow(modulus * body.rest[e].volume * norm(s), 2);
    }
  }
  return std::sqrt(sum);
}

}  // namespace

BalanceSolver::BalanceSolver(BodyState& state, const TissueOperator& tissue, const Moment& now, bool statics,
                             bool relaxes)
    : state_(state), tissue_(tissue), now_(now), statics_(statics), relaxes_(relaxes),
      system_(tissue_, state.options.implicit.preconditioner, interrupt_), contact_(state_, system_) {
  contact_.set_interrupt(interrupt_);
}

void BalanceSolver::begin() {
  const std::size_t vertices = state_.body.vertex_count;
  for (auto* field : {&change_, &held_velocity_, &at_u_, &at_v_, &out_of_balance_}) field->resize(vertices);
  diagonal_.assign(vertices, Vec3d{});
  next_ = now_;
  unit_force_ = unit_force(state_.body, contact_.tet_stiffness(0.0));
  hold();
}

/// Takes what supports, motions and interactions hold.
void BalanceSolver::hold() {
  held_ = state_.held_components();
  for (const std::uint32_t v : contact_.interactions().held_still())
    held_[3 * v] = held_[3 * v + 1] = held_[3 * v + 2] = 1;
  std::vector<char> free(held_.size());
  for (std::size_t i = 0; i < free.size(); ++i) free[i] = held_[i] == 0 ? 1 : 0;
  system_.set_free(std::move(free));
}

bool BalanceSolver::solve(const TimeStep& s, std::span<const Vec3d> last_change, double last_h) {
  interrupt_.set_progress({.time = state_.time, .h = s.h});
  load(s);
  watch_before_ = watch_;
  prescribe(s);
  if (contact_.acts() && contact_.begin(s.h, now_.u, !relaxes_ && contact_.constrains())) hold();
  const std::optional<Balance> first = start(s, last_change, last_h);
  const bool found = first && (contact_.constrains() ? newton_in_contact(s, *first) : newton(s, *first));
  if (found && !interrupt_.is_wanted()) {
    if (contact_.acts()) next_.contact = contact_.forces();
    return true;
  }
  give_up();
  return false;
}

void BalanceSolver::give_up() {
  if (contact_.acts()) contact_.give_up();
  watch_ = watch_before_;
}

/// Time over which branches go on to the state that forces are asked at [s].
double BalanceSolver::since(const TimeStep& s) const {
  if (relaxes_) return std::numeric_limits<double>::infinity();
  return statics_ && !tissue_.has_memory() ? 0.0 : (1.0 - s.alpha_f) * s.h;
}

/// What acts from outside, at the state that forces are asked at.
void BalanceSolver::load(const TimeStep& s) {
  const std::span<const Vec3d> loads = state_.loads_at(state_.time + (1.0 - s.alpha_f) * s.h, at_u_);
  next_.external.assign(loads.begin(), loads.end());
}

/// Where held components are to be at t + h, and how fast.
void BalanceSolver::prescribe(const TimeStep& s) {
  std::fill(change_.begin(), change_.end(), Vec3d{});
  std::fill(held_velocity_.begin(), held_velocity_.end(), Vec3d{});
  const bool of_change = state_.options.implicit.scheme == TimeScheme::backward_euler;
  for (std::size_t c = 0; c < state_.base.size(); ++c) {
    const Constraint& constraint = state_.constraints.all()[c];
    if (!state_.holds(c) || !constraint.moves()) continue;
    const double d = kDifference * s.h, end = state_.time + s.h;
    const bool needs_speed = !statics_ && !of_change;
    const Target target(constraint, end), after(constraint, needs_speed ? end + d : end),
        earlier(constraint, needs_speed ? end - d : end);
    for (std::size_t k = 0; k < constraint.vertices.size(); ++k) {
      const std::uint32_t v = constraint.vertices[k];
      const Vec3d &base = state_.base[c][k], &rest = state_.body.rest_positions[v];
      const Vec3d change = target.displacement(base, rest) - now_.u[v];
      const Vec3d speed = needs_speed ? after.since(earlier, base) * (0.5 / d) : Vec3d{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!has_axis(constraint.axes_of(k), axis)) continue;
        change_[v][axis] = change[axis];
        held_velocity_[v][axis] = of_change && !statics_ ? change[axis] / s.h : speed[axis];
      }
    }
  }
}

/// v⁺, a⁺ and the state that forces are asked at, for the trial u⁺.
void BalanceSolver::try_at(const TimeStep& s) {
  for (std::size_t i = 0; i < next_.u.size(); ++i) {
    const Vec3d du = next_.u[i] - now_.u[i];
    next_.v[i] = s.velocity(du, now_.v[i], now_.a[i]);
    next_.a[i] = s.acceleration(du, now_.v[i], now_.a[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (held_[3 * i + axis] == 0 || statics_) continue;
      next_.v[i][axis] = held_velocity_[i][axis];
      next_.a[i][axis] = (held_velocity_[i][axis] - now_.v[i][axis]) / s.h;
    }
    at_u_[i] = next_.u[i] * (1.0 - s.alpha_f) + now_.u[i] * s.alpha_f;
    at_v_[i] = next_.v[i] * (1.0 - s.alpha_f) + now_.v[i] * s.alpha_f;
  }
}

/// Forces out of balance at the trial u⁺.
BalanceSolver::Balance BalanceSolver::evaluate(const TimeStep& s) {
  try_at(s);
  const double ahead = (1.0 - s.alpha_f) * s.h;
  tissue_.forces({at_u_, at_v_, since(s)}, next_.elastic, next_.viscous, watch_);
  contact_.add_forces_at(at_u_, next_.elastic);
  contact_.add_viscous_forces_at(at_u_, at_v_, next_.viscous);
  if (state_.loads.depends_on_state()) load(s);
  const Vec3d gravity = state_.gravity_at(state_.time + ahead);
  Balance b;
  double inertial = 0.0, external = 0.0, rounding = 0.0, contact = 0.0;
  const bool touched = contact_.acts();
  for (std::size_t i = 0; i < next_.u.size(); ++i) {
    const double m = state_.body.masses[i];
    Vec3d pull = next_.external[i] + gravity * m, drag = component_product(state_.damping(i, statics_), at_v_[i]);
    if (!statics_) {
      const Vec3d inertia = (next_.a[i] * (1.0 - s.alpha_m) + now_.a[i] * s.alpha_m) * m;
      inertial += dot(inertia, inertia);
      rounding += m * m * dot(next_.u[i], next_.u[i]);
      drag = inertia + drag;
    }
    external += dot(pull, pull);
    if (touched) pull += contact_.forces()[i], contact += dot(contact_.forces()[i], contact_.forces()[i]);
    out_of_balance_[i] = drag - next_.elastic[i] - next_.viscous[i] - pull;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (held_[3 * i + axis] != 0) out_of_balance_[i][axis] = 0.0;
    }
  }
  b.residual = flat(view(out_of_balance_)).norm();
  b.rounding = kRounding * s.a_rate * std::sqrt(rounding);
  b.scale = std::max({flat(view(next_.elastic)).norm(), flat(view(next_.viscous)).norm(), std::sqrt(inertial),
                      std::sqrt(external), std::sqrt(contact), kSmallStrain * unit_force_});
  return b;
}

void BalanceSolver::linearise(const TimeStep& s, bool semidefinite, bool anew) {
  for (std::size_t i = 0; i < diagonal_.size(); ++i) {
    const Vec3d damping = state_.damping(i, statics_), spring = state_.loads.spring(i);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      diagonal_[i][axis] = (1.0 - s.alpha_m) * s.a_rate * state_.body.masses[i] +
                           (1.0 - s.alpha_f) * s.v_rate * damping[axis] + (1.0 - s.alpha_f) * spring[axis];
    }
  }
  const double time = state_.time + (1.0 - s.alpha_f) * s.h;
  system_.linearise({at_u_, at_v_, since(s)},
                    {s.v_rate, 1.0 - s.alpha_f, diagonal_, state_.loads.stiffness(time, state_.body, at_u_),
                     contact_.stiffness(), contact_.tet_stiffness(s.v_rate)},
                    semidefinite, anew);
}

Imbalance BalanceSolver::imbalance_at(std::span<const Vec3d> u) {
  next_.u.assign(u.begin(), u.end());
  const TimeStep now = static_step(0.0);
  try_at(now);
  load(now);
  const Balance balance = evaluate(now);
  flat(std::span<Vec3d>(out_of_balance_)) *= -1.0;
  return {balance.residual, balance.scale, out_of_balance_};
}

bool BalanceSolver::is_stable_here() {
  linearise(static_step(0.0), false);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  Eigen::VectorXd force(static_cast<Eigen::Index>(held_.size())), moved;
  for (std::size_t c = 0; c < held_.size(); ++c) {
    force[static_cast<Eigen::Index>(c)] = held_[c] != 0 ? 0.0 : number(random);
  }
  return !system_.solve(force, kForcing, moved).curved;
}

bool BalanceSolver::respond(std::span<const Vec3d> forces, double accuracy, std::vector<Vec3d>& displacement) {
  Eigen::VectorXd moved;
  system_.solve(flat(forces), accuracy, moved);
  displacement.resize(forces.size());
  flat(std::span<Vec3d>(displacement)) = moved;
  return moved.allFinite();
}

/// A first u⁺: the motion goes on as it was. Where that turns tets inside out, from where the body is, with the change
/// of what is driven spread over the body by the tangent there.
/// @return how far from balance it is; none where nothing finite is found
std::optional<BalanceSolver::Balance> BalanceSolver::start(const TimeStep& s, std::span<const Vec3d> last_change,
                                                           double last_h) {
  const std::size_t inverted = watch_.inverted.size();
  const double scale = last_h > 0.0 ? s.h / last_h : 0.0;
  for (std::size_t i = 0; i < next_.u.size(); ++i) {
    const Vec3d on = statics_ ? last_change[i] * scale : now_.v[i] * s.h;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      next_.u[i][axis] = now_.u[i][axis] + (held_[3 * i + axis] != 0 ? change_[i][axis] : on[axis]);
    }
  }
  const Balance there = evaluate(s);
  if (std::isfinite(there.residual) && watch_.inverted.size() <= inverted) return there;
  next_.u = now_.u;
  if (!std::isfinite(evaluate(s).residual)) return {};
  linearise(s, false);
  std::vector<Vec3d> spread(change_.size());
  system_.apply(change_, spread);
  Eigen::VectorXd load = -(flat(view(out_of_balance_)) + flat(view(spread))), d;
  for (std::size_t c = 0; c < held_.size(); ++c) {
    if (held_[c] != 0) load[static_cast<Eigen::Index>(c)] = 0.0;
  }
  system_.solve(load, kForcing, d);
  flat(std::span<Vec3d>(next_.u)) += d + flat(view(change_));
  return d.allFinite() ? std::optional(evaluate(s)) : std::nullopt;
}

/// Goes along the direction as far as it leads towards balance.
/// @return false, with u⁺ as before, where it does not
bool BalanceSolver::search_line(const TimeStep& s, const Eigen::VectorXd& direction, Balance& balance) {
  const std::vector<Vec3d> from = next_.u;
  const double before = flat(view(out_of_balance_)).dot(direction), residual = balance.residual;
  double a = 1.0;
  for (int i = 0; i < kMostHalvings && !interrupt_.wanted(); ++i) {
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

/// Takes u⁺ and forces of contact as an iteration has found them, or goes back towards where they were, `from` and `forces`,
/// where that leads far away from balance. @return whether all was taken
bool BalanceSolver::go_towards(const TimeStep& s, const std::vector<Vec3d>& from, const std::vector<Vec3d>& forces,
                               bool first, Balance& balance) {
  const std::vector<Vec3d> to = next_.u;
  const std::vector<Vec3d> to_forces = contact_.forces();
  const std::size_t inverted = watch_.inverted.size();
  const double before = balance.residual;
  double share = 1.0;
  for (int i = 0; i < kMostHalvings && !interrupt_.wanted(); ++i) {
    balance = evaluate(s);
    const bool nearer = first || balance.residual <= kLeeway * before || balance.met(state_.options.implicit.tolerance);
    if (std::isfinite(balance.residual) && nearer && watch_.inverted.size() <= inverted) return share == 1.0;
    share *= 0.5;
    if (share < kLeastShare && std::isfinite(balance.residual)) break;
    next_.u = between(from, to, share);
    contact_.set_forces(between(forces, to_forces, share));
  }
  return false;
}

/// Newton's method on equilibrium and contact together: an iteration with the forces of contact as they are, then these anew at
/// where it leads. At the end both hold for one state.
bool BalanceSolver::newton_in_contact(const TimeStep& s, Balance balance) {
  const ImplicitOptions& options = state_.options.implicit;
  bool semidefinite = false;
  double mark = std::numeric_limits<double>::infinity(), last = mark;
  int deadline = options.most_iterations;
  Eigen::VectorXd direction;
  for (iterations_ = 0; iterations_ < deadline; ++iterations_) {
    interrupt_.set_iteration(iterations_);
    if (!std::isfinite(balance.residual) || interrupt_.wanted()) return false;
    linearise(s, semidefinite, iterations_ == 0 || semidefinite || balance.residual > kQuick * last);
    if (iterations_ > 1 && balance.residual > kSlow * last && !system_.is_linear()) system_.renew();
    const double exact = std::max(1e-12, 0.1 * options.tolerance * balance.scale / balance.residual);
    const double accuracy = system_.is_linear() ? exact : std::max(exact, kForcing);
    const bool even = !(balance.residual > 0.0) && system_.factor_number() > 0;
    if (even) {
      direction = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(held_.size()));
    } else {
      const KrylovResult solved = system_.solve(-flat(view(out_of_balance_)), std::min(accuracy, 0.1), direction);
      semidefinite = solved.curved;
      if (!direction.allFinite()) return false;
    }
    const std::vector<Vec3d> from = next_.u;
    const std::vector<Vec3d> forces = contact_.forces();
    flat(std::span<Vec3d>(next_.u)) += direction;
    if (!contact_.correct(next_.u)) return false;
    last = balance.residual;
    const bool whole = go_towards(s, from, forces, iterations_ == 0, balance);
    contact_.set_taken(whole);
    if (whole && contact_.agrees() && balance.met(options.tolerance)) return true;
    if (iterations_ == 0 || balance.residual < 0.5 * mark) {
      mark = balance.residual, deadline = iterations_ + 1 + options.most_iterations;
    }
  }
  return false;
}

bool BalanceSolver::newton(const TimeStep& s, Balance balance) {
  const ImplicitOptions& options = state_.options.implicit;
  bool semidefinite = false;
  int patience = 0, wait = 0;      // iterations with definite tangents before the exact one is tried again
  double mark = balance.residual;  // to be halved within so many iterations
  int deadline = options.most_iterations;
  Eigen::VectorXd direction;
  for (iterations_ = 0; iterations_ < deadline; ++iterations_) {
    interrupt_.set_iteration(iterations_);
    if (!std::isfinite(balance.residual) || interrupt_.wanted()) return false;
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

}  // namespace glisson
