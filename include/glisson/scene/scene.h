// scene.h — experiments as TOML files: reading, checking against the schema, running.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "glisson/implicit.h"
#include "glisson/instruments/blade.h"
#include "glisson/instruments/capsule.h"
#include "glisson/instruments/contact.h"
#include "glisson/instruments/container.h"
#include "glisson/instruments/motion.h"
#include "glisson/instruments/needle.h"
#include "glisson/instruments/rigid_motion.h"
#include "glisson/instruments/tool_motion.h"
#include "glisson/liver.h"
#include "glisson/material/tissue.h"
#include "glisson/mesh.h"
#include "glisson/scene/compare_spec.h"
#include "glisson/simulation/probe.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

/// A scene that cannot be used. what() has one line for each error, in the order of the file: `file:line:column: key:
/// error, value, allowed range, remedy`; for a value given to --set `file: --set KEY: …`.
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct MeshFile {
  std::filesystem::path path;  ///< absolute, or relative to the current directory
  double scale = 1.0;          ///< factor on coordinates
};
using MeshSource = std::variant<BoxOptions, CylinderOptions, MeshFile, ImplicitBody, LiverOptions>;

// `origin` in the structs below is the place in the scene, `file:line:column: key`, for messages that need the mesh. It
// may be empty.

/// Selects vertices by their rest positions, by exactly one criterion.
struct Selection {
  struct Box {
    Vec3d min, max;
  };  ///< inclusive [m]
  struct Sphere {
    Vec3d center;
    double radius;
  };  ///< inclusive [m]
  struct Nearest {
    Vec3d point;
    int count = 1;
  };  ///< the `count` nearest to a point [m]
  struct Side {
    int axis;
    bool upper;
    double depth;
  };  ///< within `depth` [m] of the lowest/highest vertex along an axis
  struct Ids {
    std::vector<std::uint32_t> vertices;
  };
  std::variant<Box, Sphere, Nearest, Side, Ids> where;
  bool surface_only = false;
  std::string origin;
};

/// A region of tets by their centroids at rest; overrides the mesh's own regions.
struct RegionSpec {
  std::string name;
  std::variant<std::monostate, Selection::Box, Selection::Sphere>
      where;  ///< monostate: the mesh's region of that name or number
  Tissue tissue;
  std::string origin;
};

struct FixedSpec {
  std::string set;
  Axes axes;
  std::string origin;
};
struct LoadSpec {
  std::string set;
  SurfaceLoad load;
  double ramp = 0.0;  ///< time over which it grows from 0, linearly [s], ≥ 0
  /// Its course, in place of the ramp: factors at times [s], linear between them, constant before and after.
  std::vector<double> times, factors;
  std::string origin;
};
/// A recorded path from a file (load_record).
struct RecordSpec {
  static constexpr std::string_view kName = "record";
  std::filesystem::path path;  ///< absolute, or relative to the current directory; empty for a path made in memory
  double start = 0.0;
  RecordedMotion motion;  ///< what the file holds
};
/// Poses from a file (load_poses).
struct PosesSpec {
  static constexpr std::string_view kName = "poses";
  std::filesystem::path path;  ///< as that of a record
  double start = 0.0;
  PosesMotion motion;  ///< what the file holds; its start is `start`
};
struct ToolSpec {
  std::string name = "tool";
  std::string set;
  PressMotion motion;
  std::optional<RecordSpec> record;  ///< a recorded path in place of the press, of which only `direction` is used then
  std::optional<ToolPath> path;      ///< a program's own path, in place of both; 0 at time 0
  std::optional<RotationMotion> rotation;  ///< in place of the press or record; with a path in addition to it
  std::optional<PosesSpec> poses;          ///< the same
  bool sideways_free = false;  ///< only the component along the direction is driven (direction along an axis)
  bool axial_free = false;     ///< of a rotation: the component along its axis is free (axis along x, y or z)
  std::string origin;
};

/// The path of a tool, and its end; what turns it left out. @throws std::invalid_argument
ToolPath tool_path(const ToolSpec& tool);
/// Path and rotation of a tool that turns; none of one that does not. @throws std::invalid_argument
std::optional<RigidPath> turning_path(const ToolSpec& tool);
/// Start of a tool's motion [s].
double tool_start(const ToolSpec& tool);

