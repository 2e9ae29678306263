// simulation.h — a body in motion: what a program embeds.
//
//   TetMesh + tissues ──▶ Simulation ── fix / drive / load ──▶ step() … step()
//                                                               └▶ displacement, forces, energies
//
// Motion is the paper's explicit scheme on lumped masses [Schwartz2002, eq. 3–4], or one of the other integrators
// (docs/integrators.md). Setters and the constructor throw std::invalid_argument with the name, the value and the
// allowed range; a step never throws and reports failure by its status. Members that change something throw
// std::logic_error when they are called from inside a step, by a motion, load, driver, interaction or observer; those that
// change the body may be called from Interaction::between_steps(). A simulation that was moved from can only be assigned to
// or destroyed: its members throw std::logic_error.
//
// Several threads may read a simulation at once, by its const members; while one changes it, no other may use it. What an interaction of
// a program's own answers to them (released_energy(), save_state()) is then asked from several threads.
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
#include "glisson/pose.h"
#include "glisson/simulation/contact_fields.h"
#include "glisson/simulation/energies.h"
#include "glisson/simulation/integrator.h"
#include "glisson/simulation/interaction.h"
#include "glisson/simulation/mass_scaling.h"
#include "glisson/simulation/precision.h"
#include "glisson/simulation/state.h"
#include "glisson/simulation/static_branches.h"
#include "glisson/simulation/surface_load.h"
#include "glisson/simulation/tet_fields.h"
#include "glisson/time_function.h"
#include "glisson/words.h"

namespace glisson {

/// What happens to a run that meets an inverted tetrahedron (J ≤ 0).
enum class OnInversion { go_on, stop };
template <>
inline constexpr Word<OnInversion> kWords<OnInversion>[] = {{"go_on", OnInversion::go_on, "count them and go on"},
                                                            {"stop", OnInversion::stop, "end the run there"}};

/// Time scheme of `implicit`.
enum class TimeScheme {
  backward_euler,
  newmark,           ///< β = ¼, γ = ½ (mean acceleration)
  generalised_alpha  ///< [ChungHulbert1993]
};
template <>
inline constexpr Word<TimeScheme> kWords<TimeScheme>[] = {
    {"backward_euler", TimeScheme::backward_euler, "first order; damps what it cannot resolve"},
    {"newmark", TimeScheme::newmark, "second order, keeps the energy of a linear body"},
    {"generalised_alpha", TimeScheme::generalised_alpha,
     "second order, damps what it cannot resolve by `spectral_radius`"}};

/// Preconditioner of the linear solves of `implicit` and `quasi_static`.
enum class Preconditioner {
  automatic,  ///< factorised up to some 20 000 tets, block_diagonal above
  factorised,
  block_diagonal
};
template <>
inline constexpr Word<Preconditioner> kWords<Preconditioner>[] = {
    {"auto", Preconditioner::automatic, "by the size of the body"},
    {"factorised", Preconditioner::factorised, "sparse Cholesky, kept as long as it converges"},
    {"block_diagonal", Preconditioner::block_diagonal, "3 × 3 per vertex"}};

/// Options of the integrators `implicit` and `quasi_static`.
struct ImplicitOptions {
  TimeScheme scheme = TimeScheme::backward_euler;  ///< of `implicit`
  double spectral_radius = 0.8;                    ///< ρ∞ of generalised_alpha [-]
  /// First and largest automatic step [s]; none: 10 ms, `quasi_static` 50 ms, with StaticBranches::follow the first alone.
  std::optional<double> largest_step{};
  double tolerance = 1e-8;   ///< of Newton's method: residual force over the largest force [-]
  int most_iterations = 25;  ///< of Newton's method, before a step is halved
  int most_cuts = 20;        ///< how often a step is halved before it fails
  Preconditioner preconditioner = Preconditioner::automatic;

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(
        field("scheme", &ImplicitOptions::scheme, "time scheme of the integrator implicit"),
        field("spectral_radius", &ImplicitOptions::spectral_radius, "-", between(0, 1), "ρ∞ of generalised_alpha"),
        field("largest_step", &ImplicitOptions::largest_step, "s", above(0), "first and largest automatic step")
            .otherwise("0.01, quasi_static 0.05"),
        field("tolerance", &ImplicitOptions::tolerance, "-", between(1e-13, 1e-2),
              "residual force over the largest force"),
        field("most_iterations", &ImplicitOptions::most_iterations, between(1, 1000),
              "of Newton's method, before a step is halved"),
        field("most_cuts", &ImplicitOptions::most_cuts, between(0, 40),
              "how often a step is halved before the run stops"),
        field("preconditioner", &ImplicitOptions::preconditioner, "preconditioner of the linear solves"));
  }
};

