// interaction.h — base of everything that acts on a body besides supports, motions and loads: instruments, needles,
// membranes. Programs may derive their own.
//
//   a step from t to t + h, with v₋ and v₊ the velocities before and after t:
//     reach ─▶ tissue forces at u(t) ─▶ add_forces ─▶ v₊ as if free, then with motions ─▶ declare ─▶ solver ─▶ solved
//     ─▶ u(t+h) ─▶ moved ─▶ the step is made ─▶ between_steps
//
// An interaction names the vertices it may act on, its active vertices; they are held in double. Forces that follow
// from the state alone (membranes, springs) are added to the tissue's own; conditions at the end of the step (no
// penetration, friction, a path through the tissue) are declared as rows (contact/step_rows.h), and one solver finds the
// impulses that meet those of all interactions together (docs/contact.md). Between steps they may change the body: cut it, remove tets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "glisson/contact/step_rows.h"
#include "glisson/math.h"
#include "glisson/mesh.h"
#include "glisson/simulation/active_vertex.h"
#include "glisson/simulation/held_rows.h"

namespace glisson {

class Archive;
class Simulation;

/// Stiffness of a vertex, the same in all directions [N/m].
struct VertexStiffness {
  std::uint32_t vertex = 0;
  double stiffness = 0.0;
};

/// The present body, for interactions.
struct BodyView {
  const TetMesh& mesh;                  ///< at rest, including removed tets, in present numbers
  std::span<const char> removed;        ///< per tet: 1 if removed; empty: none is
  std::span<const double> masses;       ///< lumped, per vertex [kg]
  std::span<const Vec3d> displacement;  ///< per vertex [m]
  bool is_removed(std::size_t tet) const { return !removed.empty() && removed[tet] != 0; }
};

/// Impulses between tools and tissue in a step, by WorkSink: filled by InteractionStep::book.
struct InterfaceBook {
  struct Page {
    std::vector<Vec3d> impulses;                   ///< per place, on the tissue [N s]
    double tools_before = 0.0, tools_after = 0.0;  ///< Σ J·V₋ and Σ J·V₊, V of the tools [J]
  };
  std::array<Page, 3> pages;  ///< by WorkSink

  /// Begins a step with so many active vertices.
  void begin(std::size_t places) {
    for (Page& p : pages) p.impulses.assign(places, Vec3d{}), p.tools_before = p.tools_after = 0.0;
  }
  /// Adds another one of the same step.
  void add(const InterfaceBook& other) {
    for (std::size_t k = 0; k < pages.size(); ++k) {
      for (std::size_t i = 0; i < pages[k].impulses.size(); ++i) pages[k].impulses[i] += other.pages[k].impulses[i];
      pages[k].tools_before += other.pages[k].tools_before, pages[k].tools_after += other.pages[k].tools_after;
    }
  }
};

/// Stiffness between the corners of a triangle of the surface: a displacement of corner b adds −K(a, b) of it to the force on corner a.
struct TriangleStiffness {
  std::array<std::uint32_t, 3> corners{};
  std::array<std::array<Mat3d, 3>, 3> blocks{};  ///< K, symmetric as a whole [N/m]
};

/// Stiffness of a tet: ∂P/∂F of what an interaction adds to its stress P, force per area at rest.
struct TetStiffness {
  std::uint32_t tet = 0;
  std::array<double, 81> slope{};  ///< row 9 (3 i + j) + 3 k + l: of P_ij by F_kl [Pa]
};

/// The active vertices in a step.
class InteractionStep {
 public:
  static constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();

  double time = 0.0;                 ///< t: the step goes from t to t + h [s]
  double h = 0.0;                    ///< [s]
  std::span<ActiveVertex> vertices;  ///< ascending by vertex; `velocity` is v₋ in add_forces, v₊ in declare and solved
  std::span<const std::uint32_t> place_of;  ///< per vertex of the mesh: its place in `vertices`, or kNowhere
  std::span<const Vec3d> rest;              ///< per vertex of the mesh: rest position [m]
  /// Vertices that interactions hold at rest, ascending by vertex; they have no place.
  std::span<const RestingVertex> resting;
  /// Per place: velocity per impulse, 1/(m + γh), in each component; 0 where a support or motion holds it [1/kg]. In long steps, where
  /// impulses move other vertices too, 1 and 0.
  std::span<const Vec3d> mobility;
  std::span<Vec3d> impulses;                ///< per place: sum of the impulses of this step [N s]
  InterfaceBook* interface_book = nullptr;  ///< where book() writes; null where energies are not tracked
  /// One of `implicit`, `quasi_static` or `semi_implicit`, where an impulse moves all vertices and `velocity` is (u(t + h) − u(t))/h.
  bool is_long = false;

