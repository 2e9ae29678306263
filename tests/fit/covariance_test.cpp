// Curvature gives the covariance of linear regression exactly, corrected where residuals swing or curves differ, and never
// inverts a direction that the curves do not see.
#include "fit/uncertainty/covariance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>

#include "fit/search/least_squares.h"
#include "fit/uncertainty/distribution.h"
#include "fit/uncertainty/residual_correlation.h"
#include "small_models.h"

namespace glisson::fit {
namespace {

using testing_models::Noise;
using testing_models::plan;
using testing_models::simulate;
using testing_models::Twin;

double line(double x, double, std::span<const double> v) { return v[0] + v[1] * x; }
const std::vector<Parameter> kLine{{"offset", "N", -10.0, 10.0}, {"slope", "N/m", -20.0, 20.0}};

std::vector<Curve> noisy(std::vector<Curve> curves, double sd, double rho, std::uint64_t seed) {
  Noise noise(seed);
  for (Curve& c : curves) {
    const std::vector<double> e = noise.correlated(c.size(), rho);
    for (std::size_t i = 0; i < c.size(); ++i) c.force[i] += sd * e[i];
  }
  return curves;
}

std::vector<double> optimum(const Problem& p) {
  return descend(p, std::vector<double>(p.parameters().size(), 0.4)).scaled;
}

// Straight line: C = σ² (XᵀX)⁻¹, σ² = SSR / (n − 2), interval ± t(n − 2) sd.
TEST(Covariance, IsThatOfLinearRegression) {
  const auto curves = noisy(simulate(plan(30, 0.0, 2.0), 1, line, {1.0, 3.0}), 0.1, 0.0, 1);
  const Twin twin(kLine, curves, 0.3, line);
  Eigen::MatrixXd x(30, 2);
  Eigen::VectorXd y(30);
  for (int i = 0; i < 30; ++i) {
    x.row(i) << 1.0, curves[0].displacement[static_cast<std::size_t>(i)];
    y[i] = curves[0].force[static_cast<std::size_t>(i)];
  }
  const Eigen::Vector2d beta = (x.transpose() * x).ldlt().solve(x.transpose() * y);
  const double variance = (y - x * beta).squaredNorm() / 28.0;
  const Eigen::Matrix2d expected = variance * (x.transpose() * x).inverse();
  const Covariance c = covariance(twin.problem, twin.problem.to_scaled(std::vector{beta[0], beta[1]}));
  ASSERT_EQ(c.noise.kind, NoiseKind::independent) << c.noise.why;
  EXPECT_DOUBLE_EQ(c.freedom, 28.0);
  EXPECT_NEAR(c.quantile, 2.048407141795, 1e-10);  // t(0.975, 28) of the tables: 2.0484
  const double range[] = {20.0, 40.0};
  for (std::size_t i = 0; i < 2; ++i) {
    // differences of a linear model are exact to rounding: 1e-16 · 10 / 1e-4 relative
    for (std::size_t j = 0; j < 2; ++j)
      EXPECT_NEAR(c.matrix[2 * i + j] * range[i] * range[j] / expected(static_cast<int>(i), static_cast<int>(j)), 1.0,
                  1e-8);
    const double half = c.quantile * std::sqrt(expected(static_cast<int>(i), static_cast<int>(i)));
    EXPECT_NEAR(c.interval[i].low, beta[static_cast<int>(i)] - half, 1e-8);
    EXPECT_NEAR(c.interval[i].high, beta[static_cast<int>(i)] + half, 1e-8);
  }
  EXPECT_NEAR(c.correlation[1], expected(0, 1) / std::sqrt(expected(0, 0) * expected(1, 1)), 1e-8);
  EXPECT_THAT(c.inflation, testing::Each(testing::DoubleNear(1.0, 1e-12)));
}

// On a logarithmic scale an interval is symmetric in the logarithm.
TEST(Covariance, MapsALogarithmicScale) {
  const auto scale_only = [](double x, double, std::span<const double> v) { return v[0] * x; };
  const auto curves = noisy(simulate(plan(20, 0.1, 1.0), 1, scale_only, {5.0}), 0.5, 0.0, 3);
  const Twin twin({{"E", "Pa", 0.1, 1000.0, Scale::logarithmic, 1.0}}, curves, 0.5, scale_only);
  const std::vector<double> z = optimum(twin.problem);
  const Covariance c = covariance(twin.problem, z);
  const double value = twin.problem.to_values(z)[0];
  EXPECT_NEAR(c.interval[0].low * c.interval[0].high, value * value, 1e-9 * value * value);
  EXPECT_NEAR(std::log(c.interval[0].high / value), c.quantile * c.sd[0] * std::log(1e4), 1e-9);
}

// F = a b x fixes the product: its direction is sure, the other is said to be unseen, and nothing is divided by it.
TEST(Covariance, ReportsWhatCurvesDoNotSee) {
  const auto product = [](double x, double, std::span<const double> v) { return v[0] * v[1] * x; };
  const auto curves = noisy(simulate(plan(40, 0.0, 1.0), 1, product, {2.0, 3.0}), 0.05, 0.0, 5);
  const Twin twin({{"a", "", 0.01, 100.0, Scale::logarithmic, 1.0}, {"b", "", 0.01, 100.0, Scale::logarithmic, 1.0}},
                  curves, 0.05, product);
  CovarianceOptions independent;
  independent.force = NoiseKind::independent;
  const Covariance c = covariance(twin.problem, optimum(twin.problem), independent);
  ASSERT_EQ(c.directions.size(), 2u);
  EXPECT_FALSE(c.directions[0].determined);
  EXPECT_TRUE(c.directions[1].determined);
  EXPECT_TRUE(std::isinf(c.sd[0]) && std::isinf(c.sd[1]));
  EXPECT_TRUE(c.interval[0].open() && c.interval[1].open());
  EXPECT_NEAR(c.correlation[1], -1.0, 1e-6);
  // ln(a b) = ln 1e4 (z_a + z_b) + const; its sd is that of the slope over the slope, σ / √Σx² / 6
  double xx = 0.0;
  for (const double x : curves[0].displacement) xx += x * x;
  const double expected = std::sqrt(c.noise.variance) * 0.05 / std::sqrt(xx) / 6.0;
  // the slope found is 6 to 1 %, and so is this
  EXPECT_NEAR(std::log(1e4) * std::sqrt(c.variance_of(std::vector{1.0, 1.0})) / expected, 1.0, 0.02);
}

// A parameter at its bound is held there and said so; the rest is as if it were known.
TEST(Covariance, HoldsParametersAtBounds) {
  const auto curves = noisy(simulate(plan(30, 0.0, 2.0), 1, line, {1.0, 3.0}), 0.1, 0.0, 1);
  std::vector<Parameter> parameters = kLine;
  parameters[0].high = 0.5;
  const Twin twin(parameters, curves, 0.3, line);
  const Covariance c = covariance(twin.problem, optimum(twin.problem));
  EXPECT_EQ(c.hold[0], Hold::at_high);
  EXPECT_EQ(c.hold[1], Hold::free);
  EXPECT_TRUE(std::isnan(c.sd[0]));
  EXPECT_TRUE(c.interval[0].open());
  double xx = 0.0;
  for (const double x : curves[0].displacement) xx += x * x;
  CovarianceOptions independent;
  independent.force = NoiseKind::independent;
  const Covariance held = covariance(twin.problem, c.scaled, independent);
  EXPECT_NEAR(held.sd[1] * 40.0, 0.3 * std::sqrt(held.noise.variance / xx), 1e-8);
}

TEST(Covariance, TellsAModelThatFails) {
  const auto curves = simulate(plan(5, 0.0, 1.0), 1, line, {1.0, 3.0});
  const auto nothing = testing_models::Formula({plan(3, 0.0, 1.0)}, line);  // too short for the curve
  const Problem problem(kLine, curves, {0}, {1.0}, nothing);
  EXPECT_THAT(covariance(problem, std::vector{0.5, 0.5}).failure, testing::HasSubstr("no force"));
}

// What white noise pays for a correlation that is looked for: intervals wider by 12 % of 60 samples, which hold the truth.
TEST(Covariance, WidensLittleUnderWhiteNoise) {  // long
  double held = 0.0, wider = 0.0;
  constexpr int kSeeds = 300;
  CovarianceOptions independent;
  independent.force = NoiseKind::independent;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const auto curves = noisy(simulate(plan(60, 0.0, 2.0), 1, line, {1.0, 3.0}), 0.1, 0.0, seed);
    const Twin twin(kLine, curves, 0.1, line);
    const std::vector<double> z = optimum(twin.problem);
    const Covariance c = covariance(twin.problem, z), plain = covariance(twin.problem, z, independent);
    held += (c.interval[1].holds(3.0) ? 1.0 : 0.0) / kSeeds;
    wider += c.sd[1] * c.quantile / (plain.sd[1] * plain.quantile) / kSeeds;
  }
  std::printf("white noise: held in %.3f, wider by %.3f\n", held, wider);
  EXPECT_GE(held, 0.93);
  EXPECT_LE(held, 0.985);
  EXPECT_LE(wider, 1.2);
}

// Share of seeds whose intervals hold the true slope.
double coverage(std::size_t copies, double rho, double between, std::optional<NoiseKind> kind, std::uint64_t first) {
  int inside = 0;
  constexpr int kSeeds = 300;
  for (std::uint64_t seed = first; seed < first + kSeeds; ++seed) {
    auto curves = noisy(simulate(plan(100, 0.0, 2.0), copies, line, {1.0, 3.0}), 0.1, rho, seed);
    Noise noise(seed + 77777);
    for (Curve& c : curves) {
      const double offset = between * noise(), slope = between * noise();
      for (std::size_t i = 0; i < c.size(); ++i) c.force[i] += offset + slope * c.displacement[i];
    }
    const Twin twin(kLine, curves, 0.1, line);
    CovarianceOptions options;
    options.force = kind;
    if (covariance(twin.problem, optimum(twin.problem), options).interval[1].holds(3.0)) ++inside;
  }
  return inside / static_cast<double>(kSeeds);
}

// Residuals that swing (ρ = 0.8: nine samples count as one) fool the plain formula: its intervals hold the truth in half the
// seeds. The corrected ones hold it in 90 % or more: of 300 seeds at a true 95 %, the share is below 0.905 once in 3000.
TEST(Covariance, CoversTheTruthUnderSlowResiduals) {  // verify
  const double naive = coverage(2, 0.8, 0.0, NoiseKind::independent, 0),
               corrected = coverage(2, 0.8, 0.0, std::nullopt, 0);
  const double one = coverage(1, 0.8, 0.0, std::nullopt, 1000);
  std::printf("AR(1) 0.8: naive %.3f, corrected %.3f, one curve %.3f\n", naive, corrected, one);
  EXPECT_LT(naive, 0.65);
  EXPECT_GE(corrected, 0.90);
  EXPECT_GE(one, 0.90);
}

// Repetitions that differ by themselves: the plain formula is far too sure, the sandwich over curves is not.
TEST(Covariance, CoversTheTruthWhereCurvesDiffer) {  // verify
  const double naive = coverage(5, 0.0, 0.2, NoiseKind::independent, 0),
               chosen = coverage(5, 0.0, 0.2, std::nullopt, 0);
  std::printf("between curves: naive %.3f, chosen %.3f\n", naive, chosen);
  EXPECT_LT(naive, 0.5);
  EXPECT_GE(chosen, 0.90);
  const auto curves = [&] {
    auto c = noisy(simulate(plan(100, 0.0, 2.0), 5, line, {1.0, 3.0}), 0.1, 0.0, 9);
    for (std::size_t k = 0; k < 5; ++k)
      for (double& f : c[k].force) f += 0.3 * (static_cast<double>(k) - 2.0);
    return c;
  }();
  const Twin twin(kLine, curves, 0.1, line);
  const Covariance c = covariance(twin.problem, optimum(twin.problem));
  EXPECT_EQ(c.noise.kind, NoiseKind::by_curve) << c.noise.why;
  EXPECT_DOUBLE_EQ(c.freedom, 4.0);
  EXPECT_THAT(c.noise.why, testing::HasSubstr("each of the 5 curves counts as one sample"));
}

// The sandwich of [BellMcCaffrey2002] is the jackknife: leave a curve out, refit, look at the scatter.
TEST(Covariance, OverCurvesIsTheJackknife) {
  const auto curves = noisy(simulate(plan(20, 0.0, 2.0), 6, line, {1.0, 3.0}), 0.1, 0.9, 4);
  const Twin twin(kLine, curves, 0.1, line);
  const std::vector<double> z = optimum(twin.problem);
  CovarianceOptions options;
  options.force = NoiseKind::by_curve;
  const Covariance c = covariance(twin.problem, z, options);
  Eigen::Matrix2d jackknife = Eigen::Matrix2d::Zero();
  for (std::size_t k = 0; k < curves.size(); ++k) {
    std::vector<Curve> rest = curves;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(k));
    const Twin without(kLine, rest, 0.1, line);
    const std::vector<double> w = optimum(without.problem);
    const Eigen::Vector2d d(w[0] - z[0], w[1] - z[1]);
    jackknife += 5.0 / 6.0 * d * d.transpose();
  }
  // exact for a linear model; the descents end within 1e-8 of a scatter of 1e-3
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(c.matrix[static_cast<std::size_t>(i)] / jackknife(i / 2, i % 2), 1.0, 1e-4);
}

