// balance_solver.h — the end of a step at which all forces are in balance, by Newton's method.
//
//   M a_α + γ v_α + f(u_α, v_α) = external(t_α)       on the free components, u⁺ unknown (time_steps.h)
//
//   ┌ start: u + h v or u, motions lifted through the tangent ┐
//   │ tangent ─▶ Krylov ─▶ line search … until balance        │
//   └ no balance: nothing has changed                         ┘
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "dynamics/solvers/step_contact.h"
#include "dynamics/solvers/tangent_system.h"
#include "dynamics/state/body_state.h"
#include "dynamics/step/time_steps.h"

namespace glisson {

/// Motion and forces at one time.
struct Moment {
  std::vector<Vec3d> u, v, a;
  std::vector<Vec3d> elastic, viscous;  ///< [N]
  std::vector<Vec3d> external;          ///< loads, without gravity [N]
  std::vector<Vec3d> contact;           ///< of interactions [N]
  Vec3d gravity{};

  void resize(std::size_t vertices) {
    for (auto* field : {&u, &v, &a, &elastic, &viscous, &external, &contact}) field->resize(vertices);
  }
  void archive(Archive& ar) {
    for (auto* field : {&u, &v, &a, &elastic, &viscous, &external, &contact}) ar.same_size(*field);
    ar(gravity);
  }
};

/// How far a state is from equilibrium.
struct Imbalance {
  double residual = 0.0;          ///< norm of the forces out of balance on the free components [N]
  double scale = 0.0;             ///< norm of the largest kind of force [N]
  std::span<const Vec3d> forces;  ///< what the body pulls and is pulled with on the free components, per vertex [N]
};

class BalanceSolver {
 public:
  /// All must outlive this. @param now  where steps start from  @param statics  without M and γ
  /// @param relaxes  in statics: branches have relaxed, viscosity gives nothing
  BalanceSolver(BodyState& state, const TissueOperator& tissue, const Moment& now, bool statics, bool relaxes);

  /// What is held, or the body, or its tissues have changed.
  void begin();
  void tissues_changed() { system_.tissues_changed(); }

  /// Finds the moment after a step. @param last_change  of u in the last step, of last_h [s], which statics goes on with
  /// @return false where there is no balance
  bool solve(const TimeStep& s, std::span<const Vec3d> last_change, double last_h);
  /// Asked within a solve, which then finds no balance.
  StepInterrupt& interrupt() { return interrupt_; }
  /// Takes the step that was solved for back.
  void give_up();
  /// In statics, after begin(): how far a displacement of the free components is from equilibrium now. Valid until the next call.
  Imbalance imbalance_at(std::span<const Vec3d> u);
  /// Takes the definite tangent at the last imbalance_at().
  void linearise_here() { linearise(static_step(0.0), true); }
  /// Whether the equilibrium at the last imbalance_at() is stable, as far as conjugate gradients see: with a symmetric tangent.
  bool is_stable_here();
  /// The displacement that forces on the free components give by the tangent that was taken last [m]. @return whether it is finite
  bool respond(std::span<const Vec3d> forces, double accuracy, std::vector<Vec3d>& displacement);
  Moment& next() { return next_; }
  StepContact& contact() { return contact_; }
  const StepContact& contact() const { return contact_; }
  /// Interactions act from now on, which need a factor.
  void need_factor() { system_.need_factor(); }

  int iterations() const { return iterations_; }  ///< of the last solve
  ElementWatch& watch() { return watch_; }
  /// Per component: held by a constraint, or of a vertex in no tet.
  const std::vector<char>& held() const { return held_; }
  /// After begin(), with what is held as it was when it was written.
  void archive(Archive& ar) { ar(system_); }
  std::shared_ptr<const void> save_factor() const { return system_.save_factor(); }
  void load_factor(const std::shared_ptr<const void>& factor) { system_.load_factor(factor); }

 private:
  /// How far from balance a trial is.
  struct Balance {
    double residual = 0.0;  ///< norm of the forces out of balance on the free components [N]
    double scale = 0.0;     ///< norm of the largest kind of force [N]
    double rounding = 0.0;  ///< what rounding leaves of the residual [N]
    bool met(double tolerance) const { return residual <= tolerance * scale + rounding; }
  };

  void hold();
  double since(const TimeStep& s) const;
  void prescribe(const TimeStep& s);
  Balance evaluate(const TimeStep& s);
  void try_at(const TimeStep& s);
  void load(const TimeStep& s);
  std::optional<Balance> start(const TimeStep& s, std::span<const Vec3d> last_change, double last_h);
  bool newton(const TimeStep& s, Balance balance);
  bool newton_in_contact(const TimeStep& s, Balance balance);
  bool go_towards(const TimeStep& s, const std::vector<Vec3d>& from, const std::vector<Vec3d>& forces, bool first,
                  Balance& balance);
  void linearise(const TimeStep& s, bool semidefinite, bool anew = true);
  bool search_line(const TimeStep& s, const Eigen::VectorXd& direction, Balance& balance);

  BodyState& state_;
  const TissueOperator& tissue_;
  const Moment& now_;
  bool statics_, relaxes_;
  StepInterrupt interrupt_;
  TangentSystem system_;
  StepContact contact_;
  Moment next_;
  ElementWatch watch_, watch_before_;  ///< now, and before the step
  std::vector<char> held_;
  std::vector<Vec3d> change_;         ///< u⁺ − u of held components [m]
  std::vector<Vec3d> held_velocity_;  ///< of held components at t + h [m/s]
  std::vector<Vec3d> at_u_, at_v_;    ///< state that forces are asked at
  std::vector<Vec3d> out_of_balance_;
  std::vector<Vec3d> diagonal_;
  double unit_force_ = 0.0;  ///< norm of the forces at a strain of 1 [N]
  int iterations_ = 0;
};

}  // namespace glisson
