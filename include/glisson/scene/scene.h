// scene.h — experiments as TOML files: reading, checking against the schema, running.
#pragma once

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
#include <vector>

#include "glisson/scene/compare_spec.h"
#include "glisson/scene/variant.h"
#include "glisson/simulation/energy_watch.h"
#include "glisson/simulation/unloaded_shape.h"

namespace glisson {

/// A scene that cannot be used. what() has one line for each error, in the order of the file: `file:line:column: key:
/// error, value, allowed range, remedy`; for a value given to --set `file: --set KEY: …`.
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

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
  std::string column;  ///< of forces.csv or probes.csv, with heat also of temperature.csv or heat.csv
  std::string over;    ///< a column that it is divided by, line by line; empty: none
  At at = At::end;
  std::optional<double> expected;  ///< with a tolerance, in place of the bounds, which follow
  std::optional<double> tolerance,
      tolerance_percent;                    ///< one of them: in the unit of the column, or of what is expected
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
class HeatCoupling;

struct RunSummary {
  std::size_t vertices = 0, tets = 0;
  std::uint64_t steps = 0;
  double time_s = 0.0, step_s = 0.0, stable_step_s = 0.0, wall_s = 0.0, ns_per_tet_step = 0.0, peak_force_N = 0.0;
  Energies energies;
  std::optional<double> stored_energy_J{};  ///< at the end; none where a tissue's forces have no energy
  double energy_drift_most_J = 0.0;         ///< largest |energy_drift()| of the frames and the end; 0 where none
  /// Whether the body held more energy than was put into it, at samples and frames; none without track_energies.
  std::optional<EnergyGain> energy_gain{};
  double mass_added_kg = 0.0;  ///< by mass scaling
  std::optional<double>
      linear_share_mean{};             ///< Simulation::linear_share() over the steps; none unless precision is adaptive
  std::size_t inverted_tets_most = 0;  ///< largest number of tets inverted in one step
  double first_inversion_s = -1.0;     ///< time of it; −1: none
  std::uint64_t unmet_contact_steps = 0;  ///< in which contact of all tools could not be met (StepResult::contact_met)
  double first_unmet_contact_s = -1.0;    ///< time of the first; −1: none
  std::uint64_t state_hash = 0;
  std::string instruction_set{};              ///< of the element kernels; the hash is one of this set
  std::optional<UnloadedFigures> unloaded{};  ///< of Start::loaded
  std::vector<std::string> never_met{};       ///< instruments without a force or an event in a run that came to its end
  enum class End {
    finished,
    interrupted,
    stopped_inverted,
    stopped_unstable,
    stopped_not_finite,
    stopped_not_converged,
    stopped_not_held,
    stopped_energy,
    stopped_too_cold
  } end = End::finished;
  std::string trouble;  ///< why the last step was not made and what to do; empty if all were
};

template <>
inline constexpr Word<RunSummary::End> kWords<RunSummary::End>[] = {
    {"finished", RunSummary::End::finished},
    {"interrupted", RunSummary::End::interrupted, "interrupted"},
    {"stopped_inverted", RunSummary::End::stopped_inverted, "a tetrahedron inverted"},
    {"stopped_unstable", RunSummary::End::stopped_unstable, "the step has become too large; leave out step_s"},
    {"stopped_not_finite", RunSummary::End::stopped_not_finite, "a number is not finite"},
    {"stopped_not_converged", RunSummary::End::stopped_not_converged, "no equilibrium was found"},
    {"stopped_not_held", RunSummary::End::stopped_not_held, "supports and tools leave a rigid motion free"},
    {"stopped_energy", RunSummary::End::stopped_energy, "the body has ten times the energy that was put into it"},
    {"stopped_too_cold", RunSummary::End::stopped_too_cold, "a temperature is below absolute zero"}};

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

/// What was done to close the surfaces from files of a variant's body, a sentence with the file each (surface_repair.h).
std::vector<std::string> surface_repairs(const Variant& variant);

/// Tissue of each region number that occurs in a mesh made by build_mesh.
std::map<int, Tissue> region_tissues(const Variant& variant, const TetMesh& mesh);

/// The largest SimulationOptions::drag_stages with everything that acts on the body (Interaction::most_drag_stages).
int most_drag_stages(const Variant& variant);

/// The body of a variant with its supports, loads, instruments and probes, at rest; with Start::loaded in equilibrium at the places
/// that the mesh of the variant has. Places of the scene (sets, regions, aims, probes) are those of that mesh.
struct BuiltVariant {
  /// @throws SceneError if mesh, sets, tissues, step or constraints cannot be used, or it is of heat alone
  BuiltVariant(const Variant& variant, const MeshLoader& load);

  std::vector<ConstraintId> supports;                    ///< per variant.fixed
  std::vector<std::shared_ptr<Instrument>> instruments;  ///< per variant.tools, then per variant.instruments
  Simulation simulation;
  std::vector<std::shared_ptr<Capsule>> capsules;  ///< per variant.capsules
  std::shared_ptr<Container> container;            ///< null: none
  Probes probes;                                   ///< per variant.probes
  std::shared_ptr<HeatCoupling> heat;              ///< of [heat.ice] (heat_run.h); null: none
  std::optional<UnloadedFigures> unloaded;         ///< of Start::loaded; the simulation's mesh is the unloaded shape

 private:
  BuiltVariant(TetMesh mesh, const Variant& variant);
  BuiltVariant(TetMesh mesh, const std::optional<UnloadedShape>& unloaded, const Variant& variant);
  static std::optional<UnloadedShape> unload(const Variant& variant, const TetMesh& mesh);
};
/// @throws SceneError, as BuiltVariant
BuiltVariant build_variant(const Variant& variant, const MeshLoader& load);

/// Time at which a variant's run ends [s], one of heat too; infinite where only max_steps ends it.
double run_duration(const Variant& variant);

/// Builds and runs a variant to its end, or until `stop` is set.
///
/// The last step is the one that ends nearest to run_duration(). A sample is taken from the step that starts nearest
/// to each multiple of 1/sample_rate, and one more from the last step, so that the curve ends where the run does;
/// its time, depth, forces and energies are all of the instant at which that step starts. Frames are evenly spaced,
/// the first at rest, the last at the end. A run is `finished` only if every force, energy and displacement is finite; it ends where
/// the body holds ten times the energy that was put into it (EnergyWatch).
/// @throws SceneError before the first step; after it, only what the observer throws
RunSummary run_variant(const Variant& variant, const MeshLoader& load, RunObserver& observer,
                       const std::atomic<bool>& stop);

}  // namespace glisson