/// Largest number of stages of the viscous force in a step: with more, rounding errors would grow.
inline constexpr int kMostDragStages = 8;
/// The same with needles and containers that are not bonded: they hold other vertices in each step, and a released vertex moves
/// for one step with its lumped mass alone. With more stages the tissue would be too soft there.
inline constexpr int kMostDragStagesBesideInstruments = 4;
/// The same with tools in contact, whose surface of contact changes with each step, and with interactions without
/// most_drag_stages() of their own: blades, a program's.
inline constexpr int kMostDragStagesBesideOthers = 3;

struct SimulationOptions {
  Integrator integrator = Integrator::central_difference;
  /// h [s]. Explicit and semi-implicit: ≤ h*; none: 0.9 h*, reduced as tissue stiffens and increased again as it
  /// softens; semi-implicit 0.9 h* of the elastic body. Implicit and quasi-static: none: the longest that converges, up to
  /// ImplicitOptions::largest_step; a given one is subdivided internally where it does not converge.
  std::optional<double> step{};
  /// Explicit and semi-implicit: adds mass only to tets whose element step bound is below this step, until it equals it
  /// [s]; for meshes with a few tiny tets. The mass has inertia and weight; mass_scaling() reports it. None: no
  /// mass is added.
  std::optional<double> mass_scaling_step{};
  /// When mass is added for that step: `fixed`: at rest, permanently; `variable`: at vertices of tets whose present bound is below
  /// the step, and only while the tissue moves so evenly that the mass has no effect. `variable` needs central_difference with an
  /// automatic step, which then is at most mass_scaling_step, also above the stable step at rest.
  MassScalingKind mass_scaling = MassScalingKind::fixed;
  /// Largest inertia force of variable mass relative to the forces on the body, Σ Δm |a| over Σ |F|; above it steps become shorter,
  /// so that less mass is needed [-].
  double mass_scaling_inertia = 0.025;
  /// central_difference: stages in which the viscous force is applied within a step. One is the paper's scheme. With n stages the
  /// bound of viscosity on the step is nearly n²/2 times that of one stage, the bound of stiffness 0.91 to 0.95 of that without
  /// viscosity; each further stage costs half a step. For tissue of small strain; at most Interaction::most_drag_stages.
  int drag_stages = 1;
  ImplicitOptions implicit{};
  /// quasi_static: what Maxwell branches and viscosity do.
  StaticBranches branches = StaticBranches::automatic;
  /// `adaptive` needs central_difference and a tissue that is not linear, isotropic, without pioletti's viscosity, averaged volume
  /// changes and branches whose times follow the deformation, and of small strain where it has branches; others keep their law.
  Precision precision = Precision::single_precision;
  /// With adaptive precision: what linear parts may get wrong of the virtual work of the tissue's forces in the displacement, each
  /// taken by its absolute value, as share of that work [-].
  double precision_error = 0.0025;
  double damping_rate = 0.0;      ///< mass-proportional nodal damping γ_i/m_i [1/s]
  double nodal_damping = 0.0;     ///< additional nodal damping γ_i, equal at all vertices [kg/s]
  Vec3d gravity{};                ///< [m/s²]
  double gravity_ramp = 0.0;      ///< gravity grows linearly from 0 over this time [s]
  bool enforce_stability = true;  ///< false: any step is accepted, for studies of the instability itself
  /// Threads for the element forces; 0: chosen by the size of the body. The result is the same bytes on any
  /// number of threads. Explicit steps in double precision always take one.
  int threads = 0;
  /// Whether energies() is computed. It makes a step up to half as long again; forces of constraints are available
  /// either way.
  bool track_energies = true;
  /// How an automatic step follows tissue that stiffens beyond what h* was computed for. true: h* is searched again,
  /// which is exact and takes some ms for a thousand tets. false: a bound from the last h*, at most √r smaller where
  /// the tissue has become r times stiffer (r with nodal damping); for real time.
  bool exact_steps = true;
  /// Prepares for remove_tets and split_faces at construction instead of at the first call (O(tets), 34 bytes a tet),
  /// and divides bodies of more than 30 000 tets into smaller submeshes, which are quicker to rebuild when cut; steps
  /// take up to a third longer.
  bool mesh_changes = false;

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(
        field("integrator", &SimulationOptions::integrator, "how the body is advanced in time"),
        field("step", &SimulationOptions::step, "s", above(0),
              "time step h; \"auto\" takes 0.9 of the stable step and follows the tissue; for implicit and "
              "quasi_static the largest that converges")
            .or_auto()
            .otherwise("\"auto\"")
            .advise("\"auto\" chooses the largest safe step"),
        field("mass_scaling_step", &SimulationOptions::mass_scaling_step, "s", above(0),
              "adds mass only to tets whose element step bound is shorter, until it equals this step; "
              "central_difference and semi_implicit. `glisson check` reports the tets and the mass")
            .otherwise("no mass is added"),
        field(
            "mass_scaling", &SimulationOptions::mass_scaling,
            "when mass is added for `mass_scaling_step`; variable: with an automatic step of central_difference, which "
            "then is that one at most (docs/integrators.md)"),
        field("mass_scaling_inertia", &SimulationOptions::mass_scaling_inertia, "-", between(1e-4, 0.5),
              "share of the forces on the body that the inertia of variable mass may have; where it has more, steps "
              "become shorter and need less mass. Small: accurate after a puncture; large: for real time"),
        field("drag_stages", &SimulationOptions::drag_stages, between(1, kMostDragStages),
              "stages in which the viscous force is taken within a step of central_difference: they make steps longer "
              "where viscosity_Pa_s limits them (docs/integrators.md); at most 4 with needles and containers that are "
              "not bonded, 3 with tools in contact and blades"),
        field("implicit", &SimulationOptions::implicit, "options of the integrators implicit and quasi_static"),
        field("branches", &SimulationOptions::branches,
              "what Maxwell branches and `viscosity_Pa_s` do under quasi_static"),
        field("precision", &SimulationOptions::precision, "precision of the element arithmetic"),
        field(
            "precision_error", &SimulationOptions::precision_error, "-", between(1e-6, 0.5),
            "with precision = \"adaptive\": share of the virtual work of the tissue's forces that linear parts may get "
            "wrong"),
        field("damping_rate", &SimulationOptions::damping_rate, "1/s", at_least(0),
              "nodal damping in proportion to mass, γ/m"),
        field("nodal_damping", &SimulationOptions::nodal_damping, "kg/s", at_least(0),
              "nodal damping γ, equal at all vertices, in addition")
            .keyed("nodal_damping_kg_per_s"),
        field("gravity", &SimulationOptions::gravity, "m/s²", "gravity"),
        field("gravity_ramp", &SimulationOptions::gravity_ramp, "s", at_least(0),
              "time over which gravity grows from 0"),
        no_key("enforce_stability", &SimulationOptions::enforce_stability),
        no_key("threads", &SimulationOptions::threads, between(0, 1024)),
        no_key("track_energies", &SimulationOptions::track_energies),
        no_key("exact_steps", &SimulationOptions::exact_steps),
        no_key("mesh_changes", &SimulationOptions::mesh_changes));
  }
};

