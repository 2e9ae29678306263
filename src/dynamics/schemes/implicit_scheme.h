// implicit_scheme.h — a body in motion, or in equilibrium, by Newton's method: the integrators `implicit` and `static_`.
//
//   M a_α + γ v_α + f(u_α, v_α) = external(t_α)       on the free components, u⁺ unknown (time_steps.h)
//
//   step ─▶ hold what takes hold ─▶ ┌ start: u + h v or u, motions lifted through the tangent ┐ ─▶ book ─▶ next part
//                 ▲                 │ Newton: tangent ─▶ Krylov ─▶ line search … until balance  │
//                 └── cut in two ◀──┴ no balance: nothing has changed                           ┘
//
// Statics is the same with α_f = 0 and no M, γ and viscosity, with the tissue's long-time stress.
#pragma once

#include <string>
#include <vector>

#include "dynamics/schemes/scheme.h"
#include "dynamics/solvers/tangent_system.h"
#include "dynamics/step/time_steps.h"

namespace glisson {

class ImplicitScheme final : public Scheme {
 public:
  /// @throws std::invalid_argument as Simulation's constructor
  ImplicitScheme(Body body, const SimulationOptions& options);

  StepResult step() override;
  double step_size() const override { return step_; }
  double stable_step() const override;
  double force_time() const override { return time_; }
  std::span<const Vec3d> displacement() const override { return now_.u; }
  std::span<const Vec3d> velocity() const override { return now_.v; }
  ForceParts force(ConstraintId constraint) const override;
  const Energies& energies() const override { return energies_; }
  BranchMemory branch_memory(std::size_t block) const override { return tissue_.branch_memory(block, 0.0); }
  void save(CheckpointWriter& out) const override;
  void load(CheckpointReader& in) override;

 protected:
  Vec3d displacement_of(std::uint32_t vertex) const override { return now_.u[vertex]; }
  Vec3d velocity_of(std::uint32_t vertex) const override { return now_.v[vertex]; }
  void acts_on(std::span<const std::uint32_t>) override { fresh_ = true; }
  void take_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) override;
  void take_over(const BodyChange& change) override;
  void follow(std::span<const std::uint32_t>, std::uint32_t) override { fresh_ = true; }
  void take_out(double kinetic, double elastic) override;
  std::vector<Sym3<double>> branch_stresses(std::size_t block) override {
    return tissue_.branch_stresses(block, now_.u);
  }
  void take_tissues(const TissueChange& change) override;
  void take_back_tissues(const TissueChange& change) override { take_tissues(change); }
  void bring_in(double kinetic, double elastic) override {
    energies_.changed += kinetic + elastic;
    energies_.kinetic += kinetic, energies_.elastic += elastic;
  }

 private:
  /// Motion and forces at one time.
  struct Moment {
    std::vector<Vec3d> u, v, a;
    std::vector<Vec3d> elastic, viscous;  ///< [N]
    std::vector<Vec3d> external;          ///< loads, without gravity [N]
    Vec3d gravity{};
  };
  /// What step() goes back to where a part of it fails.
  struct Backup {
    Moment now;
    TissueMemory memory;
    Energies energies;
    std::vector<Vec3d> last_change;
    double time, last_h;
  };
  /// How far from balance a trial is.
  struct Balance {
    double residual = 0.0;  ///< norm of the forces out of balance on the free components [N]
    double scale = 0.0;     ///< norm of the largest kind of force [N]
    double rounding = 0.0;  ///< what rounding leaves of the residual [N]
    bool met(double tolerance) const { return residual <= tolerance * scale + rounding; }
  };

  bool is_static() const { return options_.integrator == Integrator::static_; }
  void find_free();
  void make_room();
  void start_fresh();
  bool part(double h);
  void prescribe(const TimeStep& s);
  Balance evaluate(const TimeStep& s);
  void try_at(const TimeStep& s);
  bool start(const TimeStep& s);
  bool newton(const TimeStep& s);
  void linearise(const TimeStep& s, bool semidefinite);
  bool search_line(const TimeStep& s, const Eigen::VectorXd& direction, Balance& balance);
  void finish(const TimeStep& s);
  void book(const Moment& before);
  void adapt(double h, double smallest);
  ForceParts vertex_force(std::uint32_t vertex, const Axes& axes) const;
  StepResult failed(double smallest);

  TissueOperator tissue_;
  TangentSystem system_;
  Moment now_, next_;
  ElementWatch watch_;
  std::vector<char> held_;            ///< per component: held by a constraint, or of a vertex in no tet
  std::vector<Vec3d> change_;         ///< u⁺ − u of held components [m]
  std::vector<Vec3d> held_velocity_;  ///< of held components at t + h [m/s]
  std::vector<Vec3d> at_u_, at_v_;    ///< state that forces are asked at
  std::vector<Vec3d> out_of_balance_;
  std::vector<Vec3d> last_change_;  ///< of the last step: where statics starts from [m]
  std::vector<double> diagonal_;
  double last_h_ = 0.0;
  double unit_force_ = 0.0;  ///< norm of the forces at a strain of 1 [N]
  double step_, largest_;
  bool fresh_ = true;   ///< what is held, or the body, or the state has changed from outside
  int iterations_ = 0;  ///< of Newton's method in the last part
  std::string message_;
  Energies energies_;
};

}  // namespace glisson
