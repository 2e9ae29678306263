// explicit_scheme.h — a body in motion under the paper's explicit scheme.
//
// In displacement and velocity, with v₋ = (u(t) − u(t−h))/h and v₊ = (u(t+h) − u(t))/h, the paper's
//   u(t+h) = [ h² F + (2m + γh) u(t) − m u(t−h) ] / (m + γh)            [Schwartz2002, eq. 4]
// becomes
//   v₊ = (m v₋ + h F) / (m + γ h),   u(t+h) = u(t) + h v₊.
// The viscous force is taken at v₋: it lags by half a step, which the stable step accounts for; or in stages from v₋ on, which allow
// longer steps (element/drag_stages.h).
//
//   h below h* of the stiffness last seen ─▶ the body advances its free vertices ─▶ here the active ones:
//   add forces ─▶ kick v₋ → v₊ ─▶ impose motions ─▶ interactions constrain v₊ ─▶ book work ─▶ drift u
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dynamics/pace/pace.h"
#include "dynamics/schemes/scheme.h"
#include "dynamics/schemes/viscous_drag.h"
#include "dynamics/state/active_kick.h"
#include "dynamics/state/interactions.h"
#include "engine/moving_body.h"

namespace glisson {

class ExplicitScheme : public Scheme {
 public:
  static constexpr IntegratorInfo kInfo{Integrator::central_difference,
                                        {.supports_interactions = true,
                                         .viscosity_limits_step = true,
                                         .supports_drag_stages = true,
                                         .supports_variable_mass = true,
                                         .supports_adaptive_precision = true}};

  /// @throws std::invalid_argument as Simulation's constructor
  ExplicitScheme(Body body, const SimulationOptions& options)
      : ExplicitScheme(std::move(body), options, options.drag_stages > 1 ? Drag::in_stages : Drag::lags) {}

  StepResult step() override;
  double step_size() const override { return pace_->step(); }
  double stable_step() const override { return pace_->stable_step(); }
  double force_time() const override { return kick_.time(); }
  std::span<const Vec3d> displacement() const override { return read_state().displacement; }
  std::span<const Vec3d> velocity() const override { return read_state().velocity; }
  double linear_share() const override { return moving_->linear_share(); }
  BranchMemory branch_memory(std::size_t block) const override { return moving_->branch_memory(block); }
  /// What the constraint exerted on the tissue at the last kick.
  ForceParts force(ConstraintId constraint) const override;
  Vec3d torque(ConstraintId constraint, const Vec3d& about) const override;
  void attach(std::shared_ptr<Interaction> interaction, const BodyView& body) override;
  std::span<const std::shared_ptr<Interaction>> interactions() const override { return interactions_.all(); }
  void tell_change(const BodyView& body, std::span<const std::uint32_t> origins) override;
  void interactions_changed() override;
  Vec3d displacement_of(std::uint32_t vertex) const override { return moving_->displacement_of(vertex); }
  Vec3d velocity_of(std::uint32_t vertex) const override { return moving_->velocity_of(vertex); }
  void archive_motion(Archive& ar) override;
  std::shared_ptr<const void> save_layout() override;

 protected:
  ExplicitScheme(Body body, const SimulationOptions& options, Drag drag);

  /// A step is about to be made that kick() may give up.
  virtual void prepare_to_give_up() {}
  /// v₊ of the active vertices: as if they were free, then what motions ask for.
  /// @return false where that is not found; all is as it was when prepare_to_give_up() was called then
  virtual bool kick(double h);
  /// Why kick() gave a step of h up, and what to do.
  virtual std::string why_given_up(double /*h*/) const { return {}; }
  /// Lets interactions correct v₊, and keeps what they exerted.
  virtual void constrain_interactions();
  /// Adds to the work of a kick what interactions took of the tools'.
  virtual void add_interface(KickWork& work) const;
  virtual double tool_energy() const { return interactions_.tool_energy(); }
  /// The step has been made.
  virtual void tell_moved();
  /// Where several steps are equally good: the one to take. @param h  the longest that is stable
  virtual double choose_step(double h) const { return h; }
  /// ω² of interactions, as Interaction::squared_frequency.
  virtual double added_frequency() const { return interactions_.squared_frequency(); }

  void acts_on(std::span<const std::uint32_t> vertices) override;
  void take_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) override;
  void take_over(const BodyChange& change) override;
  void follow(std::span<const std::uint32_t> origins, std::uint32_t first_new) override;
  void loads_changed(bool may_refuse) override;
  void take_body(Archive& ar) override;
  void load_layout(const std::shared_ptr<const void>& layout) override;
  std::vector<Sym3<double>> branch_stresses(std::size_t block) override { return moving_->branch_stresses(block); }
  std::string past() override;
  void require_tissues(const BlockTissues& tissues) const override;
  void take_tissues(const TissueChange& change) override;
  void take_back_tissues(const TissueChange& change) override { follow_tissues(change); }
  void watch(std::span<const std::uint32_t> vertices);
  void act_on_only(std::span<const std::uint32_t> vertices);
  void active_changed(std::span<const std::uint32_t> before);
  void let_go();
  void bring_to_rest();
  void begin_interactions(double h);
  /// Interactions are others now.
  void follow_interactions() { pace_->set_added(added()); }

  std::unique_ptr<MovingBody> moving_;
  ActiveKick kick_{state_};
  Interactions interactions_;

 private:
  /// The state in the mesh's order, copied from the body when someone asks.
  struct StateCopy {
    std::vector<Vec3d> displacement, velocity;
  };

  const StateCopy& read_state() const;
  void follow_tissues(const TissueChange& change);
  void build_anew(const TissueChange& change);
  void take_stiffness(const Advance& seen);
  std::vector<std::uint32_t> active_vertices() const;
  AddedBeside added();
  void book(double h, const Advance& seen);

  std::vector<std::uint32_t> held_;  ///< vertices of supports, motions and loads, ascending
  std::vector<double> stiffening_;   ///< per tissue block, at the last evaluation
  std::vector<StiffElement> stiff_;  ///< what was listed then
  std::vector<VertexStiffness> to_bear_;
  std::unique_ptr<ViscousDrag> drag_;
  std::unique_ptr<Pace> pace_;
  // Filled when it is asked for first, by whichever thread does.
  mutable StateCopy copy_;
  mutable std::atomic<bool> copy_is_current_{false};
  mutable std::mutex filling_;
  std::string message_;  ///< why the last step was not made
};

}  // namespace glisson
