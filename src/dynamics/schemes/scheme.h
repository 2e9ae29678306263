// scheme.h — what every way of advancing a body in time has: the body, what acts on it, and how it changes.
//
//   Simulation ─▶ Scheme ─┬─ ExplicitScheme ── SemiImplicitScheme     the state lies in an engine/moving_body.h
//                         └─ ImplicitScheme                           the state lies here, in double
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dynamics/state/checkpoint.h"
#include "dynamics/state/constraints.h"
#include "dynamics/state/loads.h"
#include "dynamics/state/tissue_change.h"
#include "element/body_change.h"
#include "element/branch_memory.h"
#include "glisson/simulation/interaction.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

class Scheme {
 public:
  Scheme(Body body, const SimulationOptions& options);
  virtual ~Scheme() = default;
  Scheme(const Scheme&) = delete;
  Scheme& operator=(const Scheme&) = delete;

  ConstraintId add_constraint(Constraint constraint);
  void add_load(std::span<const std::uint32_t> vertices, Vec3d force, std::function<double(double)> scale);
  void set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity);

  RemovalReport remove(std::span<const std::uint32_t> tets);
  SplitReport split(std::span<const Triangle> faces, std::span<const VertexMove> moves = {});
  /// Gives blocks of the body other tissues, between two steps.
  /// @return whether masses have changed
  /// @throws std::invalid_argument for what the scheme or its step does not bear; nothing has changed then
  bool set_tissues(const BlockTissues& tissues);
  /// Elements that got other vertices by the last split.
  std::span<const std::uint32_t> last_changed() const { return last_changed_; }
  /// Vertices that came last are copies of these; of all splits so far.
  std::span<const std::uint32_t> copies() const { return copies_; }
  const detail::VertexStars& stars() { return changer().stars(); }
  const Constraints& constraints() const { return constraints_; }
  bool is_removed(std::uint32_t tet) const { return changer_ != nullptr && changer_->is_removed(tet); }

  /// As Simulation::step.
  virtual StepResult step() = 0;
  virtual double step_size() const = 0;
  virtual double stable_step() const = 0;
  virtual double force_time() const = 0;
  virtual std::span<const Vec3d> displacement() const = 0;
  virtual std::span<const Vec3d> velocity() const = 0;
  virtual ForceParts force(ConstraintId constraint) const = 0;
  /// As Simulation::attach. @throws std::invalid_argument, here for every scheme that cannot
  virtual void attach(std::shared_ptr<Interaction> interaction, const BodyView& body);
  virtual bool has_interactions() const { return false; }
  /// Hands a change of the mesh on to the interactions, after everything else has followed it.
  virtual void tell_change(const BodyView&, std::span<const std::uint32_t> /*origins*/) {}
  virtual const Energies& energies() const = 0;
  /// What the Maxwell branches of a block hold at the present state.
  virtual BranchMemory branch_memory(std::size_t block) const = 0;

  /// Everything that a continued run needs beside what it is made of.
  virtual void save(CheckpointWriter& out) const;
  /// @throws std::runtime_error where it does not fit
  virtual void load(CheckpointReader& in);

  const Body& body() const { return body_; }
  const MassScaling& mass_scaling() const { return mass_scaling_; }
  const EngineInfo& info() const { return info_; }
  double time() const { return time_; }
  std::uint64_t steps() const { return steps_; }

 protected:
  virtual Vec3d displacement_of(std::uint32_t vertex) const = 0;
  virtual Vec3d velocity_of(std::uint32_t vertex) const = 0;
  /// Vertices that a constraint or load acts on from now on; the constraint is known already.
  virtual void acts_on(std::span<const std::uint32_t> vertices) = 0;
  /// Takes a state as the present one; bases follow after it.
  virtual void take_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) = 0;
  /// Follows a change of the body; masses and damping are those after it.
  virtual void take_over(const BodyChange& change) = 0;
  /// The last vertices, numbered from `first_new`, act and are acted on as those they are copies of.
  virtual void follow(std::span<const std::uint32_t> origins, std::uint32_t first_new) = 0;
  /// Energy that leaves with removed tets [J].
  virtual void take_out(double kinetic, double elastic) = 0;

  /// @throws std::invalid_argument for tissues that are not valid, or that the scheme does not bear
  virtual void require_tissues(const BlockTissues& tissues) const;
  /// Stress of each element and Maxwell branch of a block at present [Pa]; asked before a change of its tissue.
  virtual std::vector<Sym3<double>> branch_stresses(std::size_t block) = 0;
  /// What the body knows of its past.
  virtual std::vector<double> past() const { return {}; }
  /// Follows a change of the body's tissues and masses. @throws std::invalid_argument where the step does not bear it
  virtual void take_tissues(const TissueChange& change) = 0;
  /// Follows one that take_tissues refused, which is taken back.
  virtual void take_back_tissues(const TissueChange& change) = 0;
  /// How far the account of energies stands behind the state [s].
  virtual double booked_behind() const { return 0.0; }
  /// Energy that comes in with changed tissues [J].
  virtual void bring_in(double kinetic, double elastic) = 0;

  /// Why a step from `time` is not made where a force is not finite, and what to do.
  static std::string not_finite_at(double time);
  /// @throws std::invalid_argument saying which integrators bear interactions
  [[noreturn]] static void refuse_interactions();
  BodyChanger& changer();
  Vec3d gravity_at(double time) const;
  /// Lets those constraints take hold whose time has come by the middle of a step of h.
  /// @return whether one did
  bool take_hold(double h);
  bool holds(std::size_t constraint) const { return !base_[constraint].empty(); }
  void rebase(std::size_t constraint);

  SimulationOptions options_;
  Body body_;
  MassScaling mass_scaling_;
  std::vector<double> gamma_;  ///< nodal damping [kg/s]
  EngineInfo info_;
  Constraints constraints_;
  std::vector<std::vector<Vec3d>> base_;  ///< per constraint: displacement its motion counts from [m]; empty: not yet
  Loads loads_;
  std::unique_ptr<BodyChanger> changer_;     ///< none until something changes
  std::vector<std::uint32_t> last_changed_;  ///< elements
  std::vector<std::uint32_t> copies_;
  double time_ = 0.0;
  std::uint64_t steps_ = 0;

 private:
  void put_tissues(const BlockTissues& to);
  void masses_changed();
  std::array<double, 2> energy_of_blocks(std::span<const std::size_t> blocks) const;
  std::uint64_t fingerprint() const;
  void weigh_energy(std::span<const std::uint32_t> elements, RemovalReport& report);
  void change(const BodyChange& change);
  std::array<double, 2> energy_of(std::span<const std::uint32_t> elements) const;
  void move_bases(std::span<const MovedVertex> moved);
};

}  // namespace glisson
