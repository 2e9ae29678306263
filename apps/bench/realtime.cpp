// realtime.cpp — see realtime.h.
#include "bench/realtime.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace glisson::app {
namespace {

using Clock = std::chrono::steady_clock;

/// A sleeping thread comes back up to this late: the rest of the wait is spun.
constexpr auto kSpin = std::chrono::microseconds(150);

double seconds_between(Clock::time_point a, Clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

void wait_until(Clock::time_point due) {
  std::this_thread::sleep_until(due - kSpin);
  while (Clock::now() < due) {
  }
}

class Pace {
 public:
  Pace(BuiltVariant& body, OnInversion on_inversion, double frame_s, const std::atomic<bool>& stop)
      : body_(body), on_inversion_(on_inversion), frame_s_(frame_s), stop_(stop), due_s_(body.simulation.time()) {}

  /// One frame of simulated time and the tool's force; false where the run has ended.
  bool frame(RealtimeResult& result);
  std::string news();

 private:
  bool step(RealtimeResult& result);

  BuiltVariant& body_;
  OnInversion on_inversion_;
  double frame_s_;
  const std::atomic<bool>& stop_;
  std::vector<std::size_t> seen_;  ///< events told, per instrument
  double due_s_;                   ///< simulated time that the last frame was to reach [s]
};

bool Pace::step(RealtimeResult& result) {
  using End = RunSummary::End;
  const StepStatus status = body_.step().status;
  if (status == StepStatus::step_too_large) result.end = End::stopped_unstable;
  if (status == StepStatus::not_finite) result.end = End::stopped_not_finite;
  if (status == StepStatus::inverted && on_inversion_ == OnInversion::stop) result.end = End::stopped_inverted;
  if (stop_.load(std::memory_order_relaxed)) result.end = End::interrupted;
  return result.end == End::finished;
}

bool Pace::frame(RealtimeResult& result) {
  due_s_ += frame_s_;
  while (body_.simulation.time() + 0.5 * body_.simulation.step_size() < due_s_) {
    if (!step(result)) return false;
  }
  if (!body_.tools.empty() && body_.simulation.steps() > 0) {
    result.peak_force_N = std::max(result.peak_force_N, norm(body_.simulation.force(body_.tools.front()).total()));
  } else if (!body_.instruments.empty()) {
    result.peak_force_N = std::max(result.peak_force_N, norm(body_.instruments.front()->forces().total()));
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
  const auto frame = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.frame_s));
  RealtimeResult result;
  result.compute_s.reserve(frames);
  Pace pace(body, on_inversion, options.frame_s, stop);
  const double simulated_from = body.simulation.time();
  const std::uint64_t steps_before = body.simulation.steps();
  const Clock::time_point start = Clock::now() + frame;
  for (std::uint64_t k = 0; k < frames && result.end == RunSummary::End::finished; ++k) {
    const auto passed = static_cast<std::uint64_t>(std::max<std::int64_t>(0, (Clock::now() - start) / frame));
    result.dropped += passed > k ? std::min(passed, frames) - k : 0;
    k = std::max(k, passed);
    if (k >= frames) break;
    wait_until(start + static_cast<std::int64_t>(k) * frame);
    const Clock::time_point begin = Clock::now();
    const bool whole = pace.frame(result);
    const double spent = seconds_between(begin, Clock::now());
    if (whole) result.compute_s.push_back(spent);
    if (std::string news = pace.news(); !news.empty()) result.eventful.push_back({std::move(news), spent});
  }
  if (result.end == RunSummary::End::finished) wait_until(start + static_cast<std::int64_t>(frames) * frame);
  result.wall_s = seconds_between(start, Clock::now());
  result.simulated_s = body.simulation.time() - simulated_from;
  result.steps = body.simulation.steps() - steps_before;
  return result;
}

}  // namespace glisson::app
