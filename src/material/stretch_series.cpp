// stretch_series.cpp — the coefficients of stretch_series.h, how far they hold and how stiff tissue is there.
#include "material/stretch_series.h"

#include <algorithm>
#include <cmath>

#include "material/stiffness_bound.h"

namespace glisson {
namespace {

/// Adds 2 μ/α det(I + X)^(−a/3) times what X and X² have in (I + X)^a, a = α/2.
void add_term(double mu, double alpha, StretchSeries<>& out) {
  const TensorPower power = tensor_power(0.5 * alpha);
  const InvariantSeries<> isochoric = determinant_power(-alpha / 6.0);
  out.first = sum_of(out.first, product_of(power.first, isochoric), 2.0 * mu / alpha);
  out.second = sum_of(out.second, product_of(power.second, isochoric), 2.0 * mu / alpha);
}

/// How far the series are from the law, over Σ |μ| δ.
double error_at(const Ogden& law, const StretchSeries<>& series, double delta) {
  double most = 0.0, scale = 0.0;
  for (const double mu : law.mu) scale += std::abs(mu) * delta;
  for (const std::array<double, 3>& x : shapes_of(delta)) {
    const std::array<double, 3> l{0.5 * std::log1p(x[0]), 0.5 * std::log1p(x[1]), 0.5 * std::log1p(x[2])};
    const double mean = (l[0] + l[1] + l[2]) / 3.0;
    const std::array<double, 3> t = law.slopes(std::array<double, 3>{l[0] - mean, l[1] - mean, l[2] - mean});
    const double J2 = 0.75 * delta * delta, J3 = x[0] * x[1] * x[2];
    const double q1 = series_at(series.first, J2, J3), q2 = series_at(series.second, J2, J3);
    for (std::size_t i = 0; i < 3; ++i) {
      const double sum = q1 * x[i] + q2 * (x[i] * x[i] - 2.0 / 3.0 * J2);
      most = std::max(most, std::abs(sum - t[i]) / scale);
    }
  }
  return most;
}

/// λ_max of the tangent of the isochoric part where m = 1 [Pa].
double stiffness_at(const Ogden& law, const std::array<double, 3>& x) {
  const auto stretch = [&](std::size_t i) { return std::sqrt(1.0 + x[i]) - 1.0; };
  return stretch_bound(law, {stretch(0), stretch(1), stretch(2)});
}

/// b₁ is the slope of the tangent's largest eigenvalue at rest, b₃ the difference of its bend between one long axis and one
/// short axis, and b₂ what the states up to δ = `largest` need.
/// @return how far the bound is above the eigenvalue, as a factor
double set_bound(const Ogden& law, double largest, StretchSeries<>& out) {
  const double rest = stiffness_at(law, {0.0, 0.0, 0.0});
  double mean = 0.0;
  for (std::size_t k = 0; k < law.mu.size(); ++k) mean += 0.5 * law.mu[k] * law.alpha[k] / law.shear_modulus();
  const double slope = 0.5 * std::abs(mean - 1.5), square = largest * largest;
  const double along = stiffness_at(law, {largest, -0.5 * largest, -0.5 * largest}) / rest;
  const double across = stiffness_at(law, {0.5 * largest, 0.5 * largest, -largest}) / rest;
  const double shape = 2.0 * (along - across) / square;  // J₃/δ is ±¼ δ² there
  const auto visit_states = [&](auto visit) {
    constexpr int kRadii = 16;
    for (int n = 1; n <= kRadii; ++n) {
      const double delta = largest * double(n) / double(kRadii);
      for (const std::array<double, 3>& x : shapes_of(delta)) {
        const double known = 1.0 + slope * delta + shape * x[0] * x[1] * x[2] / delta;
        visit(stiffness_at(law, x) / rest, known, delta * delta);
      }
    }
  };
  double bend = 0.0, most = 1.0;
  visit_states([&](double exact, double known, double squared) { bend = std::max(bend, (exact - known) / squared); });
  bend *= 1.05;  // for states between those
  visit_states(
      [&](double exact, double known, double squared) { most = std::max(most, (known + bend * squared) / exact); });
  out.bound = {rest, rest * slope, rest * bend, rest * shape};
  return most;
}

}  // namespace

template <>
StretchSeries<float> StretchSeries<>::rounded() const {
  StretchSeries<float> out;
  out.first = glisson::rounded(first), out.second = glisson::rounded(second);
  out.largest_J2 = float(largest_J2);
  for (std::size_t k = 0; k < bound.size(); ++k) out.bound[k] = float(bound[k]);
  return out;
}

StretchSeries<> stretch_series(const Ogden& law) {
  StretchSeries<> out;
  for (std::size_t k = 0; k < law.mu.size(); ++k) add_term(law.mu[k], law.alpha[k], out);
  constexpr double kMostError = 1e-7, kLoosest = 1.2, kFarthest = 0.5, kNearest = 1e-3, kCloser = 0.9;
  for (double delta = kFarthest; delta > kNearest; delta *= kCloser) {
    if (error_at(law, out, delta) <= kMostError && set_bound(law, delta, out) <= kLoosest) {
      out.largest_J2 = 0.75 * delta * delta;
      return out;
    }
  }
  return out;
}

}  // namespace glisson