/// How a simulation is evaluated: for reports and benchmarks.
struct EngineInfo {
  std::string instruction_set;  ///< of the element kernels
  int threads = 1;
  std::size_t submeshes = 0;
  double flops_per_tet = 0.0;  ///< useful floating-point operations per tet and step, without padding; 0: not counted
  double bytes_per_tet = 0.0;  ///< rest data and state read or written per tet and step [B]; 0: not counted
};

enum class StepStatus {
  ok,
  inverted,        ///< tets with J ≤ 0 in the state the step started from; the step was made
  step_too_large,  ///< the tissue stiffened until the given h exceeds h*, or h* is lost in t + h; the step was not made
  /// a force is not finite and the run cannot continue. No vertex was moved by such a force: a finite state stays
  /// finite, but parts of the body may be one step ahead of others
  not_finite,
  /// implicit, quasi-static: no equilibrium was found with any step size; semi-implicit: contact was not found within its
  /// iterations; the step was not made
  not_converged,
  not_held,    ///< quasi-static: supports and tools leave a rigid motion free; the step was not made
  interrupted  ///< implicit, quasi-static: Simulation::set_interrupt asked for it; the step was not made
};
template <>
inline constexpr Word<StepStatus> kWords<StepStatus>[] = {{"ok", StepStatus::ok},
                                                          {"inverted", StepStatus::inverted},
                                                          {"step_too_large", StepStatus::step_too_large},
                                                          {"not_finite", StepStatus::not_finite},
                                                          {"not_converged", StepStatus::not_converged},
                                                          {"not_held", StepStatus::not_held},
                                                          {"interrupted", StepStatus::interrupted}};

