// engine.cpp — see engine.h.
#include "view/engine/engine.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "report/instrument_json.h"
#include "report/json_text.h"
#include "view/state/surface.h"
#include "view/thread/kept_memory.h"

namespace glisson::view {
namespace {

using app::WallClock;

constexpr auto kPublishEvery = std::chrono::milliseconds(8);
constexpr auto kShapeEvery = std::chrono::milliseconds(100);  // of a body that is being cut
constexpr double kHandSpeed = 0.5;                            // of what is drawn, at most [m/s]
constexpr double kHandReach = 0.5;                            // of the body's size
constexpr double kPatch = 0.05;                               // radius of what is grabbed, of the body's size
constexpr std::size_t kMostUndone = 8;                        // strokes
constexpr double kHandStiffness = 4.0;  // of E times the patch's radius: stiffer than the tissue below it, 2 E a

Vec3d shortened(const Vec3d& v, double most) {
  const double length = norm(v);
  return length > most ? v * (most / length) : v;
}

/// At rest, of any tissue [Pa].
double youngs_modulus(const Tissue& tissue) {
  const auto [lambda, mu] = tissue.lame();
  return mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu);
}

}  // namespace

Engine::Engine(const Variant& variant, MeshLoader load) : load_(std::move(load)), variant_(variant) {
  body_ = std::make_unique<LiveBody>(variant_, load_);
  tools_ = body_->tools();
  handles_ = tissue_parameters(variant_);
  for (const TissueParameter& x : handles_) parameters_.push_back(x.info);
  for (const ParameterInfo& x : parameters_) values_.push_back(x.value);
  for (const ToolInfo& x : tools_) speeds_.push_back(x.speed);
  targets_.resize(tools_.size());
  forms_ = json_text(instrument_forms_json(body_->built().instruments));
  if (const auto& container = body_->built().container)
    vessel_ = json_text(vessel_json(container->options(), body_->built().simulation.mesh().vertices));
  can_grab_ = body_->grab() != nullptr;
  why_no_cut_ = body_->why_no_cut();
  const TetMesh& mesh = body_->built().simulation.mesh();
  vertices_ = mesh.vertices.size();
  tets_ = mesh.tets.size();
  reach_ = diagonal(mesh);
}

Engine::~Engine() { stop(); }

void Engine::start() {
  stop_ = false;
  thread_ = std::thread([this] { run(); });
}

void Engine::stop() {
  stop_ = true;
  inbox_.wake();
  if (thread_.joinable()) thread_.join();
}

void Engine::run() {
  app::keep_memory(app::memory_for_frames(body_->built().simulation.mesh().tets.size()));
  publish();
  app::FrameSchedule schedule(kFrame);
  measured_ = WallClock::now();
  while (!stop_.load(std::memory_order_relaxed)) {
    if (is_idle()) {
      inbox_.sleep(inbox_.is_watched() ? kPublishAtRest : kPublishUnwatched);
      schedule = app::FrameSchedule(kFrame);  // a rest is no delay of a frame
      guarded_turn(0);
      continue;
    }
    const std::uint64_t late = schedule.skip_late();
    schedule.wait();
    guarded_turn(late);
    if (restarted_) {  // making a body anew is no delay of a frame
      schedule = app::FrameSchedule(kFrame);
      restarted_ = false;
    }
  }
}

/// A fault of a turn holds the body and is told; commands go on, and a reset makes another body.
void Engine::guarded_turn(std::uint64_t late) {
  try {
    turn(late);
  } catch (const std::exception& error) {
    stopped_ = broken_ = true;
    notice_ =
        std::string("the simulation is paused after an internal error: ") + error.what() + "; Reset rebuilds the body";
  }
}

void Engine::turn(std::uint64_t late) {
  owes_ = apply_commands() || waits() || owes_;
  change_tissues();
  work_on_cut();
  if (!waits()) echo_ = received_;
  const bool moves = this->moves();
  if (moves) {
    dropped_ += late;
    frame();
  }
  frames_to_step_ = std::max(0, frames_to_step_ - 1);
  measure_pace();
  const auto since = WallClock::now() - published_;
  if (since >= (moves || owes_ ? WallClock::duration(kPublishEvery) : WallClock::duration(kPublishAtRest))) publish();
}