/// Strokes along the instrument's direction and across it; one without its own speed uses the common one.
struct StrokesSpec {
  static constexpr std::string_view kName = "strokes";
  struct One {
    double depth = 0.0;  ///< end point along the direction, from the start [m]
    Vec3d aside{};       ///< end point across the direction [m]
    std::optional<double> velocity;
    double ramp = 0.0, rest = 0.0;

    template <class Take>
    static constexpr auto fields(Take take) {
      return take(field("depth", &One::depth, "mm", "end point along the direction, from the start").must(),
                  field("aside", &One::aside, "mm", "end point across the direction"),
                  field("velocity", &One::velocity, "mm/s", above(0), "speed").otherwise("the common speed"),
                  field("ramp", &One::ramp, "s", at_least(0), "time over which the speed rises, and falls"),
                  field("rest", &One::rest, "s", at_least(0), "rest at the end"));
    }
  };
  double velocity = 0.01, start = 0.0;
  std::vector<One> strokes;

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("velocity", &StrokesSpec::velocity, "mm/s", above(0), "speed of strokes without their own"),
                field("start", &StrokesSpec::start, "s", at_least(0), "start of the first"),
                field("strokes", &StrokesSpec::strokes, "the moves, one or more").must());
  }
  Fault check() const;
};
/// A push that rises over `ramp` and may oscillate:  F = w(t/ramp) (force + swing sin 2π f t).
struct PushSpec {
  static constexpr std::string_view kName = "push";
  double force = 1.0, swing = 0.0, frequency = 1.0, start = 0.0, ramp = 0.0;
  std::optional<double> duration;
  PushMotion tool;  ///< its force and end are these, its direction is that of the motion

  template <class Take>
  static constexpr auto fields(Take take) {
    using P = PushSpec;
    return take(
        field("force", &P::force, "N", "mean force"),
        field("swing", &P::swing, "N", at_least(0), "amplitude of an oscillation about it"),
        field("frequency", &P::frequency, "Hz", above(0), "frequency of the oscillation"),
        field("start", &P::start, "s", at_least(0), "start of the motion"),
        field("ramp", &P::ramp, "s", at_least(0), "time over which it rises"),
        field("duration", &P::duration, "s", above(0), "duration, for the end of the run").otherwise("unlimited"),
        no_key("tool", &P::tool));
  }
};
/// Presses one after the other at the points of a grid: each as deep below the surface at rest as all others, however the
/// surface lies. Every press takes the same time: `move`, down and up at `velocity`, and `hold`.
struct PalpationSpec {
  static constexpr std::string_view kName = "palpation";
  int columns = 7, rows = 7;   ///< points along the instrument's own x and y axes; their middle is its tip at the start
  double spacing = 0.01;       ///< of the points, across the direction [m]
  double indentation = 0.005;  ///< from the first touch of the body at rest [m]
  double velocity = 0.05;      ///< of a press [m/s]
  double clearance = 0.003;    ///< from the surface, where a press begins and ends [m]
  double move = 0.1, hold = 0.05, start = 0.0;

  template <class Take>
  static constexpr auto fields(Take take) {
    using P = PalpationSpec;
    return take(field("columns", &P::columns, between(1, 100), "points along the instrument's own x axis"),
                field("rows", &P::rows, between(1, 100), "points along its own y axis"),
                field("spacing", &P::spacing, "mm", above(0), "distance of neighbouring points, across the direction"),
                field("indentation", &P::indentation, "mm", above(0), "depth of each press below the surface at rest"),
                field("velocity", &P::velocity, "mm/s", above(0), "speed of a press"),
                field("clearance", &P::clearance, "mm", above(0), "distance from the surface before and after a press"),
                field("move", &P::move, "s", above(0), "time of the move to the next point"),
                field("hold", &P::hold, "s", at_least(0), "rest at the depth"),
                field("start", &P::start, "s", at_least(0), "start of the first move"));
  }
};
struct InstrumentMotion {
  /// The last is a program's own path; no scene file gives it.
  std::variant<PressMotion, StrokesSpec, SineMotion, PushSpec, RecordSpec, RotationMotion, PosesSpec, PalpationSpec,
               ToolPath>
      how;
  std::optional<Vec3d> direction;  ///< of any length; none: the instrument's
};

struct InstrumentSpec;
/// Makes a program's own instrument.
using OwnInstrument = std::function<std::shared_ptr<Instrument>(const InstrumentSpec&, std::shared_ptr<ToolDriver>)>;

