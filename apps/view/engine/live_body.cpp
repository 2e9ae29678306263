// live_body.cpp — see live_body.h.
#include "view/engine/live_body.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/two_across.h"
#include "view/state/surface.h"

namespace glisson::view {
namespace {

constexpr double kShortestRamp = 0.002;  // over which a tool gathers speed [s]

/// Speed, ramp and farthest depth that a motion of the scene suggests.
struct Habit {
  double speed = 0.01, ramp = kShortestRamp;
  double depth = 0.0;

  void operator()(const PressMotion& m) {
    speed = m.velocity;
    ramp = std::max(ramp, m.ramp);
    depth = m.depth;
  }
  void operator()(const StrokesSpec& m) {
    speed = m.velocity;
    for (const StrokesSpec::One& s : m.strokes) depth = std::max(depth, s.depth);
  }
  void operator()(const PalpationSpec& m) { speed = m.velocity; }
  template <class Other>
  void operator()(const Other&) {}
};

ToolPath way_of(const std::shared_ptr<ToolDriver>& driver) {
  return ToolPath{{[driver](double t) { return driver->advance(t, 0.0, {}).position - driver->start().position; },
                   driver->corners()},
                  driver->end()};
}

/// The scene's way of an instrument; none where it is pushed. That of a palpation is known with the body (feel_the_body).
std::optional<ToolPath> scene_way(const InstrumentSpec& spec) {
  if (std::holds_alternative<PushSpec>(spec.motion.how)) return {};
  return way_of(make_driver(spec));
}

}  // namespace

LiveBody::LiveBody(const Variant& variant, const MeshLoader& load) : variant_(variant) {
  if (variant.tools.size() + variant.instruments.size() > kMostTools) {
    throw std::invalid_argument("glisson view leads " + std::to_string(kMostTools) + " tools at most; the scene has " +
                                std::to_string(variant.tools.size() + variant.instruments.size()));
  }
  variant_.simulation.track_energies = false;
  variant_.simulation.exact_steps = false;  // a search for h* takes more than a frame
  variant_.simulation.mesh_changes = true;
  lead_tools();
  lead_instruments();
  built_ = std::make_unique<BuiltVariant>(variant_, load);
  feel_the_body(variant);
  skin_ = std::make_shared<const SkinFaces>(built_->simulation.mesh());
  tissues_ = std::make_shared<const std::map<int, Tissue>>(region_tissues(variant_, built_->simulation.mesh()));
  const double size = diagonal(built_->simulation.mesh());
  for (ToolInfo& tool : tools_) {
    if (!(tool.most_depth > 0.0)) tool.most_depth = 0.4 * size;
    tool.least_depth = -0.25 * tool.most_depth;
  }
  attach_grab();
  take_blade();
}

void LiveBody::lead_tools() {
  for (ToolSpec& x : variant_.tools) {
    Habit habit;
    habit(x.motion);
    if (x.record) habit.depth = 0.0;
    ToolInfo info{.name = x.name, .direction = unit(x.motion.direction), .speed = habit.speed, .can_play = true};
    info.side = two_across(info.direction)[0];
    info.third = cross(info.direction, info.side);
    info.most_depth = 1.25 * habit.depth;
    ways_.push_back(std::make_shared<LivePath>(habit.speed, habit.ramp, tool_path(x)));
    x.path = ToolPath{[way = ways_.back()](double t) { return way->at(t); }, {}};
    tools_.push_back(info);
  }
}

void LiveBody::lead_instruments() {
  for (InstrumentSpec& x : variant_.instruments) {
    Habit habit;
    std::visit(habit, x.motion.how);
    ToolInfo info{.name = x.name, .instrument = true, .direction = unit(x.direction), .speed = habit.speed};
    const Pose start = start_pose(x);
    for (std::size_t i = 0; i < 3; ++i) {
      info.side[i] = start.axes(i, 0);
      info.third[i] = start.axes(i, 1);
    }
    info.most_depth = 1.25 * habit.depth;
    ways_.push_back(std::make_shared<LivePath>(habit.speed, habit.ramp, scene_way(x)));
    const bool turns =
        std::holds_alternative<RotationMotion>(x.motion.how) || std::holds_alternative<PosesSpec>(x.motion.how);
    info.can_play = !turns && ways_.back()->can_play();
    if (!turns) x.motion.how = ToolPath{[way = ways_.back()](double t) { return way->at(t); }, {}};
    tools_.push_back(info);
  }
}

/// Gives palpations their way: where they meet the body is known once there is one. @param scene  the variant as it was written
void LiveBody::feel_the_body(const Variant& scene) {
  for (std::size_t i = 0; i < scene.instruments.size(); ++i) {
    const InstrumentSpec& x = scene.instruments[i];
    if (!std::holds_alternative<PalpationSpec>(x.motion.how)) continue;
    ways_[scene.tools.size() + i]->set_scene(way_of(make_driver(x, built_->simulation.mesh())));
  }
}

void LiveBody::attach_grab() {
  auto grab = std::make_shared<GrabSpring>();
  try {
    built_->simulation.attach(grab);
    grab_ = grab;
  } catch (const std::invalid_argument&) {  // the integrator supports none
  }
}

void LiveBody::take_blade() {
  try {
    cut_ = std::make_unique<HandCut>(built_->simulation);
    uncut_ = cut_->keep();
  } catch (const std::exception& error) {
    why_no_cut_ = error.what();
  }
}

void LiveBody::work_on_cut(HandCut::Clock::time_point now) {
  if (cut_ && cut_->work(now)) ++hand_cuts_;
}

void LiveBody::reset() {
  if (grab_) grab_->let_go();
  built_->simulation.reset();
  built_->simulation.set_tissues(*tissues_);
  if (cut_) cut_->go_back(*uncut_);
  hand_cuts_ = 0;
  for (const auto& way : ways_) way->restart();
}

LiveBody::Kept LiveBody::keep() const {
  Kept kept{.state = built_->simulation.save_state(), .cut = {}, .hand_cuts = hand_cuts_, .ways = {}};
  if (cut_) kept.cut = cut_->keep();
  for (const auto& way : ways_) kept.ways.push_back(*way);
  return kept;
}

void LiveBody::go_back(const Kept& kept) {
  if (grab_) grab_->let_go();
  built_->simulation.load_state(kept.state);
  built_->simulation.set_tissues(*tissues_);
  if (cut_ && kept.cut) cut_->go_back(*kept.cut);
  hand_cuts_ = kept.hand_cuts;
  for (std::size_t i = 0; i < ways_.size(); ++i) *ways_[i] = kept.ways[i];
}

void LiveBody::set_tissues(const Variant& changed) {
  Simulation& simulation = built_->simulation;
  auto tissues = std::make_shared<const std::map<int, Tissue>>(region_tissues(changed, simulation.mesh()));
  simulation.set_tissues(*tissues);
  tissues_ = std::move(tissues);
  variant_.tissue = changed.tissue;
  variant_.regions = changed.regions;
}

std::array<double, 2> LiveBody::aside(std::size_t tool) const {
  const Vec3d way = ways_[tool]->at(built_->simulation.force_time());
  return {dot(way, tools_[tool].side), dot(way, tools_[tool].third)};
}

ToolState LiveBody::tool_state(std::size_t tool) const {
  const Instrument& x = instrument(tool);
  return {.depth = x.force_depth(),
          .aside = aside(tool),
          .force = x.force(),
          .line = x.centre_line(),
          .axes = x.pose().axes};
}

std::shared_ptr<const BodyShape> LiveBody::shape() const {
  auto shape = std::make_shared<BodyShape>();
  shape->mesh = built_->simulation.present_mesh();
  shape->marks.assign(shape->mesh.vertices.size(), 0);
  const auto mark = [&](const std::string& set, std::uint8_t value) {
    const auto found = built_->simulation.mesh().vertex_sets.find(set);
    if (found == built_->simulation.mesh().vertex_sets.end()) return;
    for (const std::uint32_t v : found->second) shape->marks[v] = value;
  };
  for (const FixedSpec& x : variant_.fixed) mark(x.set, 1);
  for (const ToolSpec& x : variant_.tools) mark(x.set, 2);
  shape->skin = skin_;
  shape->torn = torn_triangles(built_->capsules);
  return shape;
}

}  // namespace glisson::view
