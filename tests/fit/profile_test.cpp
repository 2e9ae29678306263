// Profiles end where linear theory and the exact likelihood end, stay open where curves do not object, and bring back a lower
// cost that they find on the way.
#include "fit/uncertainty/profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdio>

#include "small_models.h"

namespace glisson::fit {
namespace {

using testing_models::Noise;
using testing_models::plan;
using testing_models::simulate;
using testing_models::Twin;

std::vector<Curve> noisy(std::vector<Curve> curves, double sd, std::uint64_t seed) {
  Noise noise(seed);
  for (Curve& c : curves)
    for (double& f : c.force) f += sd * noise();
  return curves;
}

struct Proved {
  Optimum optimum;
  Covariance curvature;
  Profiles profiled;
};

Proved prove(const Problem& problem, const std::vector<double>& start, const ProfileOptions& options = {},
             std::optional<NoiseKind> noise = {}) {
  Proved p;
  p.optimum = descend(problem, start);
  CovarianceOptions of_noise;
  of_noise.force = noise;
  p.curvature = covariance(problem, p.optimum.scaled, of_noise);
  p.profiled = profiles(problem, p.optimum, p.curvature, options);
  return p;
}

double parabola(double x, double, std::span<const double> v) { return v[0] + v[1] * x + v[2] * x * x; }
double saturation(double x, double, std::span<const double> v) { return 1.0 - std::exp(-v[0] * x); }

const std::vector<Parameter> kParabola{{"a", "N", -10.0, 10.0}, {"b", "N/m", -10.0, 10.0}, {"c", "N/m²", -10.0, 10.0}};

// A linear model's cost is a parabola, so that its profile ends where ± t sd ends.
TEST(Profile, IsLinearTheoryForALinearModel) {
  const auto curves = noisy(simulate(plan(40, 0.0, 2.0), 2, parabola, {1.0, -2.0, 3.0}), 0.1, 2);
  const Twin twin(kParabola, curves, 0.1, parabola);
  const Proved p = prove(twin.problem, {0.4, 0.4, 0.4});
  for (std::size_t i = 0; i < 3; ++i) {
    const Interval &profile = p.profiled.of[i].interval, &curvature = p.curvature.interval[i];
    // the descents end at a relative cost of 1e-10, √ of it in a cost of 40: 1e-4 of the way at most
    const double width = curvature.high - curvature.low;
    EXPECT_NEAR(profile.low, curvature.low, 1e-4 * width);
    EXPECT_NEAR(profile.high, curvature.high, 1e-4 * width);
    EXPECT_FALSE(profile.low_open || profile.high_open || p.profiled.of[i].flat);
    EXPECT_GT(p.profiled.of[i].points.size(), 5u);
  }
  EXPECT_TRUE(p.profiled.better.empty());
}

// Of a dear model the same ends in fewer runs. A descent that ends at 1e-6 of a cost of 20 errs by 2e-5 in a rise of 2: by
// far less than the 1e-3 of the way to which ends are found.
TEST(Profile, HasTheSameEndsByDerivativesCarriedAlong) {
  const auto law = [](double x, double, std::span<const double> v) {
    return testing_models::ogden(x, v[0], v[1]) + v[2] * x;
  };
  const auto curves = noisy(simulate(plan(40, 0.0, 0.5), 1, law, {2.0, 5.0, 1.0}), 0.05, 7);
  const std::vector<Parameter> parameters{{"mu", "", 0.1, 50.0, Scale::logarithmic, 1.0},
                                          {"alpha", "", 0.5, 20.0, Scale::linear, 4.0},
                                          {"k", "", -50.0, 50.0}};
  const Twin full(parameters, curves, 0.05, law), secant(parameters, curves, 0.05, law);
  const std::vector<double> start = full.problem.to_scaled(std::vector{2.0, 5.0, 1.0});
  ProfileOptions dear;
  dear.secant = true, dear.tolerance = 1e-6;
  const Proved a = prove(full.problem, start, {}, NoiseKind::independent),
               b = prove(secant.problem, start, dear, NoiseKind::independent);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const Interval &x = a.profiled.of[p].interval, &y = b.profiled.of[p].interval;
    EXPECT_NEAR(y.low, x.low, 2e-3 * (x.high - x.low)) << parameters[p].name;
    EXPECT_NEAR(y.high, x.high, 2e-3 * (x.high - x.low)) << parameters[p].name;
  }
  EXPECT_LT(secant.problem.forward_runs(), full.problem.forward_runs() / 2);
  std::printf("profiles: %llu runs by differences, %llu carried along\n",
              static_cast<unsigned long long>(full.problem.forward_runs()),
              static_cast<unsigned long long>(secant.problem.forward_runs()));
}

// One parameter, F = 1 − e^(−k x): the ends are the roots of cost(k) = cost* + ½ σ² t², found here by bisection.
TEST(Profile, IsTheLikelihoodIntervalOfANonLinearParameter) {
  const auto curves = noisy(simulate(plan(30, 0.0, 1.0), 1, saturation, {3.0}), 0.1, 4);
  const Twin twin({{"k", "1/m", 0.1, 30.0, Scale::logarithmic, 1.0}}, curves, 0.1, saturation);
  const Proved p = prove(twin.problem, {0.5}, {}, NoiseKind::independent);
  const double best = twin.problem.to_values(p.optimum.scaled)[0];
  const auto cost = [&](double k) {
    return twin.problem.cost(twin.problem.residuals(twin.problem.to_scaled(std::vector{k}), false).values);
  };
  const double variance = 2.0 * p.optimum.cost / 29.0, t = 2.045229642132703;  // t(0.975, 29)
  const auto root = [&](double inside, double outside) {
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (inside + outside);
      (cost(middle) - p.optimum.cost < 0.5 * variance * t * t ? inside : outside) = middle;
    }
    return inside;
  };
  const Interval& found = p.profiled.of[0].interval;
  // interpolation between points less than 3 % of the way apart leaves less than 1e-3 of it
  EXPECT_NEAR(found.low, root(best, 0.1), 1e-3 * (best - found.low));
  EXPECT_NEAR(found.high, root(best, 30.0), 1e-3 * (found.high - best));
  EXPECT_GT(std::abs(found.high - best) / std::abs(best - found.low), 1.1);  // lopsided, as it is
}