bool Engine::apply_commands() {
  std::vector<Command> asked;
  for (Command command; inbox_.pop(command);) asked.push_back(command);
  const auto remakes = [](const Command& x) { return x.kind == CommandKind::reset || x.kind == CommandKind::play; };
  const auto last = std::find_if(asked.rbegin(), asked.rend(), remakes);
  for (const Command& command : asked) {
    if (remakes(command) && &command != &*last) continue;  // the next one undoes it
    apply(command);
    if (command.sequence != 0) received_ = command.sequence;  // the server's own have none
  }
  return !asked.empty();
}

/// Whether a frame is to be computed.
bool Engine::moves() const { return !stopped_ && inbox_.is_watched() && (!paused_ || frames_to_step_ > 0); }

/// Whether commands that were received have not acted yet.
bool Engine::waits() const { return !wished_.empty() || (body_->cut() != nullptr && body_->cut()->waits()); }

void Engine::apply(const Command& command) {
  switch (command.kind) {
    case CommandKind::place:
    case CommandKind::speed:
      return apply_tool(command);
    case CommandKind::grab:
    case CommandKind::drag:
    case CommandKind::let_go:
      return apply_grab(command);
    case CommandKind::cut:
      return apply_cut(command);
    case CommandKind::pause:
      paused_ = command.index == 1;
      return;
    case CommandKind::step:
      frames_to_step_ += paused_ ? 1 : 0;
      return;
    case CommandKind::reset:
      return restart(false);
    case CommandKind::play:
      return restart(true);
    case CommandKind::undo:
      return undo();
    case CommandKind::parameter:
      if (command.index < parameters_.size()) wished_[command.index] = static_cast<double>(command.values[0]);
      return;
    case CommandKind::take:
    case CommandKind::give:
    case CommandKind::colour:
    case CommandKind::seek:
    case CommandKind::rate:
    case CommandKind::visible:
    case CommandKind::inside:
      return;  // the server's, a replay's
  }
}

void Engine::apply_tool(const Command& command) {
  if (command.tool >= tools_.size()) return;
  const ToolInfo& tool = tools_[command.tool];
  LivePath& way = body_->way(command.tool);
  if (command.kind == CommandKind::speed) {
    speeds_[command.tool] = static_cast<double>(command.values[0]);
    way.set_speed(speeds_[command.tool]);
    return;
  }
  const double depth = std::clamp(static_cast<double>(command.values[0]), tool.least_depth, tool.most_depth);
  const double side = std::clamp(static_cast<double>(command.values[1]), -reach_, reach_);
  const double third = std::clamp(static_cast<double>(command.values[2]), -reach_, reach_);
  targets_[command.tool] = tool.direction * depth + tool.side * side + tool.third * third;
  way.set_target(targets_[command.tool]);
}

void Engine::apply_grab(const Command& command) {
  GrabSpring* grab = body_->grab();
  if (grab == nullptr) return;
  if (command.kind == CommandKind::let_go) return grab->let_go();
  const Vec3d to{static_cast<double>(command.values[0]), static_cast<double>(command.values[1]),
                 static_cast<double>(command.values[2])};
  const Simulation& simulation = body_->built().simulation;
  if (command.kind == CommandKind::grab && command.index < simulation.mesh().vertices.size()) {
    const std::vector<Vec3d> at = simulation.positions();
    hand_at_ = at[command.index];
    hand_ = {};
    std::vector<std::uint32_t> patch = patch_around(simulation.mesh(), at, command.index, kPatch * reach_);
    const double stiffness = kHandStiffness * youngs_modulus(variant_.tissue) * kPatch * reach_;
    const GrabSpring::Hold how = command.tool == 1 ? GrabSpring::Hold::bonded : GrabSpring::Hold::springs;
    grab->hold(std::move(patch), simulation.displacement(), simulation.masses(), stiffness, how);
  }
  hand_target_ = shortened(to - hand_at_, kHandReach * reach_);
}

