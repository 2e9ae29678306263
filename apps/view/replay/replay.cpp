// replay.cpp — see replay.h.
#include "view/replay/replay.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include <nlohmann/json.hpp>

#include "glisson/io.h"
#include "report/instrument_json.h"
#include "report/json_text.h"

namespace glisson::view {
namespace {

using app::WallClock;

constexpr auto kTurn = std::chrono::milliseconds(12);

/// The speed at which a run lasts nearest to four seconds; 1 where it lasts a few anyway. The page offers the same ones.
double preferred_rate(double duration) {
  if (!(duration > 0.0) || (duration >= 1.0 && duration <= 8.0)) return 1.0;
  constexpr std::array kRates{0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 25.0, 100.0};
  const auto off = [&](double rate) { return std::abs(std::log(4.0 * rate / duration)); };
  return *std::min_element(kRates.begin(), kRates.end(), [&](double a, double b) { return off(a) < off(b); });
}

/// Values between those of two frames.
void mix(std::vector<double>& values, const std::vector<double>& next, double share) {
  if (next.size() != values.size()) return;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] += (next[i] - values[i]) * share;
}

/// A vessel with a wall without end as reports draw it.
std::string with_height(const std::string& form, const std::vector<Vec3d>& vertices) {
  if (form.empty()) return form;
  nlohmann::json vessel = nlohmann::json::parse(form);
  if (!vessel["height_m"].is_null()) return form;
  const auto origin = vessel["origin"].get<std::array<double, 3>>();
  const auto axes = vessel["axes"].get<std::array<double, 9>>();
  vessel["height_m"] = drawn_wall_height({origin[0], origin[1], origin[2]}, {axes[2], axes[5], axes[8]}, vertices);
  return json_text(vessel);
}

static_assert(kReplaySamples < 8192, "the ring takes them all at once");

}  // namespace

Replay::Replay(RunFolder run) : run_(std::move(run)), frames_(run_) {
  recorded_ = {run_.frames.front().time, run_.frames.back().time, run_.frames.size()};
  time_ = recorded_.start;
  rate_ = preferred_rate(recorded_.end - recorded_.start);
  shown_ = frames_.at(0, true);
  has_stress_ = !shown_->pressure.empty() && !shown_->von_mises.empty();
  run_.vessel = with_height(run_.vessel, shown_->shape->mesh.vertices);
  vertices_ = shown_->shape->mesh.vertices.size();
  tets_ = shown_->shape->mesh.tets.size();
  for (const ForceLine& line : thinned(run_.forces, kReplaySamples)) {
    ForceSample sample{.epoch = 0, .time = static_cast<float>(line.time)};
    for (std::size_t k = 0; k < kMostTools; ++k) {
      sample.depth[k] = static_cast<float>(line.depth[k]);
      sample.force[k] = static_cast<float>(line.force[k]);
    }
    samples_.push(sample);
  }
}

Replay::~Replay() { stop(); }

void Replay::start() {
  stop_ = false;
  thread_ = std::thread([this] { run(); });
}

void Replay::stop() {
  stop_ = true;
  inbox_.wake();
  if (thread_.joinable()) thread_.join();
}

void Replay::show(double time) {
  seek(time);
  publish();
}

void Replay::run() {
  publish();
  WallClock::time_point last = WallClock::now(), published = last;
  while (!stop_.load(std::memory_order_relaxed)) {
    const bool watched = inbox_.is_watched(), rests = paused_ || !watched;
    if (rests) {
      inbox_.sleep(watched ? kPublishAtRest : kPublishUnwatched);
    } else {
      std::this_thread::sleep_until(last + kTurn);
    }
    const WallClock::time_point now = WallClock::now();
    const double passed = rests ? 0.0 : app::seconds_between(last, now);
    last = now;
    const bool asked = apply_commands(), moved = advance(passed);
    if (!asked && !moved && now - published < kPublishAtRest) continue;
    publish();
    published = now;
  }
}

bool Replay::apply_commands() {
  bool any = false;
  for (Command command; inbox_.pop(command); any = true) {
    apply(command);
    echo_ = command.sequence;
  }
  return any;
}

void Replay::apply(const Command& command) {
  switch (command.kind) {
    case CommandKind::pause:
      paused_ = command.index == 1;
      if (!paused_ && time_ >= recorded_.end) time_ = recorded_.start;
      return;
    case CommandKind::step: {
      const std::size_t next = std::min(frame_before(time_) + 1, run_.frames.size() - 1);
      paused_ = true;
      return seek(run_.frames[next].time);
    }
    case CommandKind::reset:
      paused_ = true;
      return seek(recorded_.start);
    case CommandKind::play:
      paused_ = false;
      return seek(recorded_.start);
    case CommandKind::seek:
      return seek(static_cast<double>(command.values[0]));
    case CommandKind::rate:
      rate_ = static_cast<double>(command.values[0]);
      return;
    default:
      return;  // a recording cannot be pulled or pushed
  }
}

