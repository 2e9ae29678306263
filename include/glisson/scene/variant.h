// variant.h — one experiment of a scene: body, tissues, supports, loads, tools, instruments, and how it is run.
//
// The tables of a scene fill these structs (src/scene/parse/); a program may fill them itself.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "glisson/image/image_body.h"
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
#include "glisson/scene/heat_spec.h"
#include "glisson/scene/stiffness_image.h"
#include "glisson/simulation/probe.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

struct MeshFile {
  std::filesystem::path path;  ///< absolute, or relative to the current directory
  /// Factor on coordinates; none: metres, or millimetres where no organ is as large (glisson/io.h).
  std::optional<double> scale = 1.0;
};
using MeshSource = std::variant<BoxOptions, CylinderOptions, MeshFile, ImplicitBody, LiverOptions, ImageBody>;

// `origin` in the structs below is the place in the scene, `file:line:column: key`, for messages that need the mesh. It
// may be empty.

/// A point of the body at rest that is known once there is a mesh: the middle of its volume, or one of these.
struct BodyPoint {
  std::string region;          ///< name or number of a region, whose middle it is
  std::optional<Vec3d> point;  ///< given [m]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("region", &BodyPoint::region, "name or number of a region whose middle it is")
                    .otherwise("the middle of the body"),
                field("point", &BodyPoint::point, "m", "a point in its place").otherwise("the middle of the body"));
  }
};

/// Where an instrument starts: on the line through a point of the body along its direction.
struct AimSpec {
  BodyPoint at;
  std::optional<double> distance;  ///< of the tip from that point [m]; none: `clearance` before the surface
  double clearance = 0.005;        ///< of the instrument from where it meets the surface at rest [m]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(no_key("at", &AimSpec::at),
                field("distance", &AimSpec::distance, "mm", above(0),
                      "distance of the tip from that point at the start: a motion as deep ends there")
                    .otherwise("by `clearance_mm`"),
                field("clearance", &AimSpec::clearance, "mm", at_least(0),
                      "distance at the start from where it meets the surface at rest"));
  }
};

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
    double share = 0.0;  ///< of the body's extent along the axis, in place of a depth; 0: none
  };                     ///< within `depth` [m] of the lowest/highest vertex along an axis
  /// The `count` vertices of the surface nearest to where a line through a point of the body first meets it.
  struct Facing {
    Vec3d direction{0.0, 0.0, -1.0};  ///< of the line, of any length, into the body
    int count = 1;
    BodyPoint at;
  };
  struct Ids {
    std::vector<std::uint32_t> vertices;
  };
  std::variant<Box, Sphere, Nearest, Side, Ids, Facing> where;
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
/// A set that is held where it is, or moved by a record. Sets may share vertices, and a set and a tool too where they do not
/// contradict each other: a component is held once, and its force counts with the first set that names it.
struct FixedSpec {
  std::string set;
  Axes axes;
  Vec3d direction{0.0, 0.0, -1.0};   ///< of the depth of a record that has no places, of any length
  std::optional<RecordSpec> record;  ///< none: at rest
  std::string origin;
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

/// The path of a moved support, and its end; at rest without a record. @throws std::invalid_argument
ToolPath support_path(const FixedSpec& fixed);
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
  std::optional<AimSpec> aim;       ///< from which it comes instead, once there is a body
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
/// The same where its aim places it. @throws std::invalid_argument naming a region that is not there, a line that misses the body, a
/// tip that would start inside it
Pose start_pose(const InstrumentSpec& instrument, const TetMesh& mesh);
/// Its driver. That of a palpation moves over a plane through its tip, where no body is known; its end is the right one.
/// @throws std::invalid_argument
std::shared_ptr<ToolDriver> make_driver(const InstrumentSpec& instrument);
/// The same, with the body that a palpation feels and an aim is in. @throws std::invalid_argument as start_pose, naming a point of a
/// palpation that misses the body
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
  std::string tip;  ///< name of the instrument the distance of whose tip is read; empty: none
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

/// The state in which a run starts.
enum class Start {
  rest,   ///< the mesh is the body without loads
  loaded  ///< the mesh is the body in equilibrium under what acts on it at time 0 (find_unloaded_shape)
};
template <>
inline constexpr Word<Start> kWords<Start>[] = {
    {"rest", Start::rest, "the mesh is the body without loads; gravity acts from then on"},
    {"loaded", Start::loaded,
     "the mesh, as one of an image, is the body in equilibrium under gravity and the loads of time 0 on its supports; "
     "the shape without them is found before the run"}};

/// One complete experiment: a variant of a scene after expansion.
struct Variant {
  std::string name = "main";
  std::string label;
  MeshSource mesh;
  std::map<std::string, Selection> sets;
  Tissue tissue;
  std::vector<RegionSpec> regions;
  std::vector<StiffnessImage> stiffness;
  std::vector<FixedSpec> fixed;
  std::vector<LoadSpec> loads;
  std::vector<ToolSpec> tools;
  std::vector<InstrumentSpec> instruments;
  std::vector<CapsuleSpec> capsules;
  std::optional<ContainerSpec> container;
  std::vector<ProbeSpec> probes;
  std::optional<HeatSpec> heat;  ///< alone (is_heat_alone), or beside the mechanics
  SimulationOptions simulation;
  Start start = Start::rest;
  std::string start_origin;  ///< place of `start` in the scene
  OnInversion on_inversion = OnInversion::go_on;
  std::optional<double> duration;          ///< [s]; none: until the last motion has ended
  std::optional<std::uint64_t> max_steps;  ///< stops after that many steps
  OutputSpec output;
  std::string scene_name = "scene";  ///< the scene's file, for messages
};

/// Whether it has no mechanics: heat_run.h runs it.
inline bool is_heat_alone(const Variant& variant) { return variant.heat && !variant.heat->ice; }
/// Whether the tissue of the body or of some region passes a test.
template <class Test>
bool any_tissue(const Variant& variant, Test test) {
  return test(variant.tissue) || std::any_of(variant.regions.begin(), variant.regions.end(),
                                             [&](const RegionSpec& region) { return test(region.tissue); });
}
/// Whether a variant has Kelvin–Voigt viscosity.
inline bool is_viscous(const Variant& variant) {
  return any_tissue(variant, [](const Tissue& t) { return t.viscosity > 0.0; }) ||
         std::any_of(variant.stiffness.begin(), variant.stiffness.end(),
                     [](const StiffnessImage& image) { return !image.loss.empty(); });
}

}  // namespace glisson
