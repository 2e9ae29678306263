#include "glisson/time_function.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glisson {

CornerTimes::CornerTimes(std::vector<double> times) : times_(std::move(times)) {
  std::sort(times_.begin(), times_.end());
}

CornerTimes CornerTimes::with(const CornerTimes& others) const {
  CornerTimes both = *this;
  both.times_.insert(both.times_.end(), others.times_.begin(), others.times_.end());
  std::sort(both.times_.begin(), both.times_.end());
  both.rows_.insert(both.rows_.end(), others.rows_.begin(), others.rows_.end());
  return both;
}

double CornerTimes::after(double time) const {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const auto next = std::upper_bound(times_.begin(), times_.end(), time);
  double first = next == times_.end() ? kNone : *next;
  for (const Row& row : rows_) {
    double corner = row.first;
    if (corner <= time) {  // the quotient may round either way
      const double passed = std::floor((time - row.first) / row.period);
      corner = row.first + passed * row.period;
      while (corner <= time) corner += row.period;
    }
    if (corner <= row.last) first = std::min(first, corner);
  }
  return first;
}

}  // namespace glisson
