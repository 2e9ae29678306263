// scheme.h — an integrator: how a body state goes on by a step, and how it follows what changes from outside.
//
//   Simulation ─┬─▶ Scheme ─┬─ ExplicitScheme ── SemiImplicitScheme     its motion lies in an engine/moving_body.h
//               │     ▲     └─ ImplicitScheme ── StaticScheme           its motion lies here, in double
//               └─▶ Changer (changer.h): what is removed, split, exchanged
//
// A scheme is made of parts: the body state (body_state.h), a ledger of energies (energy_ledger.h), and, where its steps are
// not stable at any length, a pace (pace/pace.h). A new one is a file with its class, whose kInfo says what it
// can do, and a line in make_scheme.cpp.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dynamics/state/body_state.h"
#include "dynamics/state/energy_ledger.h"
#include "element/branch_memory.h"
#include "glisson/simulation/interaction.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

/// A tissue for each of some blocks.
using BlockTissues = std::vector<std::pair<std::size_t, Tissue>>;

/// What a scheme is told when the tissues of its body have changed.
struct TissueChange {
  std::vector<std::size_t> blocks;
  /// Per changed block: stress of each element and branch of its new tissue [Pa].
  std::vector<std::vector<Sym3<double>>> branch_stresses;
  std::string past;  ///< where a change is taken back: Scheme::past before it
};

/// What a scheme says of itself.
struct IntegratorInfo {
  Integrator integrator{};
  Capabilities can{};
};

class Scheme {
 public:
  /// @throws std::invalid_argument as Simulation's constructor
  Scheme(Body body, const SimulationOptions& options) : state_(std::move(body), options) {}
  virtual ~Scheme() = default;
  Scheme(const Scheme&) = delete;
  Scheme& operator=(const Scheme&) = delete;

  Capabilities capabilities() const { return glisson::capabilities(state_.options.integrator); }
  const Body& body() const { return state_.body; }
  const BodyState& state() const { return state_; }
  const Energies& energies() const { return ledger_.now(); }
  const EngineInfo& info() const { return info_; }
  const detail::VertexStars& stars() { return state_.changer().stars(); }

