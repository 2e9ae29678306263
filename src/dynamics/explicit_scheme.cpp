#include "dynamics/explicit_scheme.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "dynamics/flush_denormals.h"
#include "mechanics/tet_fields.h"

namespace glisson {
namespace {

std::vector<double> nodal_damping(const Body& body, const SimulationOptions& o) {
  std::vector<double> gamma;
  for (const double m : body.masses) gamma.push_back(o.damping_rate * m + o.nodal_damping);
  return gamma;
}

}  // namespace

ExplicitScheme::ExplicitScheme(Body body, const SimulationOptions& options)
    : options_(options), body_(std::move(body)), tissue_(make_element_operator(body_, options.precision)),
      gamma_(nodal_damping(body_, options)), constraints_(body_.vertex_count), loads_(body_.vertex_count) {
  for (auto* field : {&u_, &v_, &v_before_, &elastic_, &viscous_}) field->assign(body_.vertex_count, Vec3d{});
  load_ = loads_.at(0.0);
  tissue_->evaluate(u_, v_, elastic_, viscous_, watch_);
  control_ = std::make_unique<StepControl>(body_, gamma_, options.step, options.enforce_stability, watch_.stiffening);
}

ConstraintId ExplicitScheme::add_constraint(Constraint constraint) {
  const ConstraintId id = constraints_.add(std::move(constraint));
  base_.emplace_back();
  if (constraints_.at(id).from <= time_) rebase(id.index);
  return id;
}

/// Lets those constraints take hold whose time has come by the middle of the step.
void ExplicitScheme::take_hold(double h) {
  for (std::size_t c = 0; c < base_.size(); ++c) {
    if (!holds(c) && constraints_.all()[c].from <= time_ + 0.5 * h) rebase(c);
  }
}

/// Lets a constraint's motion count from where its vertices are now.
void ExplicitScheme::rebase(std::size_t constraint) {
  const Constraint& c = constraints_.all()[constraint];
  const Vec3d moved = c.motion ? c.motion(time_) : Vec3d{};
  base_[constraint].clear();
  for (const std::uint32_t i : c.vertices) base_[constraint].push_back(u_[i] - moved);
}

void ExplicitScheme::set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) {
  if (displacement.size() != u_.size() || velocity.size() != v_.size()) {
    throw std::invalid_argument("set_state: " + std::to_string(displacement.size()) + " displacements and " +
                                std::to_string(velocity.size()) + " velocities given, the mesh has " +
                                std::to_string(u_.size()) + " vertices");
  }
  u_.assign(displacement.begin(), displacement.end());
  v_.assign(velocity.begin(), velocity.end());
  for (std::size_t c = 0; c < base_.size(); ++c) {
    if (holds(c)) rebase(c);
  }
  double kinetic = 0.0;
  for (std::size_t i = 0; i < v_.size(); ++i) kinetic += 0.5 * body_.masses[i] * dot(v_[i], v_[i]);
  ledger_.reset(kinetic, secant_energy(body_, u_));
}

Vec3d ExplicitScheme::gravity_at(double time) const {
  return options_.gravity * (time < options_.gravity_ramp ? time / options_.gravity_ramp : 1.0);
}

/// v₊ of every vertex as if it were free; massless vertices (in no tet) stay.
void ExplicitScheme::kick(double h) {
  for (std::size_t i = 0; i < v_.size(); ++i) {
    const double m = body_.masses[i];
    const Vec3d force = elastic_[i] + viscous_[i] + gravity_ * m + load_[i];
    v_[i] = m > 0.0 ? (v_before_[i] * m + force * h) * (1.0 / (m + gamma_[i] * h)) : Vec3d{};
  }
}

