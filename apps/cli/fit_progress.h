// fit_progress.h — how far a fit is: one live line on a terminal, plain lines in a pipe.
#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "fit/run_fit.h"

namespace glisson::app {

class FitProgressLine {
 public:
  explicit FitProgressLine(bool quiet);
  /// Safe to call from any thread.
  void show(const fit::FitProgress& progress);
  /// A line of its own. @param threads  that runs are spread over
  void show(const fit::FitForecast& forecast, int threads);
  /// Takes the live line away.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  std::string text(const fit::FitProgress& progress) const;

  std::mutex mutex_;
  bool quiet_, live_;
  std::string stage_;  ///< law and stage of the last call
  std::size_t first_ = 0;
  Clock::time_point begin_, said_;
};

}  // namespace glisson::app