// V x, 1ᵀV1/n and the degrees of freedom are those of the whole matrices, and the whitened likelihood finds a process again
// under noise: φ and the noise's part from 20 000 samples.
TEST(ResidualCorrelation, IsThatOfItsMatrix) {
  constexpr Eigen::Index kSize = 20000, kShort = 30;
  Noise noise(17);
  const std::vector<double> slow = noise.correlated(kSize, 0.95);
  Eigen::VectorXd r(kSize);
  for (Eigen::Index i = 0; i < kSize; ++i) r[i] = 2.0 * slow[static_cast<std::size_t>(i)] + noise();
  const std::vector<Rows> one{{0, kSize}}, two{{0, kShort}, {kShort, kShort}};
  const ResidualCorrelation found(r, Eigen::MatrixXd(kSize, 0), one);
  // of such a process φ comes back to (1 − φ) √(2/((1 − φ) n)) and the variance to √(2 τ/n), some 0.003 and 6 %
  EXPECT_NEAR(found.phi(), 0.95, 0.01);
  EXPECT_NEAR(found.white(), 0.2, 0.03);
  EXPECT_NEAR(found.variance(), 5.0, 0.9);
  Eigen::MatrixXd V = Eigen::MatrixXd::Zero(2 * kShort, 2 * kShort), J(2 * kShort, 2);
  for (Eigen::Index i = 0; i < 2 * kShort; ++i) {
    J.row(i) << 1.0, static_cast<double>(i * i);
    for (Eigen::Index j = 0; j < 2 * kShort; ++j) {
      if (i / kShort == j / kShort)
        V(i, j) = i == j ? 1.0 : (1.0 - found.white()) * std::pow(found.phi(), std::abs(i - j));
    }
  }
  EXPECT_LT((found.times(J, two) - V * J).norm(), 1e-12 * J.norm());
  EXPECT_NEAR(found.time(kShort), V.topLeftCorner(kShort, kShort).sum() / kShort, 1e-12 * kShort);
  const Eigen::MatrixXd A = (J.transpose() * J).inverse(), QV = V - J * A * J.transpose() * V;
  const double expected = QV.trace() * QV.trace() / (QV * QV).trace();
  EXPECT_NEAR(found.freedom(J, A, two), expected, 1e-9 * expected);
}

