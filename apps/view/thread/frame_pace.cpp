// frame_pace.cpp — see frame_pace.h.
#include "view/thread/frame_pace.h"

#include <algorithm>
#include <thread>

#include "report/summary_json.h"

namespace glisson::app {
namespace {

constexpr auto kSpin = std::chrono::microseconds(150);

}  // namespace

double seconds_between(WallClock::time_point a, WallClock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

void wait_until(WallClock::time_point due) {
  std::this_thread::sleep_until(due - kSpin);
  while (WallClock::now() < due) {
  }
}

FrameSchedule::FrameSchedule(double frame_s)
    : frame_(std::chrono::duration_cast<WallClock::duration>(std::chrono::duration<double>(frame_s))),
      start_(WallClock::now() + frame_) {}

std::uint64_t FrameSchedule::skip_late(std::uint64_t end) {
  const auto passed = static_cast<std::uint64_t>(std::max<std::int64_t>(0, (WallClock::now() - start_) / frame_));
  if (passed <= next_) return 0;
  const std::uint64_t dropped = std::min(passed, end) - std::min(next_, end);
  next_ = passed;
  return dropped;
}

void FrameSchedule::wait() { wait_until(due(next_++)); }

std::string trouble_text(const AdvanceEnd& end, const Simulation& simulation) {
  RunSummary summary;
  summary.end = end.end;
  summary.trouble = end.trouble;
  summary.inverted_tets_most = end.inverted_tets;
  summary.time_s = simulation.time();
  return glisson::trouble_text(summary);
}

AdvanceEnd advance_to(BuiltVariant& body, OnInversion on_inversion, double until, const std::atomic<bool>& stop) {
  while (body.simulation.time() + 0.5 * body.simulation.step_size() < until) {
    const StepResult step = body.simulation.step();
    const RunSummary::End end = end_of(step.status, on_inversion);
    if (end != RunSummary::End::finished) return {end, std::string(step.message), step.inverted_tets.size()};
    if (stop.load(std::memory_order_relaxed)) return {.end = RunSummary::End::interrupted};
  }
  return {};
}

}  // namespace glisson::app