  ConstraintId add_constraint(Constraint constraint);
  /// As Simulation::add_surface_load.
  void add_load(std::span<const std::uint32_t> vertices, const SurfaceLoad& load, TimeFunction<double> scale);
  void set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity);
  /// As Simulation::attach. @throws std::invalid_argument, here for every scheme that cannot
  virtual void attach(std::shared_ptr<Interaction> interaction, const BodyView& body);
  virtual std::span<const std::shared_ptr<Interaction>> interactions() const { return {}; }
  /// Hands a change of the mesh on to the interactions, after everything else has followed it.
  virtual void tell_change(const BodyView&, std::span<const std::uint32_t> /*origins*/) {}
  /// An interaction has changed its law between two steps. @throws std::invalid_argument where a given step does not bear its stiffness
  virtual void interactions_changed() {}

  /// As Simulation::step.
  virtual StepResult step() = 0;
  virtual double step_size() const = 0;
  /// As Simulation::next_corner and set_step_end.
  double next_corner(double after) const;
  virtual void set_step_end(double /*time*/) {}
  /// As Simulation::set_interrupt.
  virtual void set_interrupt(std::function<bool(const StepProgress&)> /*asks*/) {}
  virtual double stable_step() const = 0;
  virtual double force_time() const = 0;
  virtual std::span<const Vec3d> displacement() const = 0;
  virtual std::span<const Vec3d> velocity() const = 0;
  virtual Vec3d displacement_of(std::uint32_t vertex) const = 0;
  virtual Vec3d velocity_of(std::uint32_t vertex) const = 0;
  virtual ForceParts force(ConstraintId constraint) const = 0;
  virtual Vec3d torque(ConstraintId constraint, const Vec3d& about) const = 0;
  /// Share of the tets that go by a linear law in the place of their own [-].
  virtual double linear_share() const { return 0.0; }
  /// What the Maxwell branches of a block hold at the present state.
  virtual BranchMemory branch_memory(std::size_t block) const = 0;

  /// The body state. What was read is followed by whoever mirrors the body, tell_change among it; archive_motion comes next.
  /// @throws std::runtime_error with all as it was
  void archive_body(Archive& ar);
  /// How the body moves and what else a step depends on, interactions included. @throws std::runtime_error where it does not fit
  virtual void archive_motion(Archive& ar) = 0;

  /// How the body lies in memory; shared by the states of one version of it.
  virtual std::shared_ptr<const void> save_layout() { return {}; }
  /// Goes to another version of the body; what mirrors it follows, and archive_motion comes next.
  void load_version(const BodyVersion& version, const std::shared_ptr<const void>& layout) {
    state_.go_to(version);
    load_layout(layout);
  }
  /// Of a long step, shared; load_factor comes after archive_motion. None: there is none.
  virtual std::shared_ptr<const void> save_factor() const { return {}; }
  virtual void load_factor(const std::shared_ptr<const void>&) {}
  /// Writes or reads time and what holds, for a copy in memory.
  void archive_clock(Archive& ar) { state_.archive(ar); }
  std::size_t load_count() const { return state_.loads.count(); }

 protected:
  friend class Changer;

  /// Loads are others now. @throws std::invalid_argument where the step does not bear the stiffness of the last one
  virtual void loads_changed(bool /*may_refuse*/) {}
  /// Vertices that a constraint or load acts on from now on; the constraint is known already.
  virtual void acts_on(std::span<const std::uint32_t> vertices) = 0;
  /// Takes a state as the present one; bases follow after it.
  virtual void take_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) = 0;
  /// Follows a change of the body; masses and damping are those after it.
  virtual void take_over(const BodyChange& change) = 0;
  /// The last vertices, numbered from `first_new`, act and are acted on as those they are copies of.
  virtual void follow(std::span<const std::uint32_t> origins, std::uint32_t first_new) = 0;
  /// Follows another version of the body.
  virtual void load_layout(const std::shared_ptr<const void>& layout) = 0;
  /// Follows a body that has been read, by what the archive has of its place in memory. @throws std::runtime_error as before
  virtual void take_body(Archive& ar) = 0;

  /// @throws std::invalid_argument for tissues that are not valid, or that the scheme does not support
  virtual void require_tissues(const BlockTissues& tissues) const;
  /// Stress of each element and Maxwell branch of a block at present [Pa]; asked before a change of its tissue.
  virtual std::vector<Sym3<double>> branch_stresses(std::size_t block) = 0;
  /// What the body knows of its past, for take_back_tissues.
  virtual std::string past() { return {}; }
  /// Follows a change of the body's tissues and masses. @throws std::invalid_argument where the step does not support it
  virtual void take_tissues(const TissueChange& change) = 0;
  /// Follows one that take_tissues refused, which is taken back.
  virtual void take_back_tissues(const TissueChange& change) = 0;

  /// Why a step from `time` is not made where a force is not finite, and what to do.
  static std::string not_finite_at(double time);
  /// @throws std::invalid_argument saying why an interaction does not act in steps whose vertices move one another (step_contact.h)
  void require_long_steps(const Interaction& interaction) const;
  /// Attaches it for such steps.
  void attach_for_long_steps(Interaction& interaction, const BodyView& body);
  /// @throws std::invalid_argument saying which integrators support interactions
  [[noreturn]] static void refuse_interactions();
  /// Lets those constraints take hold whose time has come by the middle of a step of h.
  /// @return whether one did
  bool take_hold(double h);
  void rebase(std::size_t constraint);

  BodyState state_;
  EnergyLedger ledger_;
  EngineInfo info_;
};

}  // namespace glisson
