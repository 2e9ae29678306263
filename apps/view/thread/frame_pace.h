// frame_pace.h — a body stepped at the pace of a clock: which frame is due, and the steps that belong into it.
//
//   frame ──┬─ due ────────────────┬─ due ────────────────┬─
//           │ steps, force │ wait  │ steps, force │ wait  │   one frame of simulated time in each
//
// A frame that is ready late lets the next one start at once, so a short delay is made up; whole frames that are over
// before their turn are dropped, and the simulated time falls behind the clock by as much: trying to catch up would
// only make the next frame later still.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <limits>

#include "glisson/scene/scene.h"

namespace glisson::app {

using WallClock = std::chrono::steady_clock;

double seconds_between(WallClock::time_point a, WallClock::time_point b);

/// Sleeps, and spins for the last 150 µs: a sleeping thread comes back up to that late.
void wait_until(WallClock::time_point due);

/// Counts the frames of a clock.
class FrameSchedule {
 public:
  /// @param frame_s  [s], > 0; the first frame is due one frame from now
  explicit FrameSchedule(double frame_s);
  /// Passes over frames that are over before their turn. @param end  frames from this one on do not count
  /// @return how many
  std::uint64_t skip_late(std::uint64_t end = std::numeric_limits<std::uint64_t>::max());
  /// Number of the frame that comes next.
  std::uint64_t next() const { return next_; }
  /// Waits until it is due; the one after it comes next then.
  void wait();
  WallClock::time_point due(std::uint64_t frame) const { return start_ + static_cast<std::int64_t>(frame) * frame_; }

 private:
  WallClock::duration frame_;
  WallClock::time_point start_;
  std::uint64_t next_ = 0;
};

/// How steps to a time ended: `finished` where they got there.
struct AdvanceEnd {
  RunSummary::End end = RunSummary::End::finished;
  std::string trouble = {};       ///< as RunSummary::trouble
  std::size_t inverted_tets = 0;  ///< of the last step
};
/// What to say of an end of a body's motion; empty where nothing is wrong.
std::string trouble_text(const AdvanceEnd& end, const Simulation& simulation);

/// Steps until the step that ends nearest to a time [s].
AdvanceEnd advance_to(BuiltVariant& body, OnInversion on_inversion, double until, const std::atomic<bool>& stop);

}  // namespace glisson::app
