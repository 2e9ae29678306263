// The descent finds the closed-form optimum of a linear model, stays within bounds, bears a bad point under a robust loss,
// and refuses a model that fails without throwing. Derivatives that are carried along lead to the same optimum in fewer runs.
#include "fit/search/least_squares.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <mutex>
#include <set>

#include "small_models.h"

namespace glisson::fit {
namespace {

/// F = a x + b x², the displacement taken from the curves.
class Quadratic final : public Model {
 public:
  explicit Quadratic(std::vector<Curve> curves) : curves_(std::move(curves)) {}
  std::size_t curves() const override { return curves_.size(); }
  Prediction predict(std::size_t c, std::span<const double> v) const override {
    if (v[0] > fails_above) return {{}, "too stiff"};
    Prediction p;
    for (const double x : curves_[c].displacement) p.force.push_back(v[0] * x + v[1] * x * x);
    return p;
  }
  double fails_above = std::numeric_limits<double>::infinity();

 private:
  std::vector<Curve> curves_;
};

Curve curve_of(double a, double b) {
  Curve c;
  c.name = "one";
  for (int i = 0; i <= 20; ++i) {
    const double x = 0.1 * i;
    c.time.push_back(x);
    c.displacement.push_back(x);
    c.force.push_back(a * x + b * x * x);
  }
  return c;
}

std::vector<Parameter> two(double a_high = 100.0) {
  return {{"a", "N/m", 0.01, a_high, Scale::logarithmic, 1.0}, {"b", "N/m²", -10.0, 10.0, Scale::linear, 0.0}};
}

TEST(Descend, FindsTheParametersOfExactData) {
  const Curve curve = curve_of(3.0, 2.0);
  const Quadratic model({curve});
  const Problem problem(two(), {curve}, {0}, {0.1}, model);
  const Optimum best = descend(problem, problem.to_scaled(std::vector{0.02, -9.0}));
  EXPECT_TRUE(best.converged) << best.message;
  // the cost is quadratic to the differences' own error, so the optimum is exact to the parameter tolerance
  EXPECT_THAT(problem.to_values(best.scaled),
              testing::ElementsAre(testing::DoubleNear(3.0, 1e-6), testing::DoubleNear(2.0, 1e-6)));
  EXPECT_GT(problem.forward_runs(), 5u);
}

TEST(Descend, StaysWithinTheBounds) {
  const Curve curve = curve_of(3.0, 2.0);
  const Quadratic model({curve});
  const Problem problem(two(2.0), {curve}, {0}, {0.1}, model);
  const std::vector<double> v = problem.to_values(descend(problem, std::vector{0.5, 0.5}).scaled);
  EXPECT_NEAR(v[0], 2.0, 1e-8);
  // with a held at 2 the normal equation of b alone: b = 2 + (3 − 2) Σ x³ / Σ x⁴
  double x3 = 0.0, x4 = 0.0;
  for (const double x : curve.displacement) {
    x3 += x * x * x;
    x4 += x * x * x * x;
  }
  EXPECT_NEAR(v[1], 2.0 + x3 / x4, 1e-5);
}

TEST(Descend, HoldsWhatIsFixed) {
  const Curve curve = curve_of(3.0, 2.0);
  const Quadratic model({curve});
  const Problem problem(two(), {curve}, {0}, {0.1}, model);
  DescentOptions options;
  options.fixed = {0, 1};
  const std::vector<double> z = problem.to_scaled(std::vector{1.0, 0.0});
  const Optimum best = descend(problem, z, options);
  EXPECT_EQ(best.scaled[1], z[1]);
  double xx = 0.0, xf = 0.0;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    xx += curve.displacement[i] * curve.displacement[i];
    xf += curve.displacement[i] * curve.force[i];
  }
  EXPECT_NEAR(problem.to_values(best.scaled)[0], xf / xx, 1e-5);
}

TEST(Descend, ARobustLossBearsABadPoint) {
  Curve curve = curve_of(3.0, 2.0);
  const Quadratic model({curve});
  curve.force[10] += 50.0;
  const Problem squares(two(), {curve}, {0}, {0.1}, model);
  const Problem robust(two(), {curve}, {0}, {0.1}, model, {LossKind::cauchy, 1.0});
  const auto value = [&](const Problem& p) { return p.to_values(descend(p, std::vector{0.5, 0.5}).scaled); };
  EXPECT_GT(std::abs(value(squares)[0] - 3.0), 1.0);
  // one residual of 500 under Cauchy's loss pulls with about 2/500
  EXPECT_NEAR(value(robust)[0], 3.0, 0.02);
}

TEST(Descend, TellsAModelThatFails) {
  const Curve curve = curve_of(3.0, 2.0);
  Quadratic model({curve});
  model.fails_above = 0.001;
  const Problem problem(two(), {curve}, {0}, {0.1}, model);
  const Optimum none = descend(problem, std::vector{0.5, 0.5});
  EXPECT_FALSE(none.converged);
  EXPECT_TRUE(std::isinf(none.cost));
  EXPECT_THAT(none.message, testing::HasSubstr("too stiff"));
}

/// Points at which a model was asked, each once, as CachedModel counts runs.
class Distinct final : public Model {
 public:
  explicit Distinct(const Model& inner) : inner_(inner) {}
  std::size_t curves() const override { return inner_.curves(); }
  Prediction predict(std::size_t c, std::span<const double> v) const override {
    const std::lock_guard guard(lock_);
    points_.insert({v.begin(), v.end()});
    return inner_.predict(c, v);
  }
  std::size_t runs() const { return points_.size(); }