/// Where a long step of `implicit` or `quasi_static` is, see Simulation::set_interrupt.
struct StepProgress {
  double time = 0.0;  ///< at which the part of the step begins that is solved for [s]
  double h = 0.0;     ///< length of that part [s]
  int iteration = 0;  ///< of Newton's method in it, from 0
};

struct StepResult {
  StepStatus status = StepStatus::ok;
  std::span<const std::uint32_t> inverted_tets;  ///< valid until the next step
  /// The reason why a step was not made and what to do; empty if it was made. Valid until the next step.
  std::string_view message;
  /// Whether the rows of all tools could be met. Otherwise, as where two plates close on a vertex, all
  /// of them miss a part, and the step was made.
  bool contact_met = true;
  /// Whether the step was made; otherwise time has not advanced.
  bool made() const { return status == StepStatus::ok || status == StepStatus::inverted; }
};

/// Which components of a vertex a constraint holds.
struct Axes {
  bool x = true, y = true, z = true;
};

/// The removed tets, their mass, momentum and energy.
struct RemovalReport {
  std::size_t tets = 0;                       ///< removed by this call, without those removed before
  double mass = 0.0;                          ///< [kg]
  Vec3d momentum{};                           ///< [kg m/s]
  double energy = 0.0;                        ///< kinetic and elastic, as in Energies::removed [J]
  std::vector<std::uint32_t> loose_vertices;  ///< vertices that no longer belong to any tet: they do not move
};

/// Result of a split.
struct SplitReport {
  std::uint32_t first_new = 0;         ///< number of the first new vertex
  std::vector<std::uint32_t> origins;  ///< vertex first_new + i is a copy of origins[i]
  std::size_t closed_faces = 0;        ///< faces split so far that are still closed: all their vertices are at the rim
};

/// A tet that may limit the step.
struct LimitingTet {
  std::uint32_t tet = 0;
  double altitude = 0.0;  ///< smallest distance of a vertex from the opposite face, at rest [m]
  double step = 0.0;      ///< its element step bound at rest stiffness [s]: h* is not below the smallest of all tets
};

/// Displacement of a driven set at time t [m]; must be 0 at the time the drive starts.
using Motion = TimeFunction<Vec3d>;

/// Handle of a constraint for reading its force.
struct ConstraintId {
  std::size_t index = 0;
};

