// realtime.h — a body stepped at the pace of a clock, as a program with a haptic device would.
// frame_pace.h says how frames that are late are made up or dropped.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "glisson/scene/scene.h"
#include "view/thread/frame_pace.h"

namespace glisson::app {

struct RealtimeOptions {
  double seconds = 10.0;   ///< wall time [s], > 0
  double frame_s = 0.001;  ///< [s], > 0
};

struct RealtimeResult {
  std::vector<double> compute_s;           ///< steps and force of each frame that was computed [s]
  std::vector<std::uint64_t> frame_steps;  ///< of each of those
  std::uint64_t dropped = 0;               ///< frames that were over before their turn
  std::uint64_t steps = 0;
  double wall_s = 0.0, simulated_s = 0.0;
  double peak_force_N = 0.0;  ///< of the first tool or instrument, of those read once a frame
  /// Frames in which an instrument met something: a puncture is the dearest moment of a run.
  struct Eventful {
    std::string events;     ///< separated by commas
    std::size_t frame = 0;  ///< among those that were computed
    double compute_s = 0.0;
  };
  std::vector<Eventful> eventful;
  AdvanceEnd end;
};

/// What the frames of a run took.
struct RealtimeFigures {
  double p50_us = 0.0, p99_us = 0.0, p999_us = 0.0, max_us = 0.0;
  std::size_t frames = 0, missed = 0;  ///< those that took longer than a frame
  double steps_per_frame = 0.0, realtime_factor = 0.0;
  std::uint64_t most_steps = 0;  ///< of a frame
};

RealtimeFigures figures_of(const RealtimeResult& result, double frame_s);

/// @param body  moves from its present time on
RealtimeResult run_realtime(BuiltVariant& body, OnInversion on_inversion, const RealtimeOptions& options,
                            const std::atomic<bool>& stop);

}  // namespace glisson::app