void Replay::seek(double time) { time_ = std::clamp(time, recorded_.start, recorded_.end); }

bool Replay::advance(double passed) {
  if (paused_) return false;
  time_ += rate_ * passed;
  if (time_ < recorded_.end) return true;
  time_ = recorded_.end;
  paused_ = true;
  return true;
}

/// The last frame that is not later than a time.
std::size_t Replay::frame_before(double time) const {
  const auto after = std::upper_bound(run_.frames.begin(), run_.frames.end(), time,
                                      [](double t, const RunFrame& frame) { return t < frame.time; });
  return after == run_.frames.begin() ? 0 : static_cast<std::size_t>(after - run_.frames.begin()) - 1;
}

/// The nearest frame before one that can be read; the first could be when the replay was made.
std::shared_ptr<const LoadedFrame> Replay::readable_before(std::size_t frame) {
  while (frame > 0) {
    try {
      return frames_.at(--frame);
    } catch (const std::exception&) {
    }
  }
  return shown_;
}

/// What cannot be read is told, and the frame before it stands.
void Replay::show_body(Snapshot& state) {
  const std::size_t before = frame_before(time_), after = std::min(before + 1, run_.frames.size() - 1);
  const double span = run_.frames[after].time - run_.frames[before].time;
  const double share = span > 0.0 ? (time_ - run_.frames[before].time) / span : 0.0;
  const bool fields = want_fields_.load();
  std::shared_ptr<const LoadedFrame> next;
  const WallClock::time_point begin = WallClock::now();
  try {
    notice_.clear();
    shown_ = frames_.at(before, fields);
    if (share > 0.0) next = frames_.at(after, fields);
  } catch (const std::exception& error) {  // a forged frame may be anything but a file that cannot be read
    notice_ = std::string(error.what()) + "; the frame before it is shown.";
    if (!frames_.has(before)) shown_ = readable_before(before);
  }
  reading_.add(app::seconds_between(begin, WallClock::now()));
  if (shown_->shape != shape_) {
    shape_ = shown_->shape;
    ++shape_number_;
  }
  state.shape = shape_;
  state.shape_number = shape_number_;
  state.displacement = shown_->displacement;
  state.pressure = fields ? shown_->pressure : std::vector<double>();
  state.von_mises = fields ? shown_->von_mises : std::vector<double>();
  state.contact_pressure = fields ? shown_->contact_pressure : std::vector<double>();
  if (!next || next->shape != shape_) return;
  for (std::size_t v = 0; v < state.displacement.size(); ++v)
    state.displacement[v] += (next->displacement[v] - state.displacement[v]) * share;
  mix(state.pressure, next->pressure, share);
  mix(state.von_mises, next->von_mises, share);
  mix(state.contact_pressure, next->contact_pressure, share);
}

void Replay::show_tools(Snapshot& state) const {
  const std::size_t before = frame_before(time_), after = std::min(before + 1, run_.frames.size() - 1);
  const RunFrame &a = run_.frames[before], &b = run_.frames[after];
  const double share = b.time > a.time ? (time_ - a.time) / (b.time - a.time) : 0.0;
  const ForceLine line = run_.forces.empty() ? ForceLine{} : forces_at(run_.forces, time_);
  state.tools.assign(run_.tools.size(), {});
  std::size_t instrument = 0;
  for (std::size_t i = 0; i < run_.tools.size(); ++i) {
    ToolState& tool = state.tools[i];
    tool = {.depth = 0.0, .aside = {}, .force = {}, .line = {}, .axes = identity<double>()};
    if (run_.tools[i].instrument) {
      const std::size_t k = instrument++;
      if (k < a.instruments.size()) tool = a.instruments[k];
      const bool moves = k < b.instruments.size() && b.instruments[k].line.size() == tool.line.size();
      for (std::size_t p = 0; moves && p < tool.line.size(); ++p)
        tool.line[p] += (b.instruments[k].line[p] - tool.line[p]) * share;
    }
    tool.depth = line.depth[i];
    tool.force = run_.tools[i].direction * line.force[i];
  }
}

void Replay::publish() {
  Snapshot& state = latest_.back();
  show_body(state);
  show_tools(state);
  state.frame = ++published_;
  state.echo = echo_;
  state.time = time_;
  state.realtime_factor = rate_;
  state.p50_us = 1e6 * reading_.percentile(0.5);
  state.p99_us = 1e6 * reading_.percentile(0.99);
  state.paused = paused_;
  state.playing = !paused_;
  state.events.clear();
  for (const LiveEvent& event : run_.events) {
    if (event.time <= time_) state.events.push_back(event);
  }
  const std::size_t more = state.events.size() > kEventsTold ? state.events.size() - kEventsTold : 0;
  state.events.erase(state.events.begin(), state.events.begin() + static_cast<std::ptrdiff_t>(more));
  state.events_before = static_cast<std::uint32_t>(more);
  state.notice = run_.notice + (run_.notice.empty() || notice_.empty() ? "" : "\n") + notice_;
  latest_.publish();
}

}  // namespace glisson::view
