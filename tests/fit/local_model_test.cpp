// A cubic takes the place of a dear model about an optimum where it is as good, and nowhere else.
#include "fit/forward/local_model.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "fit/small_models.h"
#include "fit/uncertainty/local_problem.h"

namespace glisson::fit::local_model_test {
namespace {

using namespace testing_models;

double cubic(double x, double, std::span<const double> v) {
  return x * v[0] + x * x * v[1] * v[0] * v[0] + v[1] * v[1] * v[1];
}

/// Counts the runs of a model.
class Counting final : public Model {
 public:
  explicit Counting(const Model& inner) : inner_(inner) {}
  std::size_t curves() const override { return inner_.curves(); }
  Prediction predict(std::size_t c, std::span<const double> values) const override {
    ++runs;
    return inner_.predict(c, values);
  }
  mutable std::atomic<int> runs{0};

 private:
  const Model& inner_;
};

// Forces that are cubics of the parameters come out to rounding, without another run; outside the region the model runs.
TEST(LocalModel, IsExactForCubicsAndLeavesTheRestToTheModel) {
  const Formula formula({plan(9, 0.0, 1.0)}, cubic);
  const Counting model(formula);
  const LocalModel local(model, {0}, {{2.0, 3.0}, {{0.2, 0.1}, {-0.1, 0.3}}});
  ASSERT_EQ(local.failure(), "");
  EXPECT_EQ(model.runs, static_cast<int>(LocalModel::runs_for(2)));
  EXPECT_LT(local.error(0), 1e-10);
  const std::vector<double> inside{2.1, 3.2}, outside{2.6, 3.0};
  const int before = model.runs;
  const Prediction near = local.predict(0, inside);
  EXPECT_EQ(model.runs, before);
  const Prediction truth = formula.predict(0, inside);
  for (std::size_t i = 0; i < truth.force.size(); ++i) EXPECT_NEAR(near.force[i], truth.force[i], 1e-10);
  EXPECT_EQ(local.predict(0, outside).force, formula.predict(0, outside).force);
  EXPECT_EQ(model.runs, before + 1);
}

// A run that fails leaves no cubic, and says why.
TEST(LocalModel, SaysWhyThereIsNone) {
  class Failing final : public Model {
   public:
    std::size_t curves() const override { return 1; }
    Prediction predict(std::size_t, std::span<const double>) const override { return {{}, "too soft"}; }
  } const model;
  EXPECT_EQ(LocalModel(model, {0}, {{1.0}, {{0.1}}}).failure(), "too soft");
}

struct Fitted {
  Twin twin;
  Optimum optimum;
  Covariance known;
  Fitted(Formula::Function f, double spread)
      : twin({{"a", "", 0.1, 10.0, Scale::logarithmic, 1.0}, {"b", "", 0.1, 10.0, Scale::logarithmic, 1.0}},
             noisy(f, spread), spread, f) {
    const std::vector<double> start = twin.problem.to_scaled(std::vector{1.0, 2.0});
    optimum = descend(twin.problem, start);
    known = covariance(twin.problem, optimum.scaled);
  }
  static std::vector<Curve> noisy(const Formula::Function& f, double spread) {
    std::vector<Curve> curves = simulate(plan(40, 0.05, 1.0), 3, f, {1.2, 2.2});
    Noise noise(7);
    for (Curve& c : curves) {
      for (double& force : c.force) force += spread * noise();
    }
    return curves;
  }
};

double smooth(double x, double, std::span<const double> v) {
  return v[0] * x + v[1] * x * x * x + 0.1 * std::exp(v[0] * x);
}

// Profiles over the cubic end where those over the model end: to a thousandth of the intervals' width.
TEST(LocalProblem, ProfilesEndWhereTheModelsDo) {
  const Fitted f(smooth, 0.02);
  const auto local = LocalProblem::about(f.twin.problem, f.known);
  ASSERT_NE(local, nullptr);
  const Profiles by_runs = profiles(f.twin.problem, f.optimum, f.known);
  const std::uint64_t before = f.twin.problem.forward_runs();
  const Profiles by_cubic = profiles(local->problem(), f.optimum, f.known);
  EXPECT_EQ(f.twin.problem.forward_runs(), before) << "the model's own problem is not asked";
  EXPECT_TRUE(local->holds(by_cubic, f.optimum.cost)) << local->words();
  for (std::size_t p = 0; p < 2; ++p) {
    const Interval &a = by_runs.of[p].interval, &b = by_cubic.of[p].interval;
    EXPECT_NEAR(a.low, b.low, 2e-3 * (a.high - a.low));
    EXPECT_NEAR(a.high, b.high, 2e-3 * (a.high - a.low));
  }
}

// A force that has a kink within the region is no cubic: the model itself is asked then.
TEST(LocalProblem, IsNotTakenWhereForcesAreRough) {
  const auto rough = [](double x, double velocity, std::span<const double> v) {
    return smooth(x, velocity, v) + 0.05 * std::sin(300.0 * v[0]) * x;
  };
  EXPECT_EQ(LocalProblem::about(Fitted(rough, 0.02).twin.problem, Fitted(smooth, 0.02).known), nullptr);
}

// Curves that do not tell two parameters apart give no region.
TEST(LocalProblem, IsNotTakenWhereADirectionIsNotDetermined) {
  const Fitted f([](double x, double, std::span<const double> v) { return v[0] * v[1] * x; }, 0.02);
  EXPECT_EQ(LocalProblem::about(f.twin.problem, f.known), nullptr);
}

}  // namespace
}  // namespace glisson::fit::local_model_test