/// An instrument that presses, pierces or cuts, and its motion.
struct InstrumentSpec {
  std::string name = "instrument";
  Vec3d tip{};                      ///< initial position of its tip [m]
  Vec3d direction{0.0, 0.0, -1.0};  ///< direction of its tip, of any length
  Vec3d side{1.0, 0.0, 0.0};        ///< direction of its own x axis; the component across `direction` counts
  InstrumentMotion motion;
  /// The last is a program's own; no scene file gives it.
  std::variant<NeedleOptions, ContactOptions, BladeOptions, OwnInstrument> what;
  std::map<std::string, TipResistance> regions;  ///< of a needle, by region name
  std::string origin;
};
/// The poses of a file, from its start.
PosesMotion started(const PosesSpec& spec);
/// Initial pose of an instrument: its own z axis points back along its direction.
Pose start_pose(const InstrumentSpec& instrument);
/// Its driver. That of a palpation moves over a plane through its tip, where no body is known; its end is the right one.
/// @throws std::invalid_argument
std::shared_ptr<ToolDriver> make_driver(const InstrumentSpec& instrument);
/// The same, with the body that a palpation feels. @throws std::invalid_argument naming a point that misses the body
std::shared_ptr<ToolDriver> make_driver(const InstrumentSpec& instrument, const TetMesh& mesh);

/// A file of numbers separated by commas: a line of names, `time_s` and `depth_m`, or `time_s`, `x_m`, `y_m` and `z_m`
/// (or _mm), then a line for each time. @param direction  of depths, a unit vector
/// @throws std::runtime_error `file:line: what is wrong`
RecordedMotion load_record(const std::filesystem::path& file, const Vec3d& direction);

/// The same with poses: `time_s`, `x_m`, `y_m`, `z_m` (or _mm) and a quaternion `qw`, `qx`, `qy`, `qz`.
/// @throws std::runtime_error `file:line: what is wrong`
PosesMotion load_poses(const std::filesystem::path& file);

/// A rigid vessel around the body, upright.
struct ContainerSpec {
  enum class Hold { free, wet, bonded };
  Hold hold = Hold::free;  ///< sets three switches of `options`
  ContainerOptions options;
  std::string origin;
};
template <>
inline constexpr Word<ContainerSpec::Hold> kWords<ContainerSpec::Hold>[] = {
    {"free", ContainerSpec::Hold::free, "slides, with `friction`, and lifts off"},
    {"wet", ContainerSpec::Hold::wet, "slides, with `friction`, and does not come off"},
    {"bonded", ContainerSpec::Hold::bonded, "sticks at the point of contact"}};

/// A membrane on a part of the surface.
struct CapsuleSpec {
  CapsuleOptions options;
  std::string set;  ///< vertex set; empty: the whole surface
  std::string origin;
};

/// A place that is read with every sample.
struct ProbeSpec {
  ProbeOptions options;
  std::string origin;
};

struct OutputSpec {
  double sample_rate = 500.0;  ///< [Hz]
  int frames = 60;             ///< frames of the whole run, 0 or more
  bool stored_energy = false;  ///< W(u) with every sample: a pass over the tets in double each

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(
        field("sample_rate", &OutputSpec::sample_rate, "Hz", above(0), "lines of forces.csv per simulated second"),
        field("frames", &OutputSpec::frames, between(0, 100000),
              "states of the whole body stored over the run; 0: none"),
        field(
            "stored_energy", &OutputSpec::stored_energy,
            "stored energy W(u) with each line of forces.csv, and what the work of the elastic forces drifts from it; "
            "each takes some steps' time"));
  }
};

/// One complete experiment: a variant of a scene after expansion.
struct Variant {
  std::string name = "main";
  std::string label;
  MeshSource mesh;
  std::map<std::string, Selection> sets;
  Tissue tissue;
  std::vector<RegionSpec> regions;
  std::vector<FixedSpec> fixed;
  std::vector<LoadSpec> loads;
  std::vector<ToolSpec> tools;
  std::vector<InstrumentSpec> instruments;
  std::vector<CapsuleSpec> capsules;
  std::optional<ContainerSpec> container;
  std::vector<ProbeSpec> probes;
  SimulationOptions simulation;
  OnInversion on_inversion = OnInversion::go_on;
  std::optional<double> duration;          ///< [s]; none: until the last motion has ended
  std::optional<std::uint64_t> max_steps;  ///< stops after that many steps
  OutputSpec output;
  std::string scene_name = "scene";  ///< the scene's file, for messages
};

