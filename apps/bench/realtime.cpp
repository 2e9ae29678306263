// realtime.cpp — see realtime.h.
#include "bench/realtime.h"

#include <algorithm>
#include <cmath>

#include "bench/percentile.h"
#include "view/thread/kept_memory.h"

namespace glisson::app {
namespace {

class Pace {
 public:
  Pace(BuiltVariant& body, OnInversion on_inversion, double frame_s, const std::atomic<bool>& stop)
      : body_(body), on_inversion_(on_inversion), frame_s_(frame_s), stop_(stop), due_s_(body.simulation.time()) {}

  /// One frame of simulated time and the tool's force; false where the run has ended.
  bool frame(RealtimeResult& result);
  std::string news();

 private:
  BuiltVariant& body_;
  OnInversion on_inversion_;
  double frame_s_;
  const std::atomic<bool>& stop_;
  std::vector<std::size_t> seen_;  ///< events told, per instrument
  double due_s_;                   ///< simulated time that the last frame was to reach [s]
};

bool Pace::frame(RealtimeResult& result) {
  due_s_ += frame_s_;
  result.end = advance_to(body_, on_inversion_, due_s_, stop_);
  if (result.end.end != RunSummary::End::finished) return false;
  if (!body_.instruments.empty()) {
    result.peak_force_N = std::max(result.peak_force_N, norm(body_.instruments.front()->force()));
  }
  return true;
}

/// What instruments have met since the last call, separated by commas.
std::string Pace::news() {
  std::string text;
  seen_.resize(body_.instruments.size(), 0);
  for (std::size_t i = 0; i < body_.instruments.size(); ++i) {
    const std::vector<InstrumentEvent>& events = body_.instruments[i]->events();
    for (; seen_[i] < events.size(); ++seen_[i]) text += (text.empty() ? "" : ", ") + events[seen_[i]].event;
  }
  return text;
}

}  // namespace

RealtimeResult run_realtime(BuiltVariant& body, OnInversion on_inversion, const RealtimeOptions& options,
                            const std::atomic<bool>& stop) {
  const auto frames = static_cast<std::uint64_t>(std::max(1.0, std::round(options.seconds / options.frame_s)));
  RealtimeResult result;
  result.compute_s.reserve(frames), result.frame_steps.reserve(frames);
  keep_memory(memory_for_frames(body.simulation.mesh().tets.size()));
  Pace pace(body, on_inversion, options.frame_s, stop);
  const double simulated_from = body.simulation.time();
  const std::uint64_t steps_before = body.simulation.steps();
  FrameSchedule schedule(options.frame_s);
  const WallClock::time_point start = schedule.due(0);
  while (schedule.next() < frames && result.end.end == RunSummary::End::finished) {
    result.dropped += schedule.skip_late(frames);
    if (schedule.next() >= frames) break;
    schedule.wait();
    const std::uint64_t steps = body.simulation.steps();
    const WallClock::time_point begin = WallClock::now();
    const bool whole = pace.frame(result);
    const double spent = seconds_between(begin, WallClock::now());
    const std::size_t frame = result.compute_s.size();
    if (whole) result.compute_s.push_back(spent), result.frame_steps.push_back(body.simulation.steps() - steps);
    if (std::string news = pace.news(); !news.empty()) result.eventful.push_back({std::move(news), frame, spent});
  }
  if (result.end.end == RunSummary::End::finished) wait_until(schedule.due(frames));
  result.wall_s = seconds_between(start, WallClock::now());
  result.simulated_s = body.simulation.time() - simulated_from;
  result.steps = body.simulation.steps() - steps_before;
  return result;
}

RealtimeFigures figures_of(const RealtimeResult& result, double frame_s) {
  RealtimeFigures f{.frames = result.compute_s.size()};
  if (f.frames == 0) return f;
  f.p50_us = 1e6 * percentile(result.compute_s, 50.0);
  f.p99_us = 1e6 * percentile(result.compute_s, 99.0);
  f.p999_us = 1e6 * percentile(result.compute_s, 99.9);
  f.max_us = 1e6 * percentile(result.compute_s, 100.0);
  f.missed = static_cast<std::size_t>(
      std::count_if(result.compute_s.begin(), result.compute_s.end(), [&](double s) { return s > frame_s; }));
  f.most_steps = *std::ranges::max_element(result.frame_steps);
  f.steps_per_frame = static_cast<double>(result.steps) / static_cast<double>(f.frames);
  f.realtime_factor = result.simulated_s / result.wall_s;
  return f;
}

}  // namespace glisson::app
