// compute_times.h — what the last frames took, for the figures on the page.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace glisson::view {

/// About a second of frames of 1 ms.
class ComputeTimes {
 public:
  void add(double seconds) { seconds_[count_++ % kKept] = seconds; }
  /// The time that this share of the frames kept within [s]; 0 where there is none yet. @param share  0 … 1
  double percentile(double share) const {
    const std::size_t kept = std::min(count_, kKept);
    if (kept == 0) return 0.0;
    std::array<double, kKept> sorted = seconds_;
    const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(kept - 1));
    std::nth_element(sorted.begin(), sorted.begin() + place, sorted.begin() + static_cast<std::ptrdiff_t>(kept));
    return sorted[static_cast<std::size_t>(place)];
  }

 private:
  static constexpr std::size_t kKept = 1024;
  std::array<double, kKept> seconds_{};
  std::size_t count_ = 0;
};

}  // namespace glisson::view
