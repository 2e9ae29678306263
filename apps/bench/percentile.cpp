// percentile.cpp — see percentile.h.
#include "bench/percentile.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace glisson::app {

double percentile(std::vector<double> values, double percent) {
  if (values.empty()) throw std::invalid_argument("a percentile of no values");
  const double rank = std::ceil(0.01 * percent * static_cast<double>(values.size()));
  const auto at = static_cast<std::ptrdiff_t>(std::clamp(rank - 1.0, 0.0, static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

double relative_spread(std::span<const double> values) {
  const std::vector<double> all(values.begin(), values.end());
  return (percentile(all, 90.0) - percentile(all, 10.0)) / percentile(all, 50.0);
}

}  // namespace glisson::app