// The inflation for residuals that swing widens profiles as it widens ± t sd.
TEST(Profile, IsInflatedAsTheCovariance) {
  auto curves = simulate(plan(100, 0.0, 2.0), 2, parabola, {1.0, -2.0, 3.0});
  Noise noise(8);
  for (Curve& c : curves) {
    const std::vector<double> e = noise.correlated(c.size(), 0.8);
    for (std::size_t i = 0; i < e.size(); ++i) c.force[i] += 0.1 * e[i];
  }
  const Twin twin(kParabola, curves, 0.1, parabola);
  const Proved p = prove(twin.problem, {0.4, 0.4, 0.4});
  EXPECT_EQ(p.curvature.noise.kind, NoiseKind::autocorrelated);
  EXPECT_GT(p.curvature.inflation[1], 3.0);
  const double width = p.curvature.interval[1].high - p.curvature.interval[1].low;
  EXPECT_NEAR(p.profiled.of[1].interval.high, p.curvature.interval[1].high, 1e-3 * width);
}

// Where the curve is saturated from the first point on, any large k does as well: the upper end is open, the lower is not.
TEST(Profile, StaysOpenWhereCurvesDoNotObject) {
  const auto curves = noisy(simulate(plan(30, 0.2, 1.0), 1, saturation, {40.0}), 0.02, 5);
  const Twin twin({{"k", "1/m", 1.0, 1000.0, Scale::logarithmic, 1.0}}, curves, 0.02, saturation);
  const Proved p = prove(twin.problem, {0.4});
  const Profile& k = p.profiled.of[0];
  EXPECT_TRUE(k.interval.high_open);
  EXPECT_DOUBLE_EQ(k.interval.high, 1000.0);
  EXPECT_FALSE(k.interval.low_open);
  EXPECT_GT(k.interval.low, 5.0);
}

// F = a b x: the profile of a is flat as far as b can make up for it, and ends where b stands at its bound.
TEST(Profile, IsFlatWhereAnotherParameterMakesUp) {
  const auto product = [](double x, double, std::span<const double> v) { return v[0] * v[1] * x; };
  const auto curves = noisy(simulate(plan(40, 0.0, 1.0), 1, product, {2.0, 3.0}), 0.05, 5);
  const Twin twin({{"a", "", 0.01, 100.0, Scale::logarithmic, 1.0}, {"b", "", 0.01, 100.0, Scale::logarithmic, 1.0}},
                  curves, 0.05, product);
  const Proved p = prove(twin.problem, {0.6, 0.6});
  const Profile& a = p.profiled.of[0];
  EXPECT_TRUE(a.interval.high_open);
  EXPECT_NEAR(a.interval.low, 0.06, 0.002);
  EXPECT_THAT(a.low_leans_on, testing::ElementsAre(1u));
  EXPECT_LT(a.flat_low, 0.1);
  EXPECT_NEAR(a.flat_high, 100.0, 1e-9);
}

