// Drawn anew, curves scatter the optimum as new experiments would, and the bytes depend on the seed alone.
#include "fit/uncertainty/bootstrap.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdio>

#include "fit/search/least_squares.h"
#include "small_models.h"

namespace glisson::fit {
namespace {

using testing_models::Noise;
using testing_models::plan;
using testing_models::simulate;
using testing_models::Twin;

double decay(double x, double, std::span<const double> v) { return v[0] * std::exp(-v[1] * x); }
const std::vector<Parameter> kDecay{{"a", "N", 0.1, 10.0, Scale::logarithmic, 1.0},
                                    {"k", "1/m", 0.1, 10.0, Scale::logarithmic, 1.0}};
const std::vector<double> kTruth{2.0, 1.5};

/// Repetitions whose own a and k scatter by 5 %, under white noise; or one curve whose noise is a first-order process.
std::vector<Curve> repetitions(std::size_t n, double rho, std::uint64_t seed) {
  Noise noise(seed);
  std::vector<Curve> curves;
  for (std::size_t c = 0; c < n; ++c) {
    const double own = n > 1 ? 0.05 : 0.0;
    auto one =
        simulate(plan(60, 0.0, 2.0), 1, decay, {kTruth[0] * (1.0 + own * noise()), kTruth[1] * (1.0 + own * noise())});
    const std::vector<double> e = noise.correlated(60, rho);
    for (std::size_t i = 0; i < 60; ++i) one[0].force[i] += 0.04 * e[i];
    one[0].name = std::to_string(c);
    curves.push_back(one[0]);
  }
  return curves;
}

std::vector<double> fitted(const Problem& p) { return descend(p, p.to_scaled(kTruth)).scaled; }

struct Scatter {
  double truth = 0.0, bootstrap = 0.0;
};

/// sd of ln k over new experiments, and the root mean square of what the bootstrap says from one.
Scatter scatter(std::size_t n, double rho, int experiments, int bootstraps, Loss loss = {}) {
  double sum = 0.0, squares = 0.0, said = 0.0;
  for (int e = 0; e < experiments; ++e) {
    const auto curves = repetitions(n, rho, static_cast<std::uint64_t>(e));
    const Twin twin(kDecay, curves, 0.04, decay, loss);
    const std::vector<double> z = fitted(twin.problem);
    sum += z[1];
    squares += z[1] * z[1];
    if (e >= bootstraps) continue;
    BootstrapOptions options;
    options.replicates = 100;
    options.seed = static_cast<std::uint64_t>(e);  // or all would share the same draws, and their 7 %
    const Bootstrap b = bootstrap(twin.problem, z, covariance(twin.problem, z), options);
    said += b.sd[1] * b.sd[1] / bootstraps;
  }
  const double mean = sum / experiments;
  return {std::sqrt(squares / experiments - mean * mean), std::sqrt(said)};
}

// The true scatter of 400 experiments is known to 1/√800 = 3.5 %, the variance that 60 bootstraps of 6 curves say (5 degrees
// of freedom: √(2/5) each) to 8 %, its root to 4 %: 5.4 % together, and three times that is allowed.
TEST(Bootstrap, ScattersAsNewExperimentsDo) {  // long
  const Scatter s = scatter(6, 0.0, 400, 60);
  std::printf("6 repetitions: true sd %.5f, bootstrap %.5f\n", s.truth, s.bootstrap);
  EXPECT_NEAR(s.bootstrap / s.truth, 1.0, 0.16);
}

// One curve: residuals in blocks. Blocks of three correlation times lose Σ 2k ρ^k / (τ · 3τ) of the variance, 12 % at ρ = 0.6
// (τ = 4), 6 % of the sd; a correlation time from 60 samples is itself known to a third.
TEST(Bootstrap, ScattersInBlocksOfOneCurve) {  // long
  const Scatter white = scatter(1, 0.0, 400, 40), slow = scatter(1, 0.6, 400, 40);
  std::printf("one curve: white %.5f / %.5f, rho 0.6 %.5f / %.5f\n", white.truth, white.bootstrap, slow.truth,
              slow.bootstrap);
  EXPECT_NEAR(white.bootstrap / white.truth, 1.0, 0.16);
  EXPECT_NEAR(slow.bootstrap / slow.truth, 0.94, 0.22);
}

// A robust loss cannot be weighed: its curves are doubled instead, and scatter as they should.
TEST(Bootstrap, ScattersUnderARobustLoss) {  // long
  const Scatter s = scatter(6, 0.0, 400, 60, {LossKind::huber, 1.5});
  std::printf("robust: true sd %.5f, bootstrap %.5f\n", s.truth, s.bootstrap);
  EXPECT_NEAR(s.bootstrap / s.truth, 1.0, 0.16);
}

TEST(Bootstrap, GivesTheSameBytesOnAnyNumberOfThreads) {
  const auto curves = repetitions(4, 0.3, 5);
  std::vector<Bootstrap> all;
  for (const std::size_t threads : {1u, 2u, 8u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const Twin twin(kDecay, curves, 0.04, decay);
    const std::vector<double> z = fitted(twin.problem);
    all.push_back(bootstrap(twin.problem, z, covariance(twin.problem, z), {40, 7}));
  }
  EXPECT_EQ(all[0].scaled, all[1].scaled);
  EXPECT_EQ(all[0].scaled, all[2].scaled);
  EXPECT_EQ(all[0].forward_runs, all[2].forward_runs);
  const Twin twin(kDecay, curves, 0.04, decay);
  const std::vector<double> z = fitted(twin.problem);
  EXPECT_NE(bootstrap(twin.problem, z, covariance(twin.problem, z), {40, 8}).scaled, all[0].scaled);
}

TEST(Bootstrap, SaysHowGroupsWereDrawn) {
  auto curves = repetitions(4, 0.0, 5);
  curves.push_back(curves[0]);
  curves.back().group = "alone";
  const Twin twin(kDecay, curves, 0.04, decay);
  const std::vector<double> z = fitted(twin.problem);
  const Bootstrap b = bootstrap(twin.problem, z, covariance(twin.problem, z), {20});
  EXPECT_EQ(b.scaled.size(), 20u);
  EXPECT_EQ(b.failed, 0);
  EXPECT_THAT(b.notes,
              testing::ElementsAre(testing::HasSubstr("4 repetitions"), testing::HasSubstr("alone: only 1 curve,")));
  const std::vector<double> v = twin.problem.to_values(z);
  EXPECT_TRUE(b.interval[0].holds(v[0]) && b.interval[1].holds(v[1]));
}

TEST(Bootstrap, StopsWhenAsked) {
  const auto curves = repetitions(4, 0.0, 5);
  const Twin twin(kDecay, curves, 0.04, decay);
  const std::vector<double> z = fitted(twin.problem);
  const std::atomic<bool> stop{true};
  BootstrapOptions options;
  options.stop = &stop;
  const Bootstrap b = bootstrap(twin.problem, z, covariance(twin.problem, z), options);
  EXPECT_TRUE(b.stopped);
  EXPECT_TRUE(b.scaled.empty() && b.interval.empty());
}

}  // namespace
}  // namespace glisson::fit
