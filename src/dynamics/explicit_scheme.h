// explicit_scheme.h — a body in motion under the paper's explicit scheme.
//
// In displacement and velocity, with v₋ = (u(t) − u(t−h))/h and v₊ = (u(t+h) − u(t))/h, the paper's
//   u(t+h) = [ h² F + (2m + γh) u(t) − m u(t−h) ] / (m + γh)            [Schwartz2002, eq. 4]
// becomes
//   v₊ = (m v₋ + h F) / (m + γ h),   u(t+h) = u(t) + h v₊.
// The viscous force is taken at v₋: it lags by half a step, which the stable step accounts for.
//
//   evaluate forces at u, v₋ ─▶ keep h below h* ─▶ kick v₋ → v₊ ─▶ impose motions ─▶ book work ─▶ drift u
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "dynamics/constraints.h"
#include "dynamics/energy_ledger.h"
#include "dynamics/loads.h"
#include "dynamics/step_control.h"
#include "glisson/simulation.h"
#include "mechanics/force_operator.h"

namespace glisson {

class ExplicitScheme {
 public:
  /// @throws std::invalid_argument as Simulation's constructor
  ExplicitScheme(Body body, const SimulationOptions& options);
  ExplicitScheme(const ExplicitScheme&) = delete;
  ExplicitScheme& operator=(const ExplicitScheme&) = delete;

  ConstraintId add_constraint(Constraint constraint);
  Loads& loads() { return loads_; }
  void set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity);

  StepResult step();

  const Body& body() const { return body_; }
  const StepControl& control() const { return *control_; }
  double time() const { return time_; }
  std::uint64_t steps() const { return steps_; }
  std::span<const Vec3d> displacement() const { return u_; }
  std::span<const Vec3d> velocity() const { return v_; }
  const Energies& energies() const { return ledger_.now(); }
  /// What the constraint exerted on the tissue at the last kick.
  ForceParts force(ConstraintId constraint) const;

 private:
  Vec3d gravity_at(double time) const;
  void kick(double h);
  void impose_motions(double h);
  ForceParts vertex_force(std::size_t vertex, const Axes& axes) const;
  KickPower power(std::span<const Vec3d> velocity) const;
  void add_tool_power(KickPower& before, KickPower& after) const;
  double kinetic() const;
  void take_hold(double h);
  bool holds(std::size_t constraint) const { return !base_[constraint].empty(); }
  void rebase(std::size_t constraint);

  SimulationOptions options_;
  Body body_;
  std::unique_ptr<ForceOperator> tissue_;
  std::vector<double> gamma_;  ///< nodal damping [kg/s]
  Constraints constraints_;
  std::vector<std::vector<Vec3d>> base_;  ///< per constraint: displacement its motion counts from [m]; empty: not yet
  Loads loads_;
  std::unique_ptr<StepControl> control_;

  double time_ = 0.0;
  std::uint64_t steps_ = 0;
  std::vector<Vec3d> u_, v_, v_before_;  ///< v₊ and v₋ of the last step

  // at the last kick
  double kick_step_ = 0.0;
  std::vector<Vec3d> elastic_, viscous_;
  std::span<const Vec3d> load_;
  Vec3d gravity_{};
  ElementWatch watch_;
  EnergyLedger ledger_;
};

}  // namespace glisson