/// A tensor-mass body with its supports, tools and loads, advanced step by step.
class Simulation {
 public:
  /// @param mesh     valid (require_valid), rest positions [m]
  /// @param tissues  tissue of each region number that occurs in the mesh, by region number
  /// @throws std::invalid_argument for a bad mesh, tissue or option, or a step above h* (the message gives h* and the
  ///         alternatives)
  Simulation(TetMesh mesh, std::map<int, Tissue> tissues, const SimulationOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Holds vertices at their present positions. A component held already stays the first set's; one that moves is an error.
  ConstraintId fix(std::span<const std::uint32_t> vertices, Axes axes = {});
  /// The same for a vertex set of the mesh by name, as in drive and add_load. @throws std::invalid_argument naming the
  /// sets there are
  ConstraintId fix(std::string_view set, Axes axes = {});
  /// Moves vertices along a prescribed path, in the given components, from their positions at its start.
  /// @param from  start time [s]; until then the vertices are free and its force is 0
  ConstraintId drive(std::span<const std::uint32_t> vertices, Motion motion, Axes axes = {}, double from = 0.0);
  ConstraintId drive(std::string_view set, Motion motion, Axes axes = {}, double from = 0.0);
  /// Moves vertices as a rigid body, in the given components: where they are at the start goes with the motion from there,
  ///   x(t) = P(t) P(from)⁻¹ x(from).
  /// @param motion  P: a pose at time t. Positions and angles as functions of time: glisson/instruments/rigid_motion.h
  ConstraintId drive_rigidly(std::span<const std::uint32_t> vertices, PoseMotion motion, Axes axes = {},
                             double from = 0.0);
  ConstraintId drive_rigidly(std::string_view set, PoseMotion motion, Axes axes = {}, double from = 0.0);
  /// Adds a force [N], SurfaceLoad::force alone; `scale(t)` multiplies it (none: 1).
  void add_load(std::span<const std::uint32_t> vertices, Vec3d force, TimeFunction<double> scale = {});
  void add_load(std::string_view set, Vec3d force, TimeFunction<double> scale = {});
  /// Adds force, traction, pressure, moment, springs and dashpots on a set and its faces. Removed tets take the load of their
  /// faces with them; faces that a cut opens carry none. What is given for a whole set is shared by its vertices in tets.
  /// @param scale  multiplies force, traction, pressure and moment at time t (none: 1)
  /// @throws std::invalid_argument for a value outside its range, a set without a vertex of a tet, one that spans no face
  ///         where faces are needed, or springs too stiff for a given explicit step
  void add_surface_load(std::span<const std::uint32_t> vertices, const SurfaceLoad& load,
                        TimeFunction<double> scale = {});
  void add_surface_load(std::string_view set, const SurfaceLoad& load, TimeFunction<double> scale = {});

  /// Attaches an instrument, needle, membrane or other interaction; it acts after those attached before. Keep the
  /// pointer to read and control it between steps.
  /// @throws std::invalid_argument if it is already attached to a simulation; if it does not act under
  ///         implicit and quasi_static, or semi_implicit in viscous tissue, which its message says; or if it does not support this body
  void attach(std::shared_ptr<Interaction> interaction);

  /// Removes tets at once, with their stiffness, viscosity and mass; nothing else changes. Numbers of tets and vertices
  /// stay. An automatic step falls to the element step bound; a given step above that bound is checked against h* by a
  /// search in the next step.
  /// @param tets  numbers of the mesh; removed ones are ignored
  /// @throws std::invalid_argument for an invalid tet number; nothing is changed then
  /// Cost: some 2 µs a tet, 4 for linear tissue, after the first call or with SimulationOptions::mesh_changes.
  RemovalReport remove_tets(std::span<const std::uint32_t> tets);
  /// Opens the body along inner faces: vertices separated by the faces are copied, numbered after the last vertex, with
  /// the state of their origin. Copies belong to the sets, supports and tools of their origin, and share its loads.
  /// @param faces  three vertices each, in present numbers; repeated ones are ignored
  /// @param moves  made in order before the body is opened: the vertex becomes another point of the material and takes
  ///               the displacement and velocity of that point; the material does not move. Masses follow, and the
  ///               difference of the energies of the tets around it is added to `removed`
  /// @throws std::invalid_argument naming a face that no tet has, that is at the boundary or has more than two tets, or
  ///         a vertex that does not exist or would invert a tet; nothing is changed then
  /// Cost: docs/cutting.md.
  SplitReport split_faces(std::span<const Triangle> faces, std::span<const VertexMove> moves = {});
  /// Replaces the tissue of a region. All else stays: deformation, velocities, time, supports, motions, loads,
  /// interactions, removed tets and split faces. A tissue equal to the present one changes nothing.
  ///
  /// Memory of the tissue: Kelvin–Voigt viscosity has none. The k-th Maxwell branch keeps its present stress, g (S −
  /// q), whatever its new share and time; new branches start without stress, the stress of dropped ones is lost.
  /// A new density changes masses at the present velocities, and thus momentum; mass scaling is recomputed. The jump of
  /// stored and kinetic energy is added to Energies::changed.
  ///
  /// An automatic step is updated at once: by a search of h*, or with SimulationOptions::exact_steps = false from the
  /// last h*.
  /// force() refers to the last step's tissue until the next step.
  /// @param region  number of a region of the mesh
  /// @throws std::invalid_argument for a region that no tet has, an invalid tissue, the first viscous tissue for
  ///         semi_implicit with interactions, or where a given step is above the new h*; nothing is changed then
  /// Cost: docs/integrators.md.
  void set_tissue(int region, const Tissue& tissue);
  /// The same for several regions, at the cost of one.
  void set_tissues(const std::map<int, Tissue>& tissues);
  /// Present tissue of a region. @throws std::invalid_argument for a region that no tet has
  const Tissue& tissue(int region) const;

  /// @throws std::invalid_argument for an invalid tet number
  bool is_removed(std::uint32_t tet) const;
  /// The present rest mesh, without the removed tets (new tet numbers, the same vertex numbers).
  TetMesh present_mesh() const;

  /// Advances by step_size(). A step that is not made does not advance time: a loop over time has to check the result.
  [[nodiscard]] StepResult step();
  /// Makes steps up to the one that ends nearest to `time` [s], or until one is not made; automatic steps of `implicit` and
  /// `quasi_static` end there. @return result of the last step
  /// @throws std::invalid_argument for a time that is not finite
  [[nodiscard]] StepResult advance_to(double time);
  /// Sets what is asked now and then within a long step, some times a second where that is possible; true ends the step, which
  /// is not made then (StepStatus::interrupted). Other integrators' steps are short and do not ask. None: nothing is asked.
  void set_interrupt(std::function<bool(const StepProgress&)> asks);

  double time() const;       ///< [s]
  double step_size() const;  ///< h of the next step [s]
  /// The first corner after a time [s] of motions, loads, gravity and instruments; infinite: none follows. Automatic steps of
  /// `implicit` and `quasi_static` end there.
  double next_corner(double after) const;
  /// Lets automatic steps of `implicit` and `quasi_static` end at this time, too [s]; the last one given counts. Others do not change.
  void set_step_end(double time);
  /// h* [s]: the largest step for which the scheme is stable, from a safe upper bound of the spectrum of the
  /// free body at its present stiffness [Schwartz2002, eq. 4; docs/theory.md §4]; infinite for implicit and quasi_static
  double stable_step() const;
  std::uint64_t steps() const;

  const MassScaling& mass_scaling() const;
  /// The tets with the smallest element step bounds, smallest first: without the first k of them, or with more mass for
  /// them, the bound of h* is that of the next. The explicit integrator's bounds include viscosity.
  std::vector<LimitingTet> limiting_tets(std::size_t most = 10) const;

  /// Rest mesh with all tets, including removed ones; split tets have their present vertices.
  const TetMesh& mesh() const;
  std::span<const double> masses() const;       ///< lumped, per vertex [kg]
  std::span<const Vec3d> displacement() const;  ///< u(t), per vertex [m]
  /// Per vertex [m/s]: v(t − h/2), implicit: v(t), quasi-static: 0, with StaticBranches::follow that of the last part of a step.
  std::span<const Vec3d> velocity() const;
  std::vector<Vec3d> positions() const;  ///< rest + u, per vertex [m]
  /// Sets the state, for studies that do not start from rest; energies are counted from here.
  /// @param displacement  [m], @param velocity  as velocity() [m/s], one per vertex; held vertices keep theirs at 0
  void set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity);

