// stopwatch.h — time by the clock.
#pragma once

#include <chrono>

namespace glisson::models {

class Stopwatch {
 public:
  /// Since it was made or asked last [s].
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - begin_).count();
    begin_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace glisson::models
