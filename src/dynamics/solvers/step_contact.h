// step_contact.h — interactions within a step whose vertices move one another: their forces at its end, by a factor of the step.
//
//   Newton's u⁺ with the forces so far ─▶ these taken off by P⁻¹ ─▶ the rows of all interactions, solved by columns of P⁻¹
//                                      ─▶ u⁺ with the forces found
//
// Columns P⁻¹ w of means of vertices on which rows act are kept as long as the factor P. In a long step P is the tangent or near it; where it is
// not, Newton's method takes more iterations, and ends at the same state. In a step of `semi_implicit` P is exact, and one correction is all.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "contact/step_mobility.h"
#include "dynamics/solvers/step_factor.h"
#include "dynamics/solvers/step_interrupt.h"
#include "dynamics/state/body_state.h"
#include "dynamics/state/interactions.h"

namespace glisson {

class StepContact final : public StepMobility {
 public:
  /// Both must outlive this.
  StepContact(const BodyState& state, StepFactor& system) : state_(state), system_(system) {}

  bool acts() const { return !interactions_.empty(); }
  /// Whether some act by impulses, and not by forces of the displacements alone.
  bool constrains() const;
  const Interactions& interactions() const { return interactions_; }
  void add(std::shared_ptr<Interaction> interaction);
  /// Body or state have changed from outside: nothing presses as yet.
  void body_changed(const BodyView& body, std::span<const std::uint32_t> origins);
  void follow(std::span<const std::uint32_t> origins, std::uint32_t first_new) {
    interactions_.follow(origins, first_new);
  }
  void state_set(std::span<const Vec3d> displacement);

  /// Where interactions were before a step, to go back to.
  struct Backup {
    Interactions::Saved interactions;
    Interactions::Rests rests;
    std::vector<Vec3d> forces;
  };
  Backup backup();
  void restore(const Backup& backup);

  /// Begins a step of h from u at t. @param mass_matters  the factor depends on h: another one asks for it anew
  /// @return whether interactions hold other vertices still than before: the factor has to follow
  bool begin(double h, std::span<const Vec3d> u, bool mass_matters);
  /// Takes back what begin() and what came after it did.
  void give_up() { restore(before_); }
  /// Adds what follows from the displacements alone to the forces of the tissue [N].
  void add_forces_at(std::span<const Vec3d> u, std::span<Vec3d> forces) const;
  /// The same of what resists velocities, to the viscous forces of the tissue [N].
  void add_viscous_forces_at(std::span<const Vec3d> u, std::span<const Vec3d> v, std::span<Vec3d> forces) const;
  /// What they store there and have released, without what changes of their own have added [J].
  double energy_at(std::span<const Vec3d> u) const;
  /// The stiffness of that where it was asked last.
  std::span<const TriangleStiffness> stiffness();
  /// The same of what is a stress of tets. @param rate  dv/du [1/s]
  std::span<const TetStiffness> tet_stiffness(double rate);
  /// Corrects u⁺ of a Newton iteration that was made with forces(), and finds these anew.
  /// @return false where there is no factor, or where the program stops the step: give_up() comes next then
  bool correct(std::span<Vec3d> u);
  /// Asked between trials, which end then: correct() returns false. @param interrupt  must outlive this
  void set_interrupt(StepInterrupt& interrupt) { interrupt_ = &interrupt; }
  /// A correction is the only one of its step, which no iteration follows. @param sweeps  over the rows, at most: false where they do not do
  void set_last(int sweeps) { is_last_ = true, most_sweeps_ = sweeps; }
  /// Whether the forces of the last correct() meet all rows, with tools that a force moves where it takes them.
  bool agrees() const { return agrees_; }
  /// Forces that have been taken as the last correct() found them, or not.
  void set_taken(bool whole) { taken_ = whole; }
  /// Whether something has come about within the step, which ends with u, v, that is to be dated.
  bool overshoots(std::span<const Vec3d> u, std::span<const Vec3d> v);
  /// The step has been made, with u, v at its end. @param resting  what interactions hold still stands against these forces
  void made(std::span<const Vec3d> u, std::span<const Vec3d> v, std::span<const RestingVertex> resting);

  /// On the vertices of the body, at the end of the step [N].
  const std::vector<Vec3d>& forces() const { return forces_; }
  void set_forces(std::vector<Vec3d> forces) { forces_ = std::move(forces); }
  /// Whether all rows of the step could be met.
  bool is_met() const { return interactions_.is_met(); }
  /// By WorkSink: what interactions took of the tools' work in the step [J].
  std::array<double, 3> lost() const;
  /// The same, that the velocities v of the vertices would have taken with those of the tools before or after the step [J].
  std::array<double, 3> lost_at(std::span<const Vec3d> v, double InterfaceBook::Page::*tools) const;

  std::vector<const Column*> columns(std::span<const Mean> means) override;
  bool stops() override { return interrupt_ != nullptr && interrupt_->wanted(); }
  void set_velocities(std::span<const Vec3d> impulses, std::span<ActiveVertex> vertices) override;
  void archive(Archive& ar);

 private:
  using MeanKey = std::vector<std::pair<std::uint32_t, double>>;
  /// Of a mean of vertices.
  struct MeanColumn {
    Column moved;
    bool used = true;  ///< in this step
  };
  /// With a factor.
  struct Solved {
    std::map<MeanKey, MeanColumn> means;  ///< displacement of all components by a unit force on a mean [m/N]
    std::vector<Vec3d> forces;            ///< those last asked for [N] …
    Eigen::VectorXd moved;                ///< … and P⁻¹ of them [m]
  };
  Solved& solved();
  void activate(std::span<const std::uint32_t> vertices);
  void set_start(std::span<const Vec3d> u, const Eigen::VectorXd& moved);
  void set_end(std::span<const Vec3d> u, std::span<const Vec3d> v);
  template <class Velocity>
  std::array<double, 3> lost_by(double InterfaceBook::Page::*tools, const Velocity& velocity) const;
  const Eigen::VectorXd& response(const std::vector<Vec3d>& forces);
  bool find_forces();

  const BodyState& state_;
  StepFactor& system_;
  Interactions interactions_;
  std::vector<ActiveVertex> active_;
  std::vector<Vec3d> forces_;  ///< on the vertices of the body [N]
  std::vector<Vec3d> start_;   ///< u(t) [m]
  std::vector<TriangleStiffness> stiffness_;
  std::vector<TetStiffness> tet_stiffness_;
  Backup before_, reached_;  ///< before reach(), and after it
  double h_ = 0.0, factor_h_ = 0.0;
  bool agrees_ = true;
  std::vector<Vec3d> free_;        ///< per place: 1 of components that may move, else 0
  std::vector<Vec3d> velocities_;  ///< per place, without any tool [m/s]
  std::set<MeanKey> asked_,
      asked_before_;  ///< means whose columns were wanted with this factor in this step, and before that
  StepInterrupt* interrupt_ = nullptr;
  int most_sweeps_ = 0;   ///< of a correction that is the last; 0: as many as it takes
  bool is_last_ = false;  ///< as set_last()
  bool taken_ = true;     ///< as set_taken()
  int unsettled_ = 0;     ///< corrections of this step whose rows did not settle
};

}  // namespace glisson