/// Replaces v₊ of held and driven components by what their motion asks for.
void ExplicitScheme::impose_motions(double h) {
  for (std::size_t c = 0; c < constraints_.all().size(); ++c) {
    if (!holds(c)) continue;
    const Constraint& constraint = constraints_.all()[c];
    const Vec3d target = constraint.motion ? constraint.motion(time_ + h) : Vec3d{};
    for (std::size_t k = 0; k < constraint.vertices.size(); ++k) {
      const std::size_t i = constraint.vertices[k];
      const Vec3d wanted = constraint.motion ? (base_[c][k] + target - u_[i]) * (1.0 / h) : Vec3d{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (has_axis(constraint.axes, axis)) v_[i][axis] = wanted[axis];
      }
    }
  }
}

/// What holds or drives a vertex, in the components it holds, at the last kick.
ForceParts ExplicitScheme::vertex_force(std::size_t i, const Axes& axes) const {
  const double m = body_.masses[i];
  const Vec3d inertial = kick_step_ > 0.0 ? (v_[i] - v_before_[i]) * (m / kick_step_) : Vec3d{};
  return {masked(-elastic_[i], axes), masked(-viscous_[i], axes),  masked(v_[i] * gamma_[i], axes),
          masked(inertial, axes),     masked(gravity_ * -m, axes), masked(-load_[i], axes)};
}

KickPower ExplicitScheme::power(std::span<const Vec3d> velocity) const {
  KickPower p;
  for (std::size_t i = 0; i < velocity.size(); ++i) {
    p.elastic += dot(elastic_[i], velocity[i]);
    p.viscous += dot(viscous_[i], velocity[i]);
    p.damping -= gamma_[i] * dot(v_[i], velocity[i]);
    p.loads += dot(gravity_ * body_.masses[i] + load_[i], velocity[i]);
  }
  return p;
}

void ExplicitScheme::add_tool_power(KickPower& before, KickPower& after) const {
  for (std::size_t index = 0; index < base_.size(); ++index) {
    if (!holds(index)) continue;
    const Constraint& c = constraints_.all()[index];
    for (const std::uint32_t i : c.vertices) {
      const Vec3d f = vertex_force(i, c.axes).total();
      before.tools += dot(f, v_before_[i]);
      after.tools += dot(f, v_[i]);
    }
  }
}

/// ½ Σ m v₋·v₊ [J].
double ExplicitScheme::kinetic() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < v_.size(); ++i) sum += body_.masses[i] * dot(v_before_[i], v_[i]);
  return 0.5 * sum;
}

StepResult ExplicitScheme::step() {
  const FlushDenormals flush;
  tissue_->evaluate(u_, v_, elastic_, viscous_, watch_);
  if (!control_->accept(watch_.stiffening)) return {StepStatus::step_too_large, watch_.inverted};

  const double h = kick_step_ = control_->step();
  gravity_ = gravity_at(time_);
  load_ = loads_.at(time_);
  take_hold(h);
  std::swap(v_, v_before_);
  kick(h);
  impose_motions(h);

  KickPower before = power(v_before_), after = power(v_);
  add_tool_power(before, after);
  const double kinetic_now = kinetic();
  if (!std::isfinite(kinetic_now + after.elastic + after.viscous)) {
    std::swap(v_, v_before_);
    return {StepStatus::not_finite, watch_.inverted};
  }
  ledger_.book(h, before, after, kinetic_now);
  for (std::size_t i = 0; i < u_.size(); ++i) u_[i] += v_[i] * h;
  time_ += h;
  ++steps_;
  return {watch_.inverted.empty() ? StepStatus::ok : StepStatus::inverted, watch_.inverted};
}

ForceParts ExplicitScheme::force(ConstraintId constraint) const {
  const Constraint& c = constraints_.at(constraint);
  ForceParts sum;
  if (!holds(constraint.index)) return sum;
  for (const std::uint32_t i : c.vertices) {
    const ForceParts f = vertex_force(i, c.axes);
    sum.elastic += f.elastic, sum.viscous += f.viscous, sum.damping += f.damping;
    sum.inertial += f.inertial, sum.gravity += f.gravity, sum.load += f.load;
  }
  return sum;
}

}  // namespace glisson