  /// Position of the vertex at a place at time t, or at t + h after moved() [m].
  Vec3d position(std::size_t place) const { return rest[vertices[place].vertex] + vertices[place].displacement; }

  /// In a short step: applies an impulse [N s] to the vertex at a place; held components do not move.
  void push(std::size_t place, const Vec3d& impulse) const {
    const Vec3d& a = mobility[place];
    vertices[place].velocity += Vec3d{a.x * impulse.x, a.y * impulse.y, a.z * impulse.z};
    impulses[place] += impulse;
  }

  /// Records the impulse of a tool on the vertex at a place in the energy ledger. The solver calls it for all rows. The work of
  /// the tool is J·(V₋ + V₊)/2, the tissue receives J·(v₋ + v₊)/2 of it, and the difference goes to the sink. An impulse that is
  /// not recorded counts as that of a tool that moves with the tissue. No cost if energies are not tracked.
  void book(WorkSink sink, std::size_t place, const Vec3d& impulse, const ToolVelocity& tool = {}) const {
    if (interface_book == nullptr) return;
    InterfaceBook::Page& page = interface_book->pages[static_cast<std::size_t>(sink)];
    page.impulses[place] += impulse;
    page.tools_before += dot(impulse, tool.before);
    page.tools_after += dot(impulse, tool.after);
  }
};

/// Acts on a body. The Simulation it is attached to calls the members in the order drawn above.
/// None may throw after `attached`.
class Interaction {
 public:
  Interaction() = default;
  virtual ~Interaction() = default;
  /// A copy is not attached.
  Interaction(const Interaction&) {}
  Interaction& operator=(const Interaction&) { return *this; }

  /// Its name in messages.
  virtual std::string label() const { return "this interaction"; }

  /// Called once with the body it acts on. @throws std::invalid_argument if it cannot act on this body
  virtual void attached(const BodyView& body, double time) = 0;
  /// Tets were removed, faces split, vertices moved or masses changed. Vertices and tets keep their numbers; new
  /// vertices come last.
  /// @param origins  the last vertices are copies of these
  virtual void body_changed(const BodyView& body, std::span<const std::uint32_t> origins) = 0;

  /// Vertices it may act on in the step from `time` to `time` + h, in addition to earlier ones, which stay active (see keeps()).
  /// Valid until the next call. Cost: naming none is free; naming some takes a pass over the vertices of the body.
  virtual std::span<const std::uint32_t> reach(double time, double h) = 0;
  /// Called after each reach(): all vertices that it may still act on, if there are fewer now; the others become inactive unless
  /// something else acts on them. None: all earlier vertices stay active. Valid until the next call.
  virtual std::optional<std::span<const std::uint32_t>> keeps() { return {}; }

  /// Called after each reach(): all vertices that it holds at rest in place from this step on, if the list has changed.
  /// Such vertices cost almost nothing: they are not active (reach() need not name them), and the forces on them are in
  /// InteractionStep::resting. A vertex on which something else acts stays active and has to be held by impulses.
  /// Valid until the next call. None: the list has not changed.
  virtual std::optional<std::span<const std::uint32_t>> rests() { return {}; }
  /// The state was set by set_state: vertices that it holds at rest may have moved. @param displacement  of all
  /// vertices [m]
  virtual void state_set(std::span<const Vec3d> /*displacement*/) {}

  /// Adds forces that follow from the present state to `elastic` or `viscous` of active vertices.
  virtual void add_forces(const InteractionStep&) {}
  /// Declares what is to hold at the end of the step. Called with round = 0, and again after each time that all rows have been
  /// solved, as long as some interaction declares more: what has come to be in reach by the impulses so far. Velocities in round 0
  /// are v₊ without any tool.
  virtual void declare(const InteractionStep&, StepRows&, int /*round*/) {}
  /// All rows have been solved: their impulses are in the velocities.
  virtual void solved(const InteractionStep&, const StepRows&) {}
  /// The largest SimulationOptions::drag_stages allowed with it: kMostDragStagesBesideOthers, unless overridden. The stages hold what
  /// its rows held in the last step, those of discs and given impulses apart.
  virtual int most_drag_stages() const;
  /// The step has been made: displacements are those at t + h.
  virtual void moved(const InteractionStep&) {}