/// Whether the tissue of the body or of some region passes a test.
template <class Test>
bool any_tissue(const Variant& variant, Test test) {
  return test(variant.tissue) || std::any_of(variant.regions.begin(), variant.regions.end(),
                                             [&](const RegionSpec& region) { return test(region.tissue); });
}
/// Whether a variant has Kelvin–Voigt viscosity.
inline bool is_viscous(const Variant& variant) {
  return any_tissue(variant, [](const Tissue& t) { return t.viscosity > 0.0; });
}

/// A column of forces.csv or probes.csv on an axis of a chart: display = value × scale.
struct AxisSpec {
  std::string column;
  std::string label;  ///< with unit, e.g. "depth [mm]"
  double scale = 1.0;
};
/// Measured points, in the units of the chart.
struct MeasuredSpec {
  std::filesystem::path path;  ///< a .csv with a line of names; absolute, or relative to the current directory
  std::string label = "measured";
  std::string x, y;                                     ///< its columns
  double x_scale = 1.0, x_offset = 0.0, y_scale = 1.0;  ///< x shown = x_scale (x − x_offset)
  std::vector<double> xs, ys;                           ///< content of the file, as shown
};
/// A chart of the report.
struct ChartSpec {
  std::string title;
  AxisSpec x, y;
  std::vector<MeasuredSpec> measured;
  std::vector<std::string> variants;  ///< names; empty: all
  /// Of a map: its largest value at each place (x, y) is shown as a colour, places where it is never above 0 left out.
  /// No column: a chart of lines.
  AxisSpec value;
};

/// What a run is expected to give: a value of a column within bounds.
struct CheckSpec {
  enum class At { end, largest, least, peak };
  std::string what;    ///< a sentence
  std::string column;  ///< of forces.csv or probes.csv
  At at = At::end;
  std::optional<double> at_least, at_most;  ///< in the unit of the column, one of them or both
  std::vector<std::string> variants;        ///< names; empty: all
};
template <>
inline constexpr Word<CheckSpec::At> kWords<CheckSpec::At>[] = {
    {"end", CheckSpec::At::end, "the last value"},
    {"largest", CheckSpec::At::largest, "the largest"},
    {"least", CheckSpec::At::least, "the least"},
    {"peak", CheckSpec::At::peak, "the largest size, without its sign"}};

struct Scene {
  std::filesystem::path file;
  std::string title, description;
  std::vector<std::string> notes;  ///< choices where the source gives no value, and the reasons
  std::string source;              ///< the text of the file
  std::vector<Variant> variants;   ///< one or more
  std::vector<ChartSpec> charts;   ///< empty: the report's own choice
  std::vector<CheckSpec> checks;   ///< what its runs are expected to give
  CompareSpec compare;             ///< how it is given to other models
};

/// `key=value` as given to --set: dotted key, TOML value (a bare word is taken as a string).
struct Override {
  std::string key, value;
};

/// Reads a scene. @throws SceneError
Scene load_scene(const std::filesystem::path& file, std::span<const Override> overrides = {});
/// The same from text; `name` stands for the file in messages, relative mesh paths start at `base`.
Scene parse_scene(std::string_view text, const std::string& name, const std::filesystem::path& base,
                  std::span<const Override> overrides = {});

/// The reference of every key in Markdown: docs/scene.md is this text.
std::string scene_reference_markdown();

/// Reads a mesh file; the io library's read_mesh, passed in so that scenes do not link VTK.
using MeshLoader = std::function<TetMesh(const MeshFile&)>;

/// Values of an instrument at the time of a sample.
struct InstrumentSample {
  double depth = 0.0;          ///< along its direction, from its start [m]
  Vec3d force{};               ///< on the tissue [N]
  std::vector<double> values;  ///< per Instrument::columns()
};

/// One line of forces.csv. Scalars of an instrument are along its direction, positive when it presses.
struct Sample {
  double time = 0.0;                          ///< [s]
  std::vector<InstrumentSample> instruments;  ///< per BuiltVariant::instruments
  std::vector<ForceParts> supports;           ///< per fixed set: its force on the tissue
  std::optional<ContainerLoads> container;    ///< what its sensors carry
  /// Per BuiltVariant::probes.columns(), at probe_time; empty without probes.
  std::vector<double> probes;
  /// That of `time`; a step later [s] in the last sample of a run that was interrupted or stopped.
  double probe_time = 0.0;
  Energies energies;
  std::optional<double> stored_energy;  ///< where OutputSpec::stored_energy asks for it and the tissue has one [J]
};

