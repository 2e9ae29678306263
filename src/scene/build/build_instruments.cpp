// build_instruments.cpp — from what a scene says of instruments and membranes to those that act on the body.
#include "scene/build/build_instruments.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/nearest.h"
#include "glisson/instruments/driven_set.h"
#include "glisson/mesh.h"
#include "glisson/scene/body_places.h"
#include "scene/build/palpation.h"
#include "scene/build/select.h"

namespace glisson {
namespace {

Vec3d moving_direction(const InstrumentSpec& x) { return unit(x.motion.direction.value_or(x.direction)); }

/// A path or a push from each kind of motion.
struct DriverMaker {
  Pose start;
  Vec3d direction;
  std::vector<double> touches;  ///< of a palpation [m]; empty: none is known

  std::shared_ptr<ToolDriver> path(ToolPath path) const { return std::make_shared<PathDriver>(start, std::move(path)); }

  std::shared_ptr<ToolDriver> operator()(PressMotion m) const {
    m.direction = direction;
    return path(press_path(m));
  }
  std::shared_ptr<ToolDriver> operator()(SineMotion m) const {
    m.direction = direction;
    return path(sine_path(m));
  }
  std::shared_ptr<ToolDriver> operator()(const ToolPath& m) const { return path(m); }
  std::shared_ptr<ToolDriver> operator()(const StrokesSpec& m) const {
    StrokeMotion motion{.start = m.start, .strokes = {}};
    for (const StrokesSpec::One& s : m.strokes) {
      motion.strokes.push_back({.to = direction * s.depth + s.aside,
                                .velocity = s.velocity.value_or(m.velocity),
                                .ramp = s.ramp,
                                .rest = s.rest});
    }
    return path(stroke_path(motion));
  }
  std::shared_ptr<ToolDriver> operator()(const RecordSpec& m) const {
    RecordedMotion motion = m.motion;
    motion.start = m.start;
    return path(recorded_path(motion));
  }
  std::shared_ptr<ToolDriver> operator()(const RotationMotion& m) const {
    return std::make_shared<RigidDriver>(start, rotation_path(m));
  }
  std::shared_ptr<ToolDriver> operator()(const PosesSpec& m) const {
    return std::make_shared<RigidDriver>(start, poses_path(started(m)));
  }
  std::shared_ptr<ToolDriver> operator()(const PalpationSpec& m) const {
    std::vector<double> touch = touches;
    touch.resize(static_cast<std::size_t>(m.columns) * static_cast<std::size_t>(m.rows), 0.0);
    return path(stroke_path(scene::palpation_strokes(m, start, direction, touch)));
  }
  std::shared_ptr<ToolDriver> operator()(const PushSpec& m) const {
    PushMotion push = m.tool;
    push.direction = direction;
    const auto force = [m](double time) {
      const double t = time - m.start;
      if (t < 0.0) return 0.0;
      const double x = m.ramp > 0.0 ? std::min(1.0, t / m.ramp) : 1.0;
      return x * x * (3.0 - 2.0 * x) * (m.force + m.swing * std::sin(2.0 * std::numbers::pi * m.frequency * t));
    };
    push.force = {force, CornerTimes({m.start, m.start + m.ramp})};
    constexpr double kNoEnd = std::numeric_limits<double>::infinity();
    if (m.swing > 0.0) push.force.corners.add_every(0.5 / m.frequency, m.start + 0.25 / m.frequency, kNoEnd);
    if (m.duration) push.end = m.start + *m.duration;
    return std::make_shared<PushDriver>(start, push);
  }
};

/// The tissue's needs by region number.
std::map<int, TipResistance> by_number(const InstrumentSpec& x, const TetMesh& mesh) {
  std::map<int, TipResistance> numbers;
  for (const auto& [name, resistance] : x.regions) {
    const int number = scene::region_number(mesh, name);
    if (number < 0)
      throw std::invalid_argument("the mesh has no region \"" + name + "\"; `regions` names those it has");
    numbers[number] = resistance;
  }
  return numbers;
}

struct InstrumentMaker {
  const InstrumentSpec& spec;
  const TetMesh* mesh;  ///< null: there is no body yet

