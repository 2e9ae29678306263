// course.h — a driven value over time, step by step: what tests of a material point have in common.
#pragma once

#include <span>
#include <string>

namespace glisson {

/// Values at times, with so many steps from each to the next.
struct Course {
  std::span<const double> times;   ///< [s]
  std::span<const double> values;  ///< one a time
  std::size_t between = 1;

  /// @param what  whose arguments they are
  /// @throws std::invalid_argument for lists of unequal lengths, times that do not ascend, or no steps
  void require_valid(const std::string& what) const;

  /// Calls go(h, value) for each step of h and arrived(k) at each time, from time 0 on; ends after the time before which go is false.
  /// A first time of 0 is reached within 10⁻⁹ of the second one, and without a step where nothing changes.
  /// @param value  at time 0
  template <class Go, class Arrived>
  void follow(double value, const Go& go, const Arrived& arrived) const {
    constexpr double kAtOnce = 1e-9;
    double time = 0.0;
    for (std::size_t k = 0; k < times.size(); ++k) {
      const bool at_once = times[k] == 0.0;
      const double way = at_once ? kAtOnce * (times.size() > 1 ? times[1] : 1.0) : times[k] - time;
      if (at_once && values[k] == value) {
        arrived(k);
        continue;
      }
      bool goes = true;
      for (std::size_t i = 1; i <= between && goes; ++i) {
        const double share = static_cast<double>(i) / static_cast<double>(between);
        goes = go(way / static_cast<double>(between), value + share * (values[k] - value));
      }
      arrived(k);
      if (!goes) return;
      value = values[k], time = at_once ? way : times[k];
    }
  }
};

}  // namespace glisson