  /// Force of the constraint on the tissue, at force_time().
  ForceParts force(ConstraintId constraint) const;
  /// Torque of the same forces, with where the vertices are then [N m]: Σ (x − about) × f.
  Vec3d torque(ConstraintId constraint, const Vec3d& about) const;
  /// Time of force() and energies() [s]: explicit, semi-implicit: start of the last step; implicit, quasi-static: its end.
  double force_time() const;
  /// All zero unless SimulationOptions::track_energies.
  Energies energies() const;
  /// W(u) of tissue and capsules at force_time() [J]; none where some tissue's forces have no energy: a law that is neither
  /// constant nor in energy form, or Maxwell branches that relax the deviator of fibres or of a law.
  /// Cost: a pass over the elements in double.
  std::optional<double> stored_energy() const;
  /// Energies::elastic, the work summed over the steps, minus the stored energy W(u) [J]: the drift of the time integration, and
  /// half a step's work of removed tets. None without stored_energy(). Needs track_energies.
  std::optional<double> energy_drift() const;
  /// With adaptive precision: share of the tets that go by the linear law at present; in a tet where the laws are mixed, the linear
  /// one's share counts. TetFields::linear says where. Else 0 [-].
  double linear_share() const;
  const EngineInfo& engine_info() const;

  /// Copies the present state, to go back to (state.h). What functions of the program's own hold, as motions and drivers, is
  /// theirs.
  /// Cost: some 0.1 µs a tet; the body is copied when it is about to change, once for all states since the last change.
  State save_state() const;
  /// Goes to a state, earlier or later: mesh, tissues, forces and instruments are as they were, and the run continues with the
  /// same bytes. What has been added to the simulation since then (supports, motions, loads, instruments) is refused.
  /// @throws std::invalid_argument for a state of another simulation, or naming what was added; nothing is changed then
  /// Cost: as save_state(); where the body has changed in between, it is laid out again: some µs a tet.
  void load_state(const State& state);
  /// Goes to the state in which the first step was made, or does nothing where none was. @throws as load_state
  void reset();