void Engine::apply_cut(const Command& command) {
  HandCut* cut = body_->cut();
  if (cut == nullptr) return;
  std::array<double, 6> x{};
  std::copy(command.values.begin(), command.values.end(), x.begin());
  const BladeEdge edge{{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
  if (command.index == 1) {
    if (strokes_.size() == kMostUndone) strokes_.pop_front();
    strokes_.push_back(body_->keep());
    cut->begin(edge);
  } else {
    cut->draw(edge);
  }
}

/// What the library refuses is told, and the body stays as it is.
void Engine::work_on_cut() {
  try {
    body_->work_on_cut(WallClock::now());
  } catch (const std::exception& error) {
    notice_ = error.what();
  }
}

/// The hand follows the mouse at a bounded speed: a jump of the mouse is no blow.
void Engine::draw_hand() {
  GrabSpring* grab = body_->grab();
  if (grab == nullptr || !grab->holds()) return;
  hand_ += shortened(hand_target_ - hand_, kHandSpeed * kFrame);
  grab->draw(hand_, kFrame);
}

/// Takes the body back to rest; one that an error has left behind is made anew, and where that cannot be, it goes on.
void Engine::restart(bool play) {
  try {
    if (broken_) {
      building_ = true;
      publish();
      building_ = false;
      body_ = std::make_unique<LiveBody>(variant_, load_);
    } else {
      body_->reset();
    }
  } catch (const std::exception& error) {
    building_ = false;
    notice_ = error.what();
    return;
  }
  broken_ = changed_ = false;
  strokes_.clear();
  std::fill(targets_.begin(), targets_.end(), Vec3d{});
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    body_->way(i).set_speed(speeds_[i]);
    body_->way(i).set_target(targets_[i]);
    if (play) body_->way(i).play();
  }
  take_up();
}

/// Back to before the last stroke of the blade.
void Engine::undo() {
  if (strokes_.empty()) {
    notice_ = "there is no stroke to undo";
    return;
  }
  try {
    body_->go_back(strokes_.back());
  } catch (const std::exception& error) {
    notice_ = error.what();
    return;
  }
  strokes_.pop_back();
  changed_ = true;  // a scene that begins at rest is not what was played
  for (std::size_t i = 0; i < tools_.size(); ++i) body_->way(i).set_target(targets_[i]);
  take_up();
}

/// Goes on from where the body is in time.
void Engine::take_up() {
  restarted_ = true;
  notice_.clear();
  ++epoch_;
  due_s_ = measured_time_ = body_->built().simulation.time();
  stopped_ = false;
  shape_.reset();
  measured_ = WallClock::now();
}

/// Numbers that have come since the last change, all at once; then the body has as long to itself as that took.
void Engine::change_tissues() {
  const WallClock::time_point begin = WallClock::now();
  if (wished_.empty() || begin < next_change_) return;
  Variant changed = variant_;
  std::vector<double> values = values_;
  for (const auto& [parameter, value] : wished_) values[parameter] = set_parameter(changed, handles_[parameter], value);
  wished_.clear();
  try {
    body_->set_tissues(changed);
    changed_ = changed_ || body_->built().simulation.steps() > 0;
    variant_ = std::move(changed);
    values_ = std::move(values);
    notice_.clear();
  } catch (const std::exception& error) {
    notice_ = error.what();
  }
  const WallClock::time_point end = WallClock::now();
  next_change_ = end + (end - begin);
}

void Engine::frame() {
  const WallClock::time_point begin = WallClock::now();
  for (std::size_t i = 0; i < tools_.size(); ++i) body_->way(i).plan(due_s_, kFrame);
  draw_hand();
  began_s_ = due_s_;
  due_s_ += kFrame;
  const app::AdvanceEnd advanced = app::advance_to(body_->built(), variant_.on_inversion, due_s_, stop_);
  take_sample();
  compute_.add(app::seconds_between(begin, WallClock::now()));
  ++frames_;
  if (advanced.end == RunSummary::End::finished || advanced.end == RunSummary::End::interrupted) return;
  stopped_ = true;
  notice_ = trouble_text(advanced, body_->built().simulation);
}

/// A frame that is over before the first step has no force yet; its way is recorded.
void Engine::take_sample() {
  const Simulation& simulation = body_->built().simulation;
  ForceSample sample{.epoch = epoch_, .frame_time = began_s_};
  for (std::size_t i = 0; i < tools_.size(); ++i) sample.way[i] = body_->way(i).at(began_s_);
  sample.grabbed = body_->grab() != nullptr && body_->grab()->holds();
  sample.changed = changed_;
  sample.cut = body_->cut() != nullptr && body_->cut()->area() > 0.0;
  if (simulation.steps() > 0) {
    sample.force_time = simulation.force_time();
    sample.time = static_cast<float>(sample.force_time);
    for (std::size_t i = 0; i < tools_.size(); ++i) {
      sample.depth[i] = static_cast<float>(body_->instrument(i).force_depth());
      sample.force[i] = static_cast<float>(dot(body_->instrument(i).force(), tools_[i].direction));
    }
  }
  samples_.push(sample);
}

void Engine::measure_pace() {
  const WallClock::time_point now = WallClock::now();
  const double passed = app::seconds_between(measured_, now);
  if (passed < 0.5) return;
  const double time = body_->built().simulation.time();
  realtime_factor_ = paused_ ? 0.0 : (time - measured_time_) / passed;
  measured_ = now;
  measured_time_ = time;
}

void Engine::fill_events(Snapshot& state) const {
  state.events.clear();
  for (const auto& instrument : body_->built().instruments) {
    for (const InstrumentEvent& x : instrument->events())
      state.events.push_back({instrument->name(), x.event, x.time, x.depth});
  }
  std::stable_sort(state.events.begin(), state.events.end(),
                   [](const LiveEvent& a, const LiveEvent& b) { return a.time < b.time; });
  const std::size_t before = state.events.size() > kEventsTold ? state.events.size() - kEventsTold : 0;
  state.events.erase(state.events.begin(), state.events.begin() + static_cast<std::ptrdiff_t>(before));
  state.events_before = static_cast<std::uint32_t>(before);
}

void Engine::publish() {
  const Simulation& simulation = body_->built().simulation;
  const WallClock::time_point now = WallClock::now();
  if (!shape_ || (shape_key_ != body_->shape_key() && now - shaped_ >= kShapeEvery)) {
    shape_ = body_->shape();
    shape_key_ = body_->shape_key();
    shaped_ = now;
    ++shape_number_;
  }
  Snapshot& state = latest_.back();
  state.epoch = epoch_;
  state.shape_number = shape_number_;
  state.frame = frames_;
  state.echo = echo_;
  state.time = simulation.time();
  state.realtime_factor = realtime_factor_;
  state.p50_us = 1e6 * compute_.percentile(0.5);
  state.p99_us = 1e6 * compute_.percentile(0.99);
  state.dropped = dropped_;
  state.paused = paused_;
  state.building = building_;
  state.stopped = stopped_;
  state.shape = shape_;
  state.tissues = body_->tissues();
  const std::span<const Vec3d> u = simulation.displacement(), v = simulation.velocity();
  state.displacement.assign(u.begin(), u.end());
  state.velocity.clear();
  state.branches = {};
  if (want_stress_.load(std::memory_order_relaxed)) {
    state.velocity.assign(v.begin(), v.end());
    state.branches = BranchRecord(simulation);
  }
  state.contact_pressure.clear();
  if (want_contact_.load(std::memory_order_relaxed)) state.contact_pressure = simulation.contact_fields().pressure;
  state.tools.resize(tools_.size());
  state.playing = false;
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    state.tools[i] = body_->tool_state(i);
    state.playing = state.playing || body_->way(i).playing();
  }
  const GrabSpring* grab = body_->grab();
  state.grabbing = grab != nullptr && grab->holds();
  state.grab_force = grab != nullptr ? grab->force() : Vec3d{};
  const HandCut* cut = body_->cut();
  state.cut_area = cut != nullptr ? cut->area() : 0.0;
  state.cut_longest = cut != nullptr ? cut->longest() : 0.0;
  state.parameters = values_;
  state.speeds = speeds_;
  fill_events(state);
  state.notice = notice_;
  latest_.publish();
  owes_ = false;
  published_ = WallClock::now();
}

}  // namespace glisson::view
