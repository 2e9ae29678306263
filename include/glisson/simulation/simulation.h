// simulation.h — a body in motion: what a program embeds.
//
//   TetMesh + tissues ──▶ Simulation ── fix / drive / load ──▶ step() … step()
//                                                               └▶ displacement, forces, energies
//
// Motion is the paper's explicit scheme on lumped masses [Schwartz2002, eq. 3–4], or one of the other integrators
// (docs/integrators.md). Setters and the constructor throw std::invalid_argument with the name, the value and the allowed
// range; a step never throws and says by its status how it went.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "glisson/material/tissue.h"
#include "glisson/math.h"
#include "glisson/mesh.h"
#include "glisson/simulation/interaction.h"
#include "glisson/simulation/precision.h"
#include "glisson/simulation/tet_fields.h"

namespace glisson {

/// What happens to a run that meets an inverted tetrahedron (J ≤ 0).
enum class OnInversion { go_on, stop };

/// How a body is advanced in time: M a + γ v + f(u, v) = external (docs/integrators.md says when to take which).
enum class Integrator {
  explicit_,      ///< the paper's scheme; h* is set by stiffness and viscosity
  semi_implicit,  ///< the same with viscosity taken at the end of the step: h* as if there were none, or more
  implicit,       ///< Newton's method each step, stable at any step; in double
  static_  ///< equilibrium under loads and motions, without inertia and viscosity; time is a parameter; in double
};

/// How `implicit` goes from t to t + h.
enum class TimeScheme {
  backward_euler,    ///< first order; damps what it cannot resolve
  newmark,           ///< second order, β = ¼, γ = ½ (mean acceleration): keeps the energy of a linear body
  generalised_alpha  ///< second order, damps what it cannot resolve by ρ∞ [ChungHulbert1993]
};

/// What speeds up the linear solves of `implicit` and `static_`.
enum class Preconditioner {
  automatic,      ///< factorised up to some 20 000 tets, block_diagonal above
  factorised,     ///< sparse Cholesky of the tangent, kept as long as it serves
  block_diagonal  ///< 3 × 3 a vertex
};

/// Of the integrators `implicit` and `static_`.
struct ImplicitOptions {
  TimeScheme scheme = TimeScheme::backward_euler;  ///< of `implicit`
  double spectral_radius = 0.8;                    ///< ρ∞ of generalised_alpha [-], 0 … 1
  /// Where an automatic step begins, and above which it never grows [s], > 0; none: 10 ms, `static_` 50 ms.
  std::optional<double> largest_step{};
  double tolerance = 1e-8;   ///< of Newton's method: forces out of balance over the largest forces [-], 1e-13 … 1e-2
  int most_iterations = 25;  ///< of Newton's method, before a step is cut in two, 1 … 1000
  int most_cuts = 20;        ///< how often a step is cut in two before it is given up, 0 … 40
  Preconditioner preconditioner = Preconditioner::automatic;
};

struct SimulationOptions {
  Integrator integrator = Integrator::explicit_;
  /// h [s], > 0. Explicit and semi-implicit: ≤ h*; none: chosen as 0.9 h*, kept below it as tissue stiffens, and grown
  /// again when it softens; semi-implicit 0.9 h* of the elastic body. Implicit and static: none: as long as converges,
  /// up to ImplicitOptions::largest_step; a given one is cut inside where it does not converge.
  std::optional<double> step{};
  ImplicitOptions implicit{};
  Precision precision = Precision::single_precision;
  double damping_rate = 0.0;   ///< mass-proportional nodal damping γ_i/m_i [1/s], ≥ 0
  double nodal_damping = 0.0;  ///< nodal damping γ_i equal at all vertices, added to it [kg/s], ≥ 0
  /// Explicit and semi-implicit: adds mass to just those tets whose own bound is below this step, until it is that [s], > 0;
  /// for meshes with a few tiny tets. The mass has inertia and weight; mass_scaling() reports it. None: no mass is added.
  std::optional<double> mass_scaling_step{};
  Vec3d gravity{};                ///< [m/s²]
  double gravity_ramp = 0.0;      ///< gravity grows linearly from 0 over this time [s], ≥ 0
  bool enforce_stability = true;  ///< false: take any step, for studies of the instability itself
  /// Threads for the element forces, 0 … 1024; 0: as many as pay for the size of the body. The result is the same
  /// bytes on any number. In double precision always one.
  int threads = 0;
  /// Whether energies() is kept. It makes a step up to half as long again; forces of constraints are there either way.
  bool track_energies = true;
  /// What an automatic step does when tissue stiffens beyond what h* was found for: search for h* anew, which takes
  /// some ms for a thousand tets and is exact, or take a bound from the last h* at once, at most √r smaller where
  /// the tissue has become r times stiffer (r with nodal damping). For real time: false.
  bool exact_steps = true;
  /// Makes ready for remove_tets and split_faces at once, instead of at the first of them (O(tets), 34 bytes a tet), and lays
  /// bodies of more than 30 000 tets out in smaller parts, which are sooner made anew where they are cut; steps take up to a
  /// third longer for that.
  bool mesh_changes = false;
};

/// How a simulation is evaluated: for reports and benchmarks.
struct EngineInfo {
  std::string instruction_set;  ///< of the element kernels
  int threads = 1;
  std::size_t submeshes = 0;
  double flops_per_tet = 0.0;  ///< useful floating-point operations a tet and step, padding not counted; 0: not counted
  double bytes_per_tet = 0.0;  ///< rest data and state a tet that a step goes through [B]; 0: not counted
};

enum class StepStatus {
  ok,
  inverted,        ///< tets with J ≤ 0 in the state the step started from; the step was made
  step_too_large,  ///< the tissue stiffened until the given h exceeds h*, or h* is lost in t + h; the step was not made
  /// a force is not finite and the run cannot go on. Nothing was moved by such a force: the state is finite
  /// wherever it was, but parts of the body may be one step further than others
  not_finite,
  not_converged,  ///< implicit, static: no equilibrium was found, however small the step; the step was not made
  not_held        ///< static: supports and tools leave a rigid motion free; the step was not made
};

struct StepResult {
  StepStatus status = StepStatus::ok;
  std::span<const std::uint32_t> inverted_tets;  ///< valid until the next step
  /// Why a step was not made and what to do, never empty then; empty where it was made. Valid until the next step.
  std::string_view message;
  /// Whether the step was made; where it was not, time stays as it is.
  bool made() const { return status == StepStatus::ok || status == StepStatus::inverted; }
};

/// Which components of a vertex a constraint holds.
struct Axes {
  bool x = true, y = true, z = true;
};

/// A force with its parts [N]: what a constraint (tool, support) exerts on the tissue at time t.
///
///   total = elastic + viscous + damping + inertial + gravity + load
///
/// `elastic` and `viscous` are what balances the tissue's own forces, `damping` overcomes γ v,
/// `inertial` accelerates the driven masses, `gravity` and `load` balance weight and other loads, those of
/// interactions among them.
struct ForceParts {
  Vec3d elastic, viscous, damping, inertial, gravity, load;
  Vec3d total() const { return elastic + viscous + damping + inertial + gravity + load; }
};

/// Energies at force_time() [J]. Exact identity of the schemes, up to rounding and the tolerance of Newton's method:
///   kinetic + elastic + dissipated + numerical + removed = initial + work_tools + work_loads + changed.
struct Energies {
  double elastic = 0.0;  ///< − work of the elastic forces; for a linear tissue the stored energy
  double kinetic = 0.0;  ///< explicit, semi-implicit: ½ Σ m v(t−h/2)·v(t+h/2), the scheme's own; implicit: ½ Σ m v²
  double dissipated = 0.0;  ///< by viscosity and nodal damping
  /// By the time scheme of `implicit` itself. Backward Euler: ½ Σ m |Δv|² − ½ ΔF·Δu a step, F the elastic forces.
  /// Newmark: 0. Static: ½ of what was out of balance at the start, along Δu. Generalised-α: what is missing in the balance, which then says nothing.
  double numerical = 0.0;
  double work_tools = 0.0;  ///< of driven vertices on the tissue
  double work_loads = 0.0;  ///< of gravity and of loads
  double initial = 0.0;     ///< kinetic and elastic energy of the state given by set_state
  /// Kinetic and elastic energy that tets took with them when they were removed, or that a move of vertices at rest took.
  double removed = 0.0;
  /// What changes of tissues brought in: stored energy at the deformation of that moment, and kinetic energy of mass.
  double changed = 0.0;
  double imbalance() const {
    return kinetic + elastic + dissipated + numerical + removed - initial - work_tools - work_loads - changed;
  }
};

/// What left the body with removed tets.
struct RemovalReport {
  std::size_t tets = 0;                       ///< removed by this call; those that were gone already not counted
  double mass = 0.0;                          ///< [kg]
  Vec3d momentum{};                           ///< [kg m/s]
  double energy = 0.0;                        ///< kinetic and elastic, as in Energies::removed [J]
  std::vector<std::uint32_t> loose_vertices;  ///< touched vertices that are in no tet any more: they do not move
};

/// What a split has opened.
struct SplitReport {
  std::uint32_t first_new = 0;         ///< number of the first new vertex
  std::vector<std::uint32_t> origins;  ///< vertex first_new + i is a copy of origins[i]
  std::size_t closed_faces = 0;        ///< faces split so far that are closed still: all their vertices are at the rim
};

/// What mass scaling has added.
struct MassScaling {
  double added = 0.0;               ///< [kg]
  double share = 0.0;               ///< of the body's own mass [-]
  std::vector<std::uint32_t> tets;  ///< that got some, ascending
};

/// A tet that may keep the step short.
struct LimitingTet {
  std::uint32_t tet = 0;
  double altitude = 0.0;  ///< smallest distance of a vertex from the opposite face, at rest [m]
  double step = 0.0;      ///< its own bound at rest stiffness [s]: h* is not below the smallest of all tets
};

/// Displacement of a driven set at time t [m]; must be 0 at the time the set is driven from.
using Motion = std::function<Vec3d(double time)>;

/// Name of a constraint for reading its force.
struct ConstraintId {
  std::size_t index = 0;
};

/// A tensor-mass body with its supports, tools and loads, advanced step by step.
class Simulation {
 public:
  /// @param mesh     valid (require_valid), rest positions [m]
  /// @param tissues  tissue of each region number that occurs in the mesh, by region number
  /// @throws std::invalid_argument for a bad mesh, tissue or option, or a step above h* (h* and the ways out are in the text)
  Simulation(TetMesh mesh, std::map<int, Tissue> tissues, const SimulationOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Holds vertices where they are. A component that is held already is an error.
  ConstraintId fix(std::span<const std::uint32_t> vertices, Axes axes = {});
  /// Moves vertices along a prescribed path, in the given components, from where they are when it takes hold.
  /// @param from  time at which it takes hold [s]; until then the vertices are free and its force is 0
  ConstraintId drive(std::span<const std::uint32_t> vertices, Motion motion, Axes axes = {}, double from = 0.0);
  /// Adds a force, spread over the vertices by equal parts; `scale(t)` multiplies it (none: 1). [N]
  void add_load(std::span<const std::uint32_t> vertices, Vec3d force, std::function<double(double)> scale = {});

  /// Lets an instrument, needle, membrane or other interaction act on the body from now on, after those attached before.
  /// It may be shared, to be read and steered between steps.
  /// @throws std::invalid_argument where it acts on a simulation already, this or another one; for the integrators implicit and static, and semi_implicit with viscous tissue; or what
  ///         the interaction does not bear
  void attach(std::shared_ptr<Interaction> interaction);

  /// Takes tets out at once: their stiffness, viscosity and mass are gone, nothing else changes. Numbers of tets and
  /// vertices stay. An automatic step falls to a bound from single tets; a given step above that bound is
  /// checked against h* by the next step, which takes a search.
  /// @param tets  numbers of the mesh; those that are gone already are passed over
  /// @throws std::invalid_argument for a number that is no tet's; nothing is changed then
  /// Cost: some 2 µs a tet, 4 of a linear tissue, after the first call or with SimulationOptions::mesh_changes.
  RemovalReport remove_tets(std::span<const std::uint32_t> tets);
  /// Opens the body along inner faces: vertices that the faces part get copies, numbered on from the last one, with
  /// the state of their origin. Copies belong to the sets, supports and tools of their origin, and share its loads.
  /// @param faces  three vertices each, in present numbers; repeated ones are ignored
  /// @param moves  made before the body is opened, one after the other: the vertex is another point of the material from
  ///               then on and takes the displacement and velocity of that point; the material stays where it is. Masses
  ///               follow, and what the energies of the tets around it differ by is booked as `removed`
  /// @throws std::invalid_argument naming a face that no tet has, that is at the boundary or has more than two tets, or a
  ///         vertex that is none or would turn a tet over; nothing is changed then
  /// Cost: docs/cutting.md.
  SplitReport split_faces(std::span<const Triangle> faces, std::span<const VertexMove> moves = {});
  /// Gives a region another tissue from now on: all else stays as it is, deformation, velocities, time, supports, motions,
  /// loads, interactions, tets removed and faces split. A tissue equal to the present one changes nothing.
  ///
  /// What a tissue remembers: Kelvin–Voigt viscosity nothing. The k-th Maxwell branch keeps its stress at this moment, g (S − q),
  /// whatever its new share and time; branches that come new start without stress, the stress of those that go is gone.
  /// Another density changes masses at the velocities there are, and with them momentum; mass scaling is made anew.
  /// The jump of stored and kinetic energy is booked as Energies::changed.
  ///
  /// An automatic step follows at once: by a search of h*, or with SimulationOptions::exact_steps = false from the last one.
  /// force() tells of the last step's tissue until the next step.
  /// @param region  number of a region of the mesh
  /// @throws std::invalid_argument for a region that no tet has, a tissue that is not valid, viscous tissue for semi_implicit
  ///         with interactions, or where a given step is above the new h*; nothing is changed then
  /// Cost: docs/integrators.md.
  void set_tissue(int region, const Tissue& tissue);
  /// The same for several regions at once, at the cost of one.
  void set_tissues(const std::map<int, Tissue>& tissues);
  /// Tissue of a region as it is now. @throws std::invalid_argument for a region that no tet has
  const Tissue& tissue(int region) const;

  /// @throws std::invalid_argument for a number that is no tet's
  bool is_removed(std::uint32_t tet) const;
  /// The rest mesh as it is now, without the removed tets (numbers of tets are new, those of vertices the same).
  TetMesh present_mesh() const;

  /// Advances by step_size(). A step that is not made does not advance time: a loop over time has to look at the result.
  [[nodiscard]] StepResult step();
  /// Steps until the step that ends nearest to `time` [s], or until one is not made. @return what the last step returned
  [[nodiscard]] StepResult advance_to(double time);

  double time() const;       ///< [s]
  double step_size() const;  ///< h of the next step [s]
  /// h* [s]: the largest step for which the scheme is stable, from a safe upper bound of the spectrum of the
  /// free body at its present stiffness [Schwartz2002, eq. 4; docs/theory.md §4]; infinite for implicit and static
  double stable_step() const;
  std::uint64_t steps() const;

  const MassScaling& mass_scaling() const;
  /// The tets with the smallest bounds of a step, smallest first: without the first k of them, or with more mass for them,
  /// the bound of h* is that of the next. What viscosity takes off it is counted for the explicit integrator.
  std::vector<LimitingTet> limiting_tets(std::size_t most = 10) const;

  /// At rest, with all tets there ever were; those split have their present vertices.
  const TetMesh& mesh() const;
  std::span<const double> masses() const;       ///< lumped, per vertex [kg]
  std::span<const Vec3d> displacement() const;  ///< u(t), per vertex [m]
  /// Per vertex [m/s]: v(t − h/2), implicit: v(t), static: 0.
  std::span<const Vec3d> velocity() const;
  std::vector<Vec3d> positions() const;  ///< rest + u, per vertex [m]
  /// Sets the state, for studies that do not start from rest; energies count from here.
  /// @param displacement  [m], @param velocity  as velocity() [m/s], one per vertex; held vertices keep theirs at 0
  void set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity);

