#include "material/root_series.h"

#include <algorithm>
#include <cmath>

namespace glisson {
namespace {

/// How far the series are from 1/√(1 + x) and Σ √(1 + x) − 3, over δ.
double error_at(const RootSeries<>& series, double delta) {
  double most = 0.0;
  for (const std::array<double, 3>& x : shapes_of(delta)) {
    const double J2 = 0.75 * delta * delta, J3 = x[0] * x[1] * x[2];
    const double whole = series_at(series.whole, J2, J3), first = series_at(series.first, J2, J3);
    const double second = series_at(series.second, J2, J3);
    double sum = -3.0;
    for (const double xi : x) {
      const double inverse = 1.0 + whole + first * xi + second * (xi * xi - J2);
      most = std::max(most, std::abs(inverse - 1.0 / std::sqrt(1.0 + xi)));
      sum += std::sqrt(1.0 + xi);
    }
    most = std::max(most, std::abs(sum - series_at(series.trace, J2, J3)));
  }
  return most / delta;
}

}  // namespace

RootSeries<> root_series() {
  const TensorPower inverse = tensor_power(-0.5), root = tensor_power(0.5);
  InvariantSeries<> J2{};
  J2[0][1] = 1.0;
  RootSeries<> out;
  out.whole = sum_of(inverse.whole, product_of(J2, inverse.second));
  out.first = inverse.first, out.second = inverse.second;
  // tr X² = 2 J₂
  out.trace = sum_of(sum_of({}, root.whole, 3.0), product_of(J2, root.second), 2.0);
  constexpr double kMostError = 1e-7, kFarthest = 0.5, kCloser = 0.98;
  double delta = kFarthest;
  while (error_at(out, delta) > kMostError) delta *= kCloser;  // ends: the error falls as δ¹⁴
  out.largest_J2 = 0.75 * delta * delta;
  return out;
}

const RootSeries<float>& lane_root_series() {
  static const RootSeries<float> series = [] {
    const RootSeries<> exact = root_series();
    return RootSeries<float>{rounded(exact.whole), rounded(exact.first), rounded(exact.second), rounded(exact.trace),
                             float(exact.largest_J2)};
  }();
  return series;
}

}  // namespace glisson
