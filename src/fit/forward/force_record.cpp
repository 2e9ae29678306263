#include "fit/forward/force_record.h"

#include <algorithm>

namespace glisson::fit {

ForceRecord::ForceRecord(std::vector<double> times, std::vector<double> forces, bool rings) {
  if (times.empty()) return;
  if (rings && times.size() > 2) {
    sums_.assign(times.size(), 0.0);
    for (std::size_t i = 1; i < times.size(); ++i)
      sums_[i] = sums_[i - 1] + 0.5 * (forces[i] + forces[i - 1]) * (times[i] - times[i - 1]);
  }
  cubic_.emplace(std::move(times), std::move(forces));
}

double ForceRecord::at(double time, double run) const {
  if (sums_.empty()) return cubic_->at(time);
  const double half = std::min({0.01 * run, time - begin(), end() - time});
  if (half > 1e-9 * span()) return (sum(time + half) - sum(time - half)) / (2.0 * half);
  return time <= begin() ? cubic_->points().front()
                         : (time >= end() ? cubic_->points().back() : line(time, piece(time)));
}

std::size_t ForceRecord::piece(double time) const {
  const std::vector<double>& times = cubic_->times();
  const auto it = std::upper_bound(times.begin() + 1, times.end() - 1, time);
  return static_cast<std::size_t>(it - times.begin()) - 1;
}

double ForceRecord::line(double time, std::size_t i) const {
  const std::vector<double>&t = cubic_->times(), &f = cubic_->points();
  return f[i] + (f[i + 1] - f[i]) * (time - t[i]) / (t[i + 1] - t[i]);
}

double ForceRecord::sum(double time) const {
  const std::size_t i = piece(time);
  return sums_[i] + 0.5 * (cubic_->points()[i] + line(time, i)) * (time - cubic_->times()[i]);
}

}  // namespace glisson::fit