 private:
  const Model& inner_;
  mutable std::mutex lock_;
  mutable std::set<std::vector<double>> points_;
};

struct Descents {
  Optimum full, secant;
  std::size_t full_runs = 0, secant_runs = 0;
};

/// The same descent with and without derivatives carried along.
Descents both(const std::vector<Parameter>& parameters, const Curve& curve, const testing_models::Formula::Function& f,
              const std::vector<double>& start, DescentOptions options = {}, Loss loss = {}) {
  const testing_models::Formula formula({curve}, f);
  Descents d;
  const auto go = [&](bool secant, std::size_t& runs) {
    const Distinct model(formula);
    const Problem problem(parameters, {curve}, {0}, {1.0}, model, loss);
    options.secant = secant;
    const Optimum found = descend(problem, problem.to_scaled(start), options);
    runs = model.runs();
    return found;
  };
  d.full = go(false, d.full_runs);
  d.secant = go(true, d.secant_runs);
  return d;
}

/// Pressed as a tissue that stiffens, F = E x exp(k x), with a force offset: three parameters of which two compensate.
double stiffening(double x, double, std::span<const double> v) { return v[0] * x * std::exp(v[1] * x) + v[2]; }
std::vector<Parameter> of_stiffening() {
  return {{"E", "", 0.1, 100.0, Scale::logarithmic, 1.0},
          {"k", "", 0.0, 4.0, Scale::linear, 1.0},
          {"F0", "", -1.0, 1.0, Scale::linear, 0.0}};
}
/// With a misfit that no parameters take up, so that the least cost is not 0.
Curve stiffening_curve() {
  Curve c = testing_models::plan(25, 0.0, 1.0);
  const std::vector<double> truth{3.0, 1.7, 0.1};
  for (std::size_t i = 0; i < c.size(); ++i)
    c.force[i] = stiffening(c.displacement[i], 1.0, truth) + 0.05 * std::sin(12.0 * c.displacement[i]);
  return c;
}

// Costs agree to the tolerance of the descent; z, whose square is the cost's rise, to its root.
void expect_same_optimum(const Descents& d, double tolerance) {
  EXPECT_TRUE(d.secant.converged) << d.secant.message;
  EXPECT_NEAR(d.secant.cost, d.full.cost, 2.0 * tolerance * d.full.cost + 1e-15);
  for (std::size_t p = 0; p < d.full.scaled.size(); ++p)
    EXPECT_NEAR(d.secant.scaled[p], d.full.scaled[p], 10.0 * std::sqrt(tolerance)) << p;
}

TEST(Secant, FindsTheSameOptimumInFewerRuns) {
  const Descents d = both(of_stiffening(), stiffening_curve(), stiffening, {0.2, 3.5, -0.5});
  expect_same_optimum(d, 1e-10);
  EXPECT_LT(d.secant_runs, 0.8 * static_cast<double>(d.full_runs));
  std::printf("stiffening: %zu runs by differences, %zu carried along\n", d.full_runs, d.secant_runs);
}

// Rosenbrock's valley, r = (10 (b − a²), 1 − a): the Jacobian turns all the way along it, and the optimum is exact.
TEST(Secant, FollowsABentValley) {
  const auto valley = [](double x, double, std::span<const double> v) {
    return x < 0.5 ? 10.0 * (v[1] - v[0] * v[0]) : 1.0 - v[0];
  };
  const std::vector<Parameter> plane{{"a", "", -2.0, 2.0, Scale::linear, 0.0},
                                     {"b", "", -2.0, 3.0, Scale::linear, 0.0}};
  const Descents d = both(plane, testing_models::plan(2, 0.0, 1.0), valley, {-1.2, 1.0});
  EXPECT_TRUE(d.secant.converged) << d.secant.message;
  EXPECT_LT(d.secant.cost, 1e-12);
  EXPECT_NEAR(d.secant.scaled[0], 0.75, 1e-6);
  EXPECT_NEAR(d.secant.scaled[1], 0.6, 1e-6);
  std::printf("valley: %zu runs by differences, %zu carried along\n", d.full_runs, d.secant_runs);
}

TEST(Secant, HoldsABoundThatIsActive) {
  std::vector<Parameter> low = of_stiffening();
  low[1].high = 1.2;  // the truth is 1.7
  const Descents d = both(low, stiffening_curve(), stiffening, {0.2, 0.3, -0.5});
  expect_same_optimum(d, 1e-10);
  EXPECT_GT(d.secant.scaled[1], 1.0 - 1e-9);
  EXPECT_LT(d.secant_runs, d.full_runs);
}

TEST(Secant, BearsARobustLoss) {
  Curve curve = stiffening_curve();
  curve.force[12] += 20.0;
  const Descents d =
      both(of_stiffening(), curve, stiffening, {1.0, 1.0, 0.0}, {}, {.kind = LossKind::cauchy, .scale = 0.1});
  expect_same_optimum(d, 1e-10);
  EXPECT_NEAR(d.secant.scaled[1], 1.7 / 4.0, 0.02);
}

// Forces of a simulation are rough functions of the parameters. With an amplitude of 1e-4 of the peak and differences of 1e-2
// the cost is told to 1e-3 or so; the descent ends, and as near to the smooth optimum as the roughness allows.
TEST(Secant, EndsOnARoughModel) {
  const auto rough = [](double x, double velocity, std::span<const double> v) {
    return stiffening(x, velocity, v) + 1.5e-3 * std::sin(1e4 * (v[0] + 2.0 * v[1] + 3.0 * v[2]) + 50.0 * x);
  };
  const Curve curve = stiffening_curve();
  const Descents smooth = both(of_stiffening(), curve, stiffening, {0.2, 3.5, -0.5});
  const testing_models::Formula formula({curve}, rough);
  const Distinct model(formula);
  Problem problem(of_stiffening(), {curve}, {0}, {1.0}, model);
  problem.difference_step = 1e-2;
  DescentOptions options;
  options.secant = true, options.tolerance = 1e-4;
  const Optimum found = descend(problem, problem.to_scaled(std::vector{0.2, 3.5, -0.5}), options);
  EXPECT_NEAR(found.cost, smooth.full.cost, 0.01 * smooth.full.cost);
  EXPECT_LT(model.runs(), 120u);
  std::printf("rough: %zu runs\n", model.runs());
}

TEST(Secant, SpendsNoMoreIterationsThanAllowed) {
  DescentOptions few;
  few.most_iterations = 3;
  const Descents d = both(of_stiffening(), stiffening_curve(), stiffening, {0.2, 3.5, -0.5}, few);
  EXPECT_FALSE(d.secant.converged);
  EXPECT_LE(d.secant.iterations, 3);
}

TEST(Problem, ScalesValuesBothWays) {
  const Curve curve = curve_of(1.0, 1.0);
  const Quadratic model({curve});
  const Problem problem(two(), {curve}, {0}, {0.1}, model);
  const std::vector<double> values{0.5, -7.5};
  const std::vector<double> z = problem.to_scaled(values);
  EXPECT_NEAR(z[1], 0.125, 1e-15);
  EXPECT_THAT(problem.to_values(z), testing::Pointwise(testing::DoubleNear(1e-12), values));
  const std::vector<double> slopes = problem.value_slopes(z);
  EXPECT_NEAR(slopes[0], 0.5 * std::log(1e4), 1e-12);
  EXPECT_NEAR(slopes[1], 20.0, 1e-12);
}

}  // namespace
}  // namespace glisson::fit
