// The series of Ogden's law is the law as far as it says, and its bound holds and is close.
#include "material/stretch_series.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "material/stiffness_bound.h"

namespace glisson {
namespace {

std::vector<Ogden> laws() {
  return {{.mu = {1000.0}, .alpha = {2.0}, .bulk_modulus = 2e4},
          {.mu = {1000.0}, .alpha = {-24.0}, .bulk_modulus = 2e4},
          {.mu = {900.0}, .alpha = {40.0}, .bulk_modulus = 2e4},
          {.mu = {1500.0, -700.0, 200.0}, .alpha = {1.3, -2.5, 9.0}, .bulk_modulus = 2e4},
          {.mu = {1e6, -999'999.0}, .alpha = {-100.0, 100.0}, .bulk_modulus = 2e4}};
}

/// A state of three stretches at random, X of which has J₂ = share² of the largest.
struct Stretched {
  std::array<double, 3> x{};  ///< eigenvalues of X
  double m = 1.0, delta = 0.0;

  Stretched(const StretchSeries<>& series, double share, std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    delta = share * std::sqrt(4.0 / 3.0 * series.largest_J2);
    const double angle = 2.0 * std::numbers::pi * unit(random), turn = 2.0 * std::numbers::pi / 3.0;
    x = {delta * std::cos(angle), delta * std::cos(angle + turn), delta * std::cos(angle - turn)};
    m = 0.8 + 0.5 * unit(random);
  }
  double stretch(std::size_t i) const { return std::sqrt(m * (1.0 + x[i])); }
  double J2() const { return 0.75 * delta * delta; }
  double J3() const { return x[0] * x[1] * x[2]; }
};

// A thousand states each, up to where the series says that it holds; 1e-7 is its own limit, at shapes other than these.
TEST(StretchSeries, IsTheLaw) {
  std::mt19937 random(5);
  for (const Ogden& law : laws()) {
    const StretchSeries<> series = stretch_series(law);
    double scale = 0.0;
    for (const double mu : law.mu) scale += std::abs(mu);
    for (const double share : {1e-3, 0.1, 0.7, 1.0}) {
      for (int n = 0; n < 250; ++n) {
        const Stretched s(series, share, random);
        std::array<double, 3> l{};
        double mean = 0.0;
        for (std::size_t i = 0; i < 3; ++i) l[i] = std::log(s.stretch(i)), mean += l[i] / 3.0;
        const std::array<double, 3> t = law.slopes(std::array{l[0] - mean, l[1] - mean, l[2] - mean});
        const double q1 = series_at(series.first, s.J2(), s.J3()), q2 = series_at(series.second, s.J2(), s.J3());
        for (std::size_t i = 0; i < 3; ++i) {
          EXPECT_NEAR(q1 * s.x[i] + q2 * (s.x[i] * s.x[i] - 2.0 / 3.0 * s.J2()), t[i], 1.1e-7 * scale * s.delta)
              << "α = " << law.alpha[0] << ", share " << share;
        }
      }
    }
  }
}

// Strains of a needle's surroundings are inside: half of δ is about the largest strain: 20, 7, 5 and 10 %.
TEST(StretchSeries, HoldsForTheStrainsOfTissue) {
  const std::array<double, 4> least{0.40, 0.14, 0.11, 0.20};
  for (std::size_t k = 0; k < least.size(); ++k) {
    EXPECT_GE(std::sqrt(4.0 / 3.0 * stretch_series(laws()[k]).largest_J2), least[k]) << k;
  }
}

// Never below the largest eigenvalue of the tangent, at most a fifth above it, and the same at rest.
TEST(StretchSeries, BoundIsAboveTheTangentAndClose) {
  std::mt19937 random(6);
  for (const Ogden& law : laws()) {
    const StretchSeries<> series = stretch_series(law);
    EXPECT_DOUBLE_EQ(series.bound[0], stretch_bound(law, {0.0, 0.0, 0.0}));
    for (const double share : {0.01, 0.1, 0.4, 0.7, 1.0}) {
      for (int n = 0; n < 300; ++n) {
        const Stretched s(series, share, random);
        const auto& [rest, slope, bend, shape] = series.bound;
        const double bound = (rest + s.delta * (slope + s.delta * bend) + shape * s.J3() / s.delta) / s.m;
        const double exact = stretch_bound(law, {s.stretch(0) - 1.0, s.stretch(1) - 1.0, s.stretch(2) - 1.0});
        EXPECT_GE(bound, exact * (1.0 - 1e-6)) << "α = " << law.alpha[0] << ", share " << share;
        EXPECT_LE(bound, exact * 1.2) << "α = " << law.alpha[0] << ", share " << share;
      }
    }
  }
}

}  // namespace
}  // namespace glisson
