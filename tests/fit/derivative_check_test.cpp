// The step of the differences falls where truncation and rounding are both small, and the error told bounds the true one.
#include "fit/search/derivative_check.h"

#include <gtest/gtest.h>

#include <cmath>

namespace glisson::fit {
namespace {

/// F = exp(a x) rounded to a grain, as a simulation in single precision would give it.
class Grainy final : public Model {
 public:
  explicit Grainy(double grain) : grain_(grain) {}
  std::size_t curves() const override { return 1; }
  Prediction predict(std::size_t, std::span<const double> v) const override {
    Prediction p;
    for (int i = 1; i <= 20; ++i) {
      const double f = std::exp(v[0] * 0.1 * i);
      p.force.push_back(grain_ > 0.0 ? grain_ * std::round(f / grain_) : f);
    }
    return p;
  }

 private:
  double grain_;
};

Problem problem_of(const Model& model) {
  Curve c;
  for (int i = 1; i <= 20; ++i) {
    c.time.push_back(i);
    c.displacement.push_back(0.1 * i);
    c.force.push_back(1.0);
  }
  return {{{"a", "", 0.0, 4.0, Scale::linear, 1.0}}, {c}, {0}, {1.0}, model};
}

double true_error(const Problem& problem, double z) {
  const Residuals r = problem.residuals(std::vector{z}, true);
  double apart = 0.0, length = 0.0;
  for (int i = 1; i <= 20; ++i) {
    const double x = 0.1 * i, exact = 4.0 * x * std::exp(4.0 * z * x);
    const double d = r.jacobian[static_cast<std::size_t>(i - 1)] - exact;
    apart += d * d;
    length += exact * exact;
  }
  return std::sqrt(apart / length);
}

TEST(DerivativeCheck, TakesNarrowStepsOfASmoothModel) {
  const Grainy model(0.0);
  Problem problem = problem_of(model);
  const DerivativeCheck check = check_derivatives(problem, std::vector{0.4});
  EXPECT_LE(check.step, 1e-4);
  EXPECT_LT(check.error, 1e-6);
  EXPECT_LE(true_error(problem, 0.4), check.error);
}

TEST(DerivativeCheck, TakesWideStepsOfAGrainyModel) {
  const Grainy model(1e-4);
  Problem problem = problem_of(model);
  const DerivativeCheck check = check_derivatives(problem, std::vector{0.4});
  EXPECT_GE(check.step, 1e-3);
  EXPECT_LT(check.error, 0.02);
  EXPECT_LE(true_error(problem, 0.4), 2.0 * check.error);  // both neighbours carry rounding of the same size
}

// A dear model is not run for digits that nobody needs.
TEST(DerivativeCheck, StopsWhereItIsEnough) {
  const Grainy model(0.0);
  Problem all = problem_of(model), few = problem_of(model);
  check_derivatives(all, std::vector{0.4});
  const DerivativeCheck check = check_derivatives(few, std::vector{0.4}, 2e-3);  // (4 x h)²/6 is 1.1e-3 for h = 1e-2
  EXPECT_EQ(2 * few.forward_runs(), all.forward_runs());
  EXPECT_EQ(check.step, 1e-3);
  EXPECT_LT(check.error, 2e-3);
  EXPECT_LE(true_error(few, 0.4), check.error);
}

/// Fails from a number of its parameter on.
class Bounded final : public Model {
 public:
  explicit Bounded(double end) : end_(end) {}
  std::size_t curves() const override { return 1; }
  Prediction predict(std::size_t c, std::span<const double> v) const override {
    if (v[0] > end_) return {{}, "fails there"};
    return Grainy(0.0).predict(c, v);
  }

 private:
  double end_;
};

// Beside a place where the model fails the widest step has no derivative; the narrower ones have, and are compared with each other. Where
// all fail no number is made up.
TEST(DerivativeCheck, GoesToNarrowerStepsBesideAFailure) {
  const Bounded near(4.0 * 0.405), at(4.0 * 0.4);  // z = 0.4 and 0.005 or nothing beyond
  Problem problem = problem_of(near);
  const DerivativeCheck check = check_derivatives(problem, std::vector{0.4});
  EXPECT_GT(check.step, 0.0);
  EXPECT_LT(check.error, 1e-3);
  EXPECT_EQ(problem.difference_step, check.step);
  EXPECT_LE(true_error(problem, 0.4), check.error);
  Problem none = problem_of(at);
  const double before = none.difference_step;
  EXPECT_EQ(check_derivatives(none, std::vector{0.4}).step, 0.0);
  EXPECT_EQ(none.difference_step, before);
}

}  // namespace
}  // namespace glisson::fit
