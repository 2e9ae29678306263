// percentile.h — order statistics of measured times.
#pragma once

#include <span>
#include <vector>

namespace glisson::app {

/// Nearest-rank percentile: the smallest value that at least `percent` of the values do not exceed.
/// @param percent  0 to 100; 100 is the maximum @throws std::invalid_argument for no values
double percentile(std::vector<double> values, double percent);

/// (p90 − p10) / p50: how far repetitions lie apart.
double relative_spread(std::span<const double> values);

}  // namespace glisson::app