  /// Force the constraint exerts on the tissue, at force_time().
  ForceParts force(ConstraintId constraint) const;
  /// Time that force() and energies() are of [s]: explicit, semi-implicit: that the last step started from; implicit,
  /// static: that it ended at.
  double force_time() const;
  /// All zero unless SimulationOptions::track_energies.
  Energies energies() const;
  const EngineInfo& engine_info() const;

  /// Writes everything that a continued run needs beside mesh, tissues, options, constraints and loads: those of the start,
  /// what has changed since is in it.
  /// @throws std::runtime_error where it cannot be written
  void save(std::ostream& out) const;
  /// Goes on from where another simulation was saved; this one was made in the same way (mesh, tissues, options,
  /// constraints, loads, in their order). Tissues changed, tets removed and faces split since then are so here, too; where constraints or
  /// loads were added after a split, the same split comes before them here. The run has the bytes of the one saved.
  /// @throws std::runtime_error for a file that is cut, changed, of another version, mesh or set-up
  void load(std::istream& in);

  /// Shape, intensity and stress of every tet at the present state.
  TetFields tet_fields() const;

  /// 64-bit FNV-1a hash over the bytes of displacement and velocity: equal states, equal hash, run to run.
  std::uint64_t state_hash() const;

 private:
  friend struct SimulationParts;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace glisson