// Two basins: walking from the worse one, the profile falls into the better one and says so.
TEST(Profile, BringsBackABetterOptimum) {
  const auto wave = [](double x, double, std::span<const double> v) { return v[1] * std::sin(v[0] * x); };
  const auto curves = noisy(simulate(plan(60, 0.0, 6.0), 1, wave, {3.0, 1.0}), 0.3, 6);
  const Twin twin({{"w", "1/m", 0.5, 6.0}, {"s", "N", -2.0, 2.0}}, curves, 0.3, wave);
  const std::vector<double> start = twin.problem.to_scaled(std::vector{2.0, 0.3});
  const Proved p = prove(twin.problem, start);
  const Optimum global = descend(twin.problem, twin.problem.to_scaled(std::vector{3.0, 1.0}));
  ASSERT_GT(p.optimum.cost, 2.0 * global.cost);  // the start leads to the worse basin
  ASSERT_FALSE(p.profiled.better.empty());
  EXPECT_LT(p.profiled.better_cost, p.optimum.cost);
  EXPECT_NEAR(descend(twin.problem, p.profiled.better).cost, global.cost, 1e-6 * global.cost);
}

// A model that fails beyond a value leaves that side open, with the reason.
TEST(Profile, TellsWhereTheModelFails) {
  const auto fails = [](double x, double, std::span<const double> v) { return v[0] > 3.05 ? std::nan("") : v[0] * x; };
  class Failing final : public Model {
   public:
    explicit Failing(testing_models::Formula::Function f, Curve c) : f_(std::move(f)), curve_(std::move(c)) {}
    std::size_t curves() const override { return 1; }
    Prediction predict(std::size_t, std::span<const double> v) const override {
      Prediction p;
      for (const double x : curve_.displacement) p.force.push_back(f_(x, 1.0, v));
      if (std::isnan(p.force[1])) return {{}, "the mesh inverted"};
      return p;
    }

   private:
    testing_models::Formula::Function f_;
    Curve curve_;
  };
  const auto curves = noisy(simulate(plan(20, 0.0, 1.0), 1, fails, {3.0}), 0.3, 12);
  const Failing model(fails, curves[0]);
  const Problem problem({{"E", "Pa", 0.1, 10.0}}, curves, {0}, {0.3}, model);
  const Proved p = prove(problem, {0.2});
  EXPECT_TRUE(p.profiled.of[0].interval.high_open);
  EXPECT_EQ(p.profiled.of[0].high_failure, "the mesh inverted");
  EXPECT_FALSE(p.profiled.of[0].interval.low_open);
}

TEST(Profile, StopsWhenAsked) {
  const auto curves = noisy(simulate(plan(40, 0.0, 2.0), 2, parabola, {1.0, -2.0, 3.0}), 0.1, 2);
  const Twin twin(kParabola, curves, 0.1, parabola);
  const std::atomic<bool> stop{true};
  ProfileOptions options;
  options.stop = &stop;
  const Proved p = prove(twin.problem, {0.4, 0.4, 0.4}, options);
  for (const Profile& profile : p.profiled.of) {
    EXPECT_EQ(profile.points.size(), 1u);
    EXPECT_EQ(profile.low_failure, "stopped");
    EXPECT_TRUE(profile.interval.open());
  }
}

TEST(Profile, GivesTheSameBytesOnAnyNumberOfThreads) {
  const auto curves = noisy(simulate(plan(40, 0.0, 2.0), 2, parabola, {1.0, -2.0, 3.0}), 0.1, 2);
  std::vector<std::vector<double>> costs;
  for (const std::size_t threads : {1u, 2u, 8u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const Twin twin(kParabola, curves, 0.1, parabola);
    costs.emplace_back();
    for (const Profile& profile : prove(twin.problem, {0.4, 0.4, 0.4}).profiled.of)
      for (const ProfilePoint& point : profile.points) costs.back().push_back(point.cost);
  }
  EXPECT_EQ(costs[0], costs[1]);
  EXPECT_EQ(costs[0], costs[2]);
}

}  // namespace
}  // namespace glisson::fit