// ψ = dρ/2 dr and ψ' = dψ/dr, by differences of the cost, for each loss.
TEST(Influence, IsTheSlopeOfTheCost) {
  const auto curves = simulate(plan(3, 0.0, 1.0), 1, line, {0.0, 0.0});
  for (const LossKind kind : {LossKind::squares, LossKind::huber, LossKind::soft_l1, LossKind::cauchy}) {
    const Twin twin(kLine, curves, 1.0, line, {kind, 1.5});
    for (const double r : {-4.0, -0.7, 0.3, 2.5}) {
      const double h = 1e-4;
      const auto cost = [&](double x) { return twin.problem.cost(std::vector{x}); };
      const Influence psi = influence(twin.problem.loss(), r);
      EXPECT_NEAR(psi.value, (cost(r + h) - cost(r - h)) / (2.0 * h), 1e-7);
      EXPECT_NEAR(psi.slope, (cost(r + h) - 2.0 * cost(r) + cost(r - h)) / (h * h), 1e-5);
    }
  }
}

TEST(Distribution, AgreesWithTables) {
  EXPECT_NEAR(student_quantile(0.975, 4.0), 2.7764451, 1e-7);
  EXPECT_NEAR(chi_squared_tail(18.307, 10.0), 0.05, 1e-5);
}

}  // namespace
}  // namespace glisson::fit