  std::shared_ptr<ToolDriver> driver() const { return mesh != nullptr ? make_driver(spec, *mesh) : make_driver(spec); }

  template <class Options>
  std::shared_ptr<Instrument> operator()(Options options) const {
    options.name = spec.name;
    options.direction = spec.direction;
    if constexpr (std::is_same_v<Options, NeedleOptions>) {
      options.bevel_side = spec.side;
      if (mesh != nullptr) options.regions = by_number(spec, *mesh);
    }
    return std::make_shared<typename Options::Instrument>(options, driver());
  }
  std::shared_ptr<Instrument> operator()(const OwnInstrument& make) const { return make(spec, driver()); }
};

}  // namespace

Fault StrokesSpec::check() const { return {strokes.empty() ? "is empty; give at least one stroke" : "", "strokes"}; }

Pose start_pose(const InstrumentSpec& x) {
  const Vec3d back = -unit(x.direction);
  const Vec3d side = unit(x.side - back * dot(x.side, back));
  const Vec3d third = cross(back, side);
  Pose pose;
  pose.position = x.tip;
  for (std::size_t i = 0; i < 3; ++i) {
    pose.axes(i, 0) = side[i];
    pose.axes(i, 1) = third[i];
    pose.axes(i, 2) = back[i];
  }
  return pose;
}

std::shared_ptr<ToolDriver> make_driver(const InstrumentSpec& x) {
  return std::visit(DriverMaker{start_pose(x), moving_direction(x), {}}, x.motion.how);
}

Pose start_pose(const InstrumentSpec& x, const TetMesh& mesh) {
  Pose pose = start_pose(x);
  if (x.aim) pose.position = aimed_tip(x, pose, mesh);
  return pose;
}

std::shared_ptr<ToolDriver> make_driver(const InstrumentSpec& x, const TetMesh& mesh) {
  const Vec3d direction = moving_direction(x);
  const Pose start = start_pose(x, mesh);
  std::vector<double> touches;
  if (std::holds_alternative<PalpationSpec>(x.motion.how)) {
    touches = scene::palpation_touches(x, start, direction, mesh);
  }
  return std::visit(DriverMaker{start, direction, std::move(touches)}, x.motion.how);
}

namespace scene {

std::shared_ptr<Instrument> make_instrument(const InstrumentSpec& spec, const TetMesh& mesh) {
  return std::visit(InstrumentMaker{spec, &mesh}, spec.what);
}

std::shared_ptr<Instrument> make_instrument(const InstrumentSpec& spec) {
  return std::visit(InstrumentMaker{spec, nullptr}, spec.what);
}

std::shared_ptr<Instrument> make_tool(const ToolSpec& spec, std::vector<std::uint32_t> vertices) {
  const Vec3d& d = spec.motion.direction;
  DrivenSetOptions options{.name = spec.name,
                           .vertices = std::move(vertices),
                           .direction = d,
                           .axes = spec.sideways_free ? Axes{d.x != 0.0, d.y != 0.0, d.z != 0.0} : Axes{},
                           .from = tool_start(spec)};
  if (auto turning = turning_path(spec)) {
    const Vec3d axis = spec.rotation ? spec.rotation->axis : Vec3d{};
    if (spec.axial_free) options.axes = {axis.x == 0.0, axis.y == 0.0, axis.z == 0.0};
    return std::make_shared<DrivenSet>(options, std::move(*turning), spec.rotation);
  }
  return std::make_shared<DrivenSet>(options, tool_path(spec));
}

std::shared_ptr<Capsule> make_capsule(const CapsuleSpec& spec, std::span<const std::uint32_t> set) {
  CapsuleOptions options = spec.options;
  options.vertices.assign(set.begin(), set.end());
  return std::make_shared<Capsule>(options);
}

void join(std::span<const std::shared_ptr<Instrument>> instruments,
          const std::vector<std::shared_ptr<Capsule>>& capsules) {
  if (capsules.empty()) return;
  for (const auto& instrument : instruments) {
    instrument->on_puncture([capsules](const Vec3d& place, double radius) {
      for (const auto& capsule : capsules) capsule->open_at(place, radius);
    });
  }
}

}  // namespace scene
}  // namespace glisson