  /// Writes the state that a continued run needs besides the initial mesh, tissues, options, constraints and loads,
  /// including all changes since the start.
  /// @throws std::runtime_error if it cannot be written
  void save(std::ostream& out) const;
  /// Restores the state of a saved simulation; this one must have been built in the same way (mesh, tissues, options,
  /// constraints, loads, interactions, in their order), and may have made steps and changes since. Changes of tissue and
  /// topology are restored; where constraints or loads were added after a split, make the same split before them here. The
  /// run continues with the same bytes.
  /// @throws std::runtime_error for a file that is truncated, modified, or of another mesh or setup; nothing is changed then
  void load(std::istream& in);

  /// Shape measure q, equivalent shear strain and stress of every tet in the present state.
  TetFields tet_fields() const;

  /// Pressure and traction of tools and containers on the surface, of the last step; empty where none is attached.
  /// Cost: finds the surface, some 0.1 µs a tet.
  ContactFields contact_fields() const;

  /// 64-bit FNV-1a hash over the bytes of displacement and velocity: equal states, equal hash, run to run.
  std::uint64_t state_hash() const;

 private:
  friend struct SimulationParts;
  struct Impl;
  /// @throws std::logic_error where it was moved from
  Impl& inside() const;
  std::unique_ptr<Impl> impl_;
};

}  // namespace glisson
