// Curves of a known tissue with 2 % noise: the 95 % intervals of the fit hold the truth in 90 % of the seeds or more.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "fit/search/least_squares.h"
#include "fit/uncertainty/bootstrap.h"
#include "fit/uncertainty/covariance.h"
#include "fit/uncertainty/profile.h"
#include "small_models.h"

namespace glisson::fit::twin_test {
namespace {

using testing_models::Noise;
using testing_models::plan;
using testing_models::Twin;

double ogden(double x, double, std::span<const double> v) { return testing_models::ogden(x, v[0], v[1]); }
const std::vector<Parameter> kOgden{{"mu", "Pa", 10.0, 1e5, Scale::logarithmic, 1e3}, {"alpha", "", 1.0, 40.0}};
const std::vector<double> kTruth{1000.0, 8.0};

/// How a twin's noise comes about: its sd is a part of the largest force, its neighbours are correlated, and every repetition
/// may have a stiffness of its own.
struct Recipe {
  std::size_t copies = 3;
  double noise = 0.02, rho = 0.0, between = 0.0;
  std::uint64_t first_seed = 0;
  int seeds = 200;
};

std::vector<Curve> curves_of(const Recipe& recipe, std::uint64_t seed) {
  Noise noise(seed);
  std::vector<Curve> curves;
  for (std::size_t k = 0; k < recipe.copies; ++k) {
    Curve c = plan(80, 0.0, 0.4);
    c.name = "repetition " + std::to_string(k + 1);
    const double own = 1.0 + recipe.between * noise();
    const std::vector<double> e = noise.correlated(c.size(), recipe.rho);
    const double largest = testing_models::ogden(0.4, kTruth[0], kTruth[1]);
    for (std::size_t i = 0; i < c.size(); ++i)
      c.force[i] = own * testing_models::ogden(c.displacement[i], kTruth[0], kTruth[1]) + recipe.noise * largest * e[i];
    curves.push_back(std::move(c));
  }
  return curves;
}

struct Coverage {
  double curvature[2] = {0.0, 0.0}, profile[2] = {0.0, 0.0};
};

Coverage coverage(const Recipe& recipe) {
  Coverage share;
  for (int s = 0; s < recipe.seeds; ++s) {
    const Twin twin(kOgden, curves_of(recipe, recipe.first_seed + static_cast<std::uint64_t>(s)), 100.0, ogden);
    const Optimum best = descend(twin.problem, twin.problem.to_scaled(std::vector{500.0, 4.0}));
    const Covariance c = covariance(twin.problem, best.scaled);
    const Profiles p = profiles(twin.problem, best, c);
    for (std::size_t i = 0; i < 2; ++i) {
      share.curvature[i] += (c.interval[i].holds(kTruth[i]) ? 1.0 : 0.0) / recipe.seeds;
      share.profile[i] += (p.of[i].interval.holds(kTruth[i]) ? 1.0 : 0.0) / recipe.seeds;
    }
  }
  return share;
}

void print(const char* what, const Coverage& c) {
  std::printf("%s: curvature mu %.3f alpha %.3f, profile mu %.3f alpha %.3f\n", what, c.curvature[0], c.curvature[1],
              c.profile[0], c.profile[1]);
}

/// Of 200 seeds at a true 95 % the share has a standard deviation of 1.5 %: below 90 % it falls once in 800 draws, and with
/// the fixed seeds it either does or does not.
void expect_covered(const Coverage& c) {
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_GE(c.curvature[i], 0.90);
    EXPECT_GE(c.profile[i], 0.90);
  }
}

TEST(Twin, IsCoveredUnderWhiteNoise) {  // verify
  const Coverage c = coverage({});
  print("2 % white", c);
  expect_covered(c);
  // too wide would be no proof either: 100 % of 200 has no chance at a true 95 %, (0.95)²⁰⁰ = 4e-5
  EXPECT_LT(c.profile[0] + c.profile[1], 2.0);
}

TEST(Twin, IsCoveredUnderSlowNoise) {  // verify
  Recipe recipe;
  recipe.rho = 0.8;
  const Coverage c = coverage(recipe);
  print("2 % with a correlation of 0.8", c);
  expect_covered(c);
}

// One curve of 80 samples with nine counting as one is worth nine samples: the least that is asked of the correction.
TEST(Twin, IsCoveredByOneSlowCurve) {  // verify
  Recipe recipe;
  recipe.copies = 1;
  recipe.rho = 0.8;
  const Coverage c = coverage(recipe);
  print("one curve, 0.8", c);
  expect_covered(c);
}

// Repetitions whose stiffness scatters by 10 %: the optimum is their mean, known as such.
TEST(Twin, IsCoveredWhereRepetitionsDiffer) {  // verify
  Recipe recipe;
  recipe.copies = 5;
  recipe.between = 0.1;
  const Coverage c = coverage(recipe);
  print("repetitions that differ by 10 %", c);
  expect_covered(c);
}

// Plain percentiles over six repetitions hold the truth in 88 %, for they stand in for normal quantiles; widened to Student's
// with five degrees of freedom they have to hold it in 90 %. 100 seeds at a true 95 % have an sd of 2.2 %.
TEST(Twin, IsCoveredByTheBootstrap) {  // verify
  Recipe recipe;
  recipe.copies = 6;
  recipe.between = 0.1;
  double share[2] = {0.0, 0.0};
  constexpr int kSeeds = 100;
  for (int s = 0; s < kSeeds; ++s) {
    const Twin twin(kOgden, curves_of(recipe, static_cast<std::uint64_t>(s)), 100.0, ogden);
    const Optimum best = descend(twin.problem, twin.problem.to_scaled(std::vector{500.0, 4.0}));
    BootstrapOptions options;
    options.replicates = 100;
    options.seed = static_cast<std::uint64_t>(s);
    const Bootstrap b = bootstrap(twin.problem, best.scaled, covariance(twin.problem, best.scaled), options);
    for (std::size_t i = 0; i < 2; ++i) share[i] += b.interval[i].holds(kTruth[i]) ? 1.0 / kSeeds : 0.0;
  }
  std::printf("bootstrap of six repetitions that differ: mu %.2f, alpha %.2f\n", share[0], share[1]);
  EXPECT_GE(share[0], 0.90);
  EXPECT_GE(share[1], 0.90);
}

// A robust loss with one sample in twenty far off: the intervals are still right, and narrower than those of squares.
TEST(Twin, IsCoveredUnderARobustLoss) {  // verify
  int inside[2] = {0, 0};
  double robust_width = 0.0, squares_width = 0.0;
  constexpr int kSeeds = 200;
  for (int s = 0; s < kSeeds; ++s) {
    std::vector<Curve> curves = curves_of({}, static_cast<std::uint64_t>(s));
    Noise outliers(static_cast<std::uint64_t>(s) + 5000);
    for (Curve& c : curves)
      for (double& f : c.force)
        if (outliers.uniform() < 0.05) f += 3000.0 * outliers();
    const auto fit = [&](LossKind kind) {
      const Twin twin(kOgden, curves, 150.0, ogden, {kind, 1.5});
      return covariance(twin.problem, descend(twin.problem, twin.problem.to_scaled(std::vector{500.0, 4.0})).scaled);
    };
    const Covariance robust = fit(LossKind::huber), squares = fit(LossKind::squares);
    for (std::size_t i = 0; i < 2; ++i) inside[i] += robust.interval[i].holds(kTruth[i]) ? 1 : 0;
    robust_width += robust.sd[1];
    squares_width += squares.sd[1];
  }
  std::printf("Huber with outliers: mu %d, alpha %d of 200; width over that of squares %.2f\n", inside[0], inside[1],
              robust_width / squares_width);
  EXPECT_GE(inside[0], 180);
  EXPECT_GE(inside[1], 180);
  EXPECT_LT(robust_width, 0.7 * squares_width);
}

}  // namespace
}  // namespace glisson::fit::twin_test