/// One line of events.csv.
struct RunEvent {
  std::string instrument;
  InstrumentEvent what;
};

struct BuiltVariant;

struct RunSummary {
  std::size_t vertices = 0, tets = 0;
  std::uint64_t steps = 0;
  double time_s = 0.0, step_s = 0.0, stable_step_s = 0.0, wall_s = 0.0, ns_per_tet_step = 0.0, peak_force_N = 0.0;
  Energies energies;
  std::optional<double> stored_energy_J{};  ///< at the end; none where a tissue's forces have no energy
  double energy_drift_most_J = 0.0;         ///< largest |energy_drift()| of the frames and the end; 0 where none
  double mass_added_kg = 0.0;               ///< by mass scaling
  std::size_t inverted_tets_most = 0;       ///< largest number of tets inverted in one step
  double first_inversion_s = -1.0;          ///< time of it; −1: none
  std::uint64_t state_hash = 0;
  enum class End {
    finished,
    interrupted,
    stopped_inverted,
    stopped_unstable,
    stopped_not_finite,
    stopped_not_converged,
    stopped_not_held
  } end = End::finished;
  std::string trouble;  ///< why the last step was not made and what to do; empty if all were
};

/// The end of a run whose step had this status; `finished` if the run continues.
RunSummary::End end_of(StepStatus status, OnInversion on_inversion);

/// Observes a run; called from the run's own thread, never on the hot path of a step.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual void on_start(const Variant&, const Simulation&) {}
  /// Right after on_start; the objects live until on_end has returned.
  virtual void on_built(const BuiltVariant&) {}
  virtual void on_sample(const Sample&) {}
  /// Before the first sample that is not earlier.
  virtual void on_event(const RunEvent&) {}
  virtual void on_frame(const Simulation&) {}
  virtual void on_progress(double /*fraction*/) {}  ///< about ten times a second
  virtual void on_end(const RunSummary&) {}
};

/// Mesh, sets and regions of a variant, ready to simulate. @throws SceneError, and what `load` throws
TetMesh build_mesh(const Variant& variant, const MeshLoader& load, const std::function<bool(double)>& progress = {});

/// Tissue of each region number that occurs in a mesh made by build_mesh.
std::map<int, Tissue> region_tissues(const Variant& variant, const TetMesh& mesh);

/// The largest SimulationOptions::drag_stages with everything that acts on the body (Interaction::most_drag_stages).
int most_drag_stages(const Variant& variant);

/// The body of a variant with its supports, loads, instruments and probes, at rest.
struct BuiltVariant {
  /// @throws SceneError if mesh, sets, tissues, step or constraints cannot be used
  BuiltVariant(const Variant& variant, const MeshLoader& load);

  std::vector<ConstraintId> supports;                    ///< per variant.fixed
  std::vector<std::shared_ptr<Instrument>> instruments;  ///< per variant.tools, then per variant.instruments
  Simulation simulation;
  std::vector<std::shared_ptr<Capsule>> capsules;  ///< per variant.capsules
  std::shared_ptr<Container> container;            ///< null: none
  Probes probes;                                   ///< per variant.probes

 private:
  BuiltVariant(TetMesh mesh, const Variant& variant);
};
/// @throws SceneError, as BuiltVariant
BuiltVariant build_variant(const Variant& variant, const MeshLoader& load);

/// Time at which a variant's run ends [s]; infinite where only max_steps ends it.
double run_duration(const Variant& variant);

/// Builds and runs a variant to its end, or until `stop` is set.
///
/// The last step is the one that ends nearest to run_duration(). A sample is taken from the step that starts nearest
/// to each multiple of 1/sample_rate, and one more from the last step, so that the curve ends where the run does;
/// its time, depth, forces and energies are all of the instant at which that step starts. Frames are evenly spaced,
/// the first at rest, the last at the end.
/// @throws SceneError before the first step; after it, only what the observer throws
RunSummary run_variant(const Variant& variant, const MeshLoader& load, RunObserver& observer,
                       const std::atomic<bool>& stop);

}  // namespace glisson
