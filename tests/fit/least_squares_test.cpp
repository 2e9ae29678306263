// The descent finds the closed-form optimum of a linear model, stays within bounds, bears a bad point under a robust loss,
// and refuses a model that fails without throwing.
#include "fit/search/least_squares.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

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
