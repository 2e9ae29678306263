// explicit_scheme.h — a body in motion under the paper's explicit scheme.
//
// In displacement and velocity, with v₋ = (u(t) − u(t−h))/h and v₊ = (u(t+h) − u(t))/h, the paper's
//   u(t+h) = [ h² F + (2m + γh) u(t) − m u(t−h) ] / (m + γh)            [Schwartz2002, eq. 4]
// becomes
//   v₊ = (m v₋ + h F) / (m + γ h),   u(t+h) = u(t) + h v₊.
// The viscous force is taken at v₋: it lags by half a step, which the stable step accounts for.
//
//   h below h* of the stiffness last seen ─▶ the body advances its free vertices ─▶ here the watched ones:
//   kick v₋ → v₊ ─▶ impose motions ─▶ book work ─▶ drift u
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "dynamics/constraints.h"
#include "dynamics/energy_ledger.h"
#include "dynamics/loads.h"
#include "dynamics/step_control.h"
#include "engine/moving_body.h"
#include "glisson/simulation.h"

namespace glisson {

class ExplicitScheme {
 public:
  /// @throws std::invalid_argument as Simulation's constructor
  ExplicitScheme(Body body, const SimulationOptions& options);
  ExplicitScheme(const ExplicitScheme&) = delete;
  ExplicitScheme& operator=(const ExplicitScheme&) = delete;

  ConstraintId add_constraint(Constraint constraint);
  void add_load(std::span<const std::uint32_t> vertices, Vec3d force, std::function<double(double)> scale);
  void set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity);

  RemovalReport remove(std::span<const std::uint32_t> tets);
  SplitReport split(std::span<const Triangle> faces);
  /// Elements that got other vertices by the last split.
  std::span<const std::uint32_t> last_changed() const { return last_changed_; }
  bool is_removed(std::uint32_t tet) const { return changer_ != nullptr && changer_->is_removed(tet); }

  StepResult step();

  const Body& body() const { return body_; }
  const StepControl& control() const { return *control_; }
  const EngineInfo& info() const { return info_; }
  double time() const { return time_; }
  std::uint64_t steps() const { return steps_; }
  std::span<const Vec3d> displacement() const { return read_state().displacement; }
  std::span<const Vec3d> velocity() const { return read_state().velocity; }
  const Energies& energies() const { return ledger_.now(); }
  /// What the constraint exerted on the tissue at the last kick.
  ForceParts force(ConstraintId constraint) const;

 private:
  /// The state in the mesh's order, copied from the body when someone asks.
  struct StateCopy {
    std::vector<Vec3d> displacement, velocity;
    bool current = false;
  };

  /// What a watched vertex had at the last kick; all 0 for one that was not watched then.
  struct Kicked {
    double mass = 0.0, damping = 0.0;
    Vec3d velocity_before, load;
  };

  BodyChanger& changer();
  void weigh_energy(std::span<const std::uint32_t> elements, RemovalReport& report);
  void take_over(const BodyChange& change);
  const StateCopy& read_state() const;
  Vec3d gravity_at(double time) const;
  void watch(std::span<const std::uint32_t> vertices);
  void find_places();
  void kick_watched(double h);
  void impose_motions(double h);
  ForceParts watched_force(std::size_t place, const Axes& axes) const;
  KickWork watched_work() const;
  void book(double h, const KickWork& free);
  void take_hold(double h);
  bool holds(std::size_t constraint) const { return !base_[constraint].empty(); }
  void rebase(std::size_t constraint);

  SimulationOptions options_;
  Body body_;
  std::vector<double> gamma_;                ///< nodal damping [kg/s]
  std::unique_ptr<BodyChanger> changer_;     ///< none until something changes
  std::vector<std::uint32_t> last_changed_;  ///< elements
  EngineInfo info_;                          // before moving_, which fills it
  std::unique_ptr<MovingBody> moving_;
  Constraints constraints_;
  std::vector<std::vector<Vec3d>> base_;  ///< per constraint: displacement its motion counts from [m]; empty: not yet
  Loads loads_;
  std::vector<double> stiffening_;  ///< per tissue block, at the last evaluation
  std::unique_ptr<StepControl> control_;

  double time_ = 0.0;
  std::uint64_t steps_ = 0;
  mutable StateCopy copy_;

  // at the last kick
  double kick_step_ = 0.0;
  std::vector<Kicked> kicked_;                      ///< per watched vertex
  std::vector<std::vector<std::uint32_t>> places_;  ///< per constraint: where its vertices are among those watched
  Vec3d gravity_{};
  EnergyLedger ledger_;
};

}  // namespace glisson
