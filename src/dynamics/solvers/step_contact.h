// step_contact.h — interactions within a step whose vertices move one another: their forces at its end, by a factor of the step.
//
//   Newton's u⁺ with the forces so far ─▶ for each interaction: its own taken off by P⁻¹, found anew with all points moving one
//                                         another by P⁻¹, until no force of several interactions changes
//                                      ─▶ u⁺ with the forces they find
//
// W = J P⁻¹ Jᵀ of contact is never formed: its columns P⁻¹ e are solved for where something is pushed for the first time,
// and kept as long as the factor P; those of means of vertices, P⁻¹ w, likewise. In a long step P is the tangent or near it; where it is
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

#include "dynamics/solvers/step_factor.h"
#include "dynamics/solvers/step_interrupt.h"
#include "dynamics/state/body_state.h"
#include "dynamics/state/interactions.h"

namespace glisson {

/// Forces of interactions on the vertices of the body, at the end of a step [N].
struct ExertedForces {
  std::vector<Vec3d> total;             ///< per vertex
  std::vector<std::vector<Vec3d>> own;  ///< of each interaction

  void set_zero(std::size_t vertices);
  /// Goes a share of the way to others.
  ExertedForces towards(const ExertedForces& others, double share) const;
  void archive(Archive& ar);
};

class StepContact final : public StepCompliance {
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
    ExertedForces forces;
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
  /// @return false where there is no factor, or where the forces were not found within the work allowed: give_up() comes next then
  bool correct(std::span<Vec3d> u);
  /// Asked between trials, which end then: correct() returns false. @param interrupt  must outlive this
  void set_interrupt(StepInterrupt& interrupt) { interrupt_ = &interrupt; }
  /// The only correction of a step, which no iteration follows: where a tool that a force moves is not found, there is no answer, and the
  /// work of all interactions together is limited. @param sweeps  over all places that are pushed
  void set_last(double sweeps) { is_last_ = true, most_sweeps_ = sweeps; }
  /// Whether the last correct() found forces that all interactions agree on.
  bool agrees() const { return agrees_; }
  /// Whether something has come about within the step, which ends with u, v, that is to be dated.
  bool overshoots(std::span<const Vec3d> u, std::span<const Vec3d> v);
  /// The step has been made, with u, v at its end. @param resting  what interactions hold still stands against these forces
  void made(std::span<const Vec3d> u, std::span<const Vec3d> v, std::span<const RestingVertex> resting);

  /// On the vertices of the body, at the end of the step [N].
  const std::vector<Vec3d>& forces() const { return forces_.total; }
  const ExertedForces& exerted() const { return forces_; }
  void set_forces(ExertedForces forces) { forces_ = std::move(forces); }
  /// By WorkSink: what interactions took of the tools' work in the step [J].
  std::array<double, 3> lost() const;
  /// The same, that the velocities v of the vertices would have taken with those of the tools before or after the step [J].
  std::array<double, 3> lost_at(std::span<const Vec3d> v, double InterfaceBook::Page::*tools) const;

  void spread(std::size_t place, const Vec3d& impulse, std::span<ActiveVertex> vertices) override;
  void settle(std::span<ActiveVertex> vertices) override;
  Vec3d mobility(std::size_t place) override;
  std::vector<Mat3d> couple(std::span<const std::vector<VertexWeight>> means) override;
  void spread_means(std::span<const std::vector<VertexWeight>> means, std::span<const Vec3d> impulses,
                    std::span<ActiveVertex> vertices) override;
  void archive(Archive& ar);

 private:
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 3>;
  /// Of a mean of vertices.
  struct MeanColumn {
    Column moved;
    bool used = true;  ///< in this step
  };
  /// Of all forces of an interaction.
  struct Response {
    std::vector<Vec3d> forces;
    Eigen::VectorXd moved;  ///< P⁻¹ of them [m]
  };
  /// With a factor.
  struct Solved {
    std::map<std::uint32_t, Column> columns;  ///< per vertex: displacement of all components by a unit force [m/N]
    std::map<std::vector<std::pair<std::uint32_t, double>>, MeanColumn> means;  ///< the same by one on a mean
    std::vector<Response> responses;                                            ///< per interaction, as last asked for
  };
  Solved& solved();
  const Column& column(std::uint32_t vertex);
  const Column& column_at(std::size_t place);
  void find_columns(std::span<const std::vector<VertexWeight>> means);
  const Column& column_of(const std::vector<VertexWeight>& mean);
  void move(std::size_t by, const Vec3d& impulse, std::size_t place, ActiveVertex& vertex) const;
  void activate(std::span<const std::uint32_t> vertices);
  void put_at_start(std::span<const Vec3d> u);
  void put_at_end(std::span<const Vec3d> u, std::span<const Vec3d> v);
  template <class Velocity>
  std::array<double, 3> lost_by(double InterfaceBook::Page::*tools, const Velocity& velocity) const;
  double find_forces();
  double find_forces_of(std::size_t interaction);
  bool count_work(bool tries_again, int trial);
  void take_off(std::size_t interaction);
  void move_by_change(std::span<Vec3d> u, const ExertedForces& known, std::span<Eigen::VectorXd> moved);
  const Eigen::VectorXd& response(std::size_t interaction, const std::vector<Vec3d>& forces);

  const BodyState& state_;
  StepFactor& system_;
  Interactions interactions_;
  std::vector<ActiveVertex> active_;
  ExertedForces forces_;
  std::vector<Vec3d> start_;  ///< u(t) [m]
  std::vector<TriangleStiffness> stiffness_;
  std::vector<TetStiffness> tet_stiffness_;
  Backup before_, reached_;  ///< before reach(), and after it
  double h_ = 0.0, factor_h_ = 0.0;
  bool agrees_ = true;
  std::uint64_t factor_ = 0;  ///< that at_places_ is of
  std::set<std::uint32_t> asked_,
      asked_before_;  ///< vertices whose columns were wanted with this factor in this step, and before that
  std::vector<char> pushes_means_;         ///< per interaction
  std::vector<std::size_t> order_;         ///< in which they have their turns: by their names
  std::size_t acting_ = 0;                 ///< whose turn it is
  std::vector<Column> at_places_;          ///< columns per place, of active vertices; empty: not asked for yet
  std::vector<std::uint32_t> near_, far_;  ///< places that have columns, and the others
  std::vector<Vec3d> unsettled_;           ///< per place: impulses that the others have not got yet [N s]
  StepInterrupt* interrupt_ = nullptr;
  double most_sweeps_ = std::numeric_limits<double>::infinity();
  double pushes_ = 0.0;     ///< in this correction
  bool is_last_ = false;    ///< as set_last()
  bool exhausted_ = false;  ///< this correction has done the work that is allowed
};

}  // namespace glisson
