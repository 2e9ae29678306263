// implicit_scheme.h — a body in motion, or in equilibrium, by Newton's method: the integrators `implicit` and `quasi_static`.
//
//   step ─▶ hold what takes hold ─▶ balance at the end (balance_solver.h) ─▶ book ─▶ next part
//                 ▲                                   │
//                 └── cut in two ◀── no balance ──────┘
//
// Statics is the same with α_f = 0 and no M and γ: with the tissue's long-time stress and no viscosity, or with both in the time of
// motions and loads (StaticBranches). A slow step then has two halves; what two of them make of the branches and what one would says
// how wrong it is, and an automatic one that is too wrong is made anew, shorter. Where something is sudden, at the start and after
// changes from outside, an instant comes first in which nothing relaxes.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/schemes/scheme.h"
#include "dynamics/solvers/balance_solver.h"

namespace glisson {

class ImplicitScheme : public Scheme {
 public:
  static constexpr IntegratorInfo kInfo{
      Integrator::implicit, {.supports_contact = true, .any_step_is_stable = true, .forces_at_step_end = true}};

  /// @throws std::invalid_argument as Simulation's constructor
  ImplicitScheme(Body body, const SimulationOptions& options, bool statics = false);

  StepResult step() override;
  void set_interrupt(std::function<bool(const StepProgress&)> asks) override {
    solver_.interrupt().set(std::move(asks));
  }
  /// An automatic step ends at the next corner, and what is left to there is divided into equal ones.
  double step_size() const override;
  void set_step_end(double time) override { step_end_ = time; }
  double stable_step() const override;
  double force_time() const override { return state_.time; }
  std::span<const Vec3d> displacement() const override { return now_.u; }
  std::span<const Vec3d> velocity() const override { return now_.v; }
  Vec3d displacement_of(std::uint32_t vertex) const override { return now_.u[vertex]; }
  Vec3d velocity_of(std::uint32_t vertex) const override { return now_.v[vertex]; }
  ForceParts force(ConstraintId constraint) const override;
  Vec3d torque(ConstraintId constraint, const Vec3d& about) const override;
  BranchMemory branch_memory(std::size_t block) const override { return tissue_.branch_memory(block, 0.0, now_.u); }
  /// @throws std::invalid_argument also for time schemes other than backward Euler, and for what does not act in long steps
  void attach(std::shared_ptr<Interaction> interaction, const BodyView& body) override;
  std::span<const std::shared_ptr<Interaction>> interactions() const override {
    return solver_.contact().interactions().all();
  }
  void tell_change(const BodyView& body, std::span<const std::uint32_t> origins) override;
  void interactions_changed() override { fresh_ = true; }
  void archive_motion(Archive& ar) override;
  std::shared_ptr<const void> save_factor() const override { return fresh_ ? nullptr : solver_.save_factor(); }
  void load_factor(const std::shared_ptr<const void>& factor) override { solver_.load_factor(factor); }

 protected:
  void acts_on(std::span<const std::uint32_t>) override { fresh_ = true; }
  void take_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) override;
  void take_over(const BodyChange& change) override;
  void follow(std::span<const std::uint32_t> origins, std::uint32_t first_new) override;
  void take_body(Archive& ar) override;
  void load_layout(const std::shared_ptr<const void>& layout) override;
  std::vector<Sym3<double>> branch_stresses(std::size_t block) override {
    return tissue_.branch_stresses(block, now_.u);
  }
  BalanceSolver& solver() { return solver_; }
  /// Per component: held by a constraint, or by a spring to the ground.
  std::vector<char> held_or_sprung() const;
  void take_tissues(const TissueChange& change) override;
  void take_back_tissues(const TissueChange& change) override { take_tissues(change); }

 private:
  static constexpr int kEasy = 6;  ///< iterations up to which a step was easy

  /// What step() goes back to where a part of it fails.
  struct Backup {
    Moment now;
    TissueMemory memory;
    EnergyLedger ledger;
    std::vector<Vec3d> last_change;
    double time, last_h;
    StepContact::Backup contact;
  };
  Backup backup();
  void restore(Backup backup);

  ElementWatch& watch() { return solver_.watch(); }
  double next_end() const;
  void start_fresh();
  enum class Part { made, no_balance, overshoots };
  Part part(double h, bool dates_events);
  Part stage(const TimeStep& s, bool dates_events);
  void finish(const TimeStep& s);
  StepResult begin();
  StepResult step_of(double h, bool sudden);
  StepResult interrupted();
  double end_of(double h) const;
  bool advance(double h, double end, std::optional<Backup>& before, double& shortest);
  StepResult made();
  // slow_steps.cpp
  bool is_easy() const { return solver_.iterations() <= kEasy; }
  bool is_slow() const { return statics_ && !relaxes_; }
  bool resists() const;
  bool make_instant(double h);
  Part slow_part(double h, bool dates_events);
  double error_of(const Backup& before, double h, std::span<const Vec3d> travelled);
  StepResult slow_step_of(double h, bool sudden);
  void adapt_slow(double h, double shortest);
  std::vector<RestingVertex> resting() const;
  void book(const Moment& before);
  void adapt(double h, double smallest);
  ForceParts vertex_force(std::uint32_t vertex, const Axes& axes) const;
  StepResult failed(double smallest);

  bool statics_, relaxes_;  ///< relaxes_: statics without the past of branches, and without viscosity
  TissueOperator tissue_;
  Moment now_;
  BalanceSolver solver_;
  std::vector<Vec3d> last_change_;  ///< of the last step: where statics starts from [m]
  double last_h_ = 0.0;
  double largest_;                                             ///< automatic step [s]
  double step_end_ = std::numeric_limits<double>::infinity();  ///< as Simulation::set_step_end [s]
  /// What steps are chosen by.
  struct Pace {
    double step = 0.0;  ///< of an automatic step: what it is where no corner is near [s]
    /// Of slow steps: how wrong the last one was, over what it may be; the largest stress [Pa m^(3/2)] and displacement so far, √Σ|u|² [m].
    double error = 0.0, largest_stress = 0.0, largest_displacement = 0.0;
    double planned = 0.0;  ///< length of the last slow step, an instant left out [s]
  };
  Pace pace_;
  bool fresh_ = true;  ///< what is held, or the body, or the state has changed from outside
  std::string message_;
};

/// Equilibrium: time orders motions and loads.
class StaticScheme final : public ImplicitScheme {
 public:
  static constexpr IntegratorInfo kInfo{Integrator::quasi_static, ImplicitScheme::kInfo.can};

  StaticScheme(Body body, const SimulationOptions& options) : ImplicitScheme(std::move(body), options, true) {}

  /// Takes a displacement as the state, in which branches have relaxed. @return how far it is from equilibrium now
  Imbalance imbalance_at(std::span<const Vec3d> u);
  /// Takes the definite tangent there, with a factor where the body is not too large for one.
  void linearise();
  /// As BalanceSolver::is_stable_here; linearise() comes next, if anything does.
  bool is_stable();
  /// The displacement that forces give by that tangent [m]. @return whether it is finite
  bool respond(std::span<const Vec3d> forces, std::vector<Vec3d>& displacement);
  /// Per component (3 i + axis), after imbalance_at(): not 0 where it is held.
  const std::vector<char>& held_components() { return solver().held(); }
  /// Why supports leave a rigid motion free, and what to do; empty where they do not.
  std::string free_motion() const;
};

}  // namespace glisson