  /// Called when it has been attached, and after every step that was made: the only member that may change the body, by
  /// remove_tets, split_faces or set_tissues. body_changed() reports what it changes to all interactions, this one too.
  virtual void between_steps(Simulation&) {}
  /// Whether it takes part in steps. Otherwise between_steps is called just once, when it is attached, to set up supports,
  /// motions and loads; then every integrator supports it, and it has no state for a checkpoint.
  virtual bool acts_in_steps() const { return true; }
  /// In long steps, in place of add_forces: adds its forces as a function of the displacements of all vertices to those of the
  /// tissue [N]. Called at every trial of Newton's method.
  virtual void add_forces_at(std::span<const Vec3d> /*displacement*/, std::span<Vec3d> /*force*/) {}
  /// The same for its forces that resist velocities [m/s], to the viscous ones of the tissue [N]; called right after add_forces_at().
  virtual void add_viscous_forces_at(std::span<const Vec3d> /*displacement*/, std::span<const Vec3d> /*velocity*/,
                                     std::span<Vec3d> /*force*/) {}
  /// Adds the stiffness of these forces at the displacements of the last add_forces_at().
  virtual void add_stiffness(std::vector<TriangleStiffness>&) const {}
  /// The same of forces that are stresses of tets. @param rate  dv/du: velocities follow displacements by it [1/s]
  virtual void add_tet_stiffness(std::vector<TetStiffness>&, double /*rate*/) const {}
  /// Whether it declares rows in long steps; otherwise it acts by add_forces_at() alone.
  virtual bool constrains_long_steps() const { return true; }
  /// In a long step, before moved(), with displacements and velocities at its end: whether an event such as a tear or a puncture
  /// happened within it, whose time is to be found. The step is then undone and repeated in shorter parts.
  virtual bool overshoots(const InteractionStep&) { return false; }

  /// The reason why it does not support the long steps of `implicit` and `quasi_static`, as the end of a sentence with a remedy;
  /// empty if it does. Its forces are then those at the end of the step, and declare() is called in every iteration of Newton's
  /// method, always from the state after reach().
  virtual std::string refuses_long_steps() const;
  /// Called before `attached`: whether its steps will be long.
  virtual void set_long_steps(bool /*are_long*/) {}

  /// Whether between_steps may add vertices: the arrays of the state may then move in memory at any step.
  virtual bool changes_body() const { return false; }

  /// Upper bound of the squared frequency of the added stiffness (add_forces) on the masses of the body [1/s²]; it
  /// shortens the stable step. Called after every step: a value that follows the state has to cover the next step.
  /// Constraints add no stiffness.
  virtual double squared_frequency() const { return 0.0; }
  /// The first corner of its motion after a time, where a long step is to end [s].
  virtual double next_corner(double /*after*/) const { return std::numeric_limits<double>::infinity(); }
  /// Appends stiffnesses d_v of vertices, at most one each, that bound the added stiffness K of the last add_forces:
  /// xᵀ K x ≤ Σ d_v |x_v|². Variable mass scaling then adds mass there instead of the shorter step of squared_frequency().
  /// @return whether it provides them; constant while it is attached
  virtual bool add_stiffness_bound(std::vector<VertexStiffness>&) const { return false; }

  /// Stored by its elastic forces (add_forces), at force_time() [J].
  virtual double energy() const { return 0.0; }
  /// Energy that its elastic forces have lost without work so far, as by a tear: Energies::fracture [J].
  virtual double released_energy() const { return 0.0; }
  /// Energy that changes of its own law have added to what its elastic forces store, without work: Energies::changed [J].
  virtual double changed_energy() const { return 0.0; }
  /// Stored in the tool itself at force_time(), as in a bent needle: Energies::instruments [J]. Kept where energies are tracked.
  virtual double tool_energy() const { return 0.0; }

  /// Adds its force on the surface of the body in the last step, per vertex of the mesh [N]: the whole force on the tissue, and
  /// its part along the inward normals of contact. @return whether it is of a kind that presses on the surface
  virtual bool add_contact(std::span<Vec3d> /*force*/, std::span<double> /*pressing*/) const { return false; }

  /// Writes or reads its state for a checkpoint, to the last bit (glisson/archive.h), without what follows from the body and
  /// its options. Reading comes after body_changed() has reported all changes that preceded the writing.
  /// @throws std::runtime_error if the data are not the state of such an interaction
  virtual void archive(Archive&) {}
  /// Copies its state as it is in memory, for Simulation::save_state() and for steps that are undone. An interaction without
  /// these two members is copied by archive(), after body_changed() where the body has become another one.
  virtual std::shared_ptr<const void> save_state() const;
  /// Goes to a state that save_state() of this object returned, also one of an earlier or later body.
  /// @param other_body  the body of that state, where it is another one than it was just now; none: it is the same
  virtual void load_state(const std::shared_ptr<const void>& state, const BodyView* other_body);

 private:
  friend class Simulation;
  bool is_attached_ = false;  ///< to a simulation, permanently: its state belongs to that body
};

}  // namespace glisson
