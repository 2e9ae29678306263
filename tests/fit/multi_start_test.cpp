// Many starts find the lower of two optima and say how often, tell a flat valley from two places, give the same bytes on one
// thread and on many, and go on from what is known.
#include "fit/search/multi_start.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

namespace glisson::fit {
namespace {

/// F(t) = v(p) sin-like in the first parameter: several optima on purpose.
class Wavy final : public Model {
 public:
  explicit Wavy(std::vector<double> at) : at_(std::move(at)) {}
  std::size_t curves() const override { return 1; }
  Prediction predict(std::size_t, std::span<const double> v) const override {
    Prediction p;
    for (const double x : at_) p.force.push_back(std::sin(v[0] * x) + v[1] * x);
    return p;
  }

 private:
  std::vector<double> at_;
};

/// F = a b x: only the product counts.
class Product final : public Model {
 public:
  explicit Product(std::vector<double> at) : at_(std::move(at)) {}
  std::size_t curves() const override { return 1; }
  Prediction predict(std::size_t, std::span<const double> v) const override {
    Prediction p;
    for (const double x : at_) p.force.push_back(v[0] * v[1] * x);
    return p;
  }

 private:
  std::vector<double> at_;
};

Curve curve_from(const Model& model, const std::vector<double>& at, const std::vector<double>& truth) {
  Curve c;
  c.time = c.displacement = at;
  c.force = model.predict(0, truth).force;
  return c;
}

std::vector<double> grid() {
  std::vector<double> at;
  for (int i = 0; i <= 40; ++i) at.push_back(0.05 * i);
  return at;
}

Problem wavy_problem(const Wavy& model) {
  return {{{"rate", "", 0.5, 20.0, Scale::linear, 18.0}, {"slope", "", -2.0, 2.0, Scale::linear, 0.0}},
          {curve_from(model, grid(), {7.0, 0.5})},
          {0},
          {0.05},
          model};
}

TEST(MultiStart, FindsTheLowestOfSeveralOptimaAndSaysHowOften) {
  const Wavy model(grid());
  const Problem problem = wavy_problem(model);
  const MultiStart found = find_optimum(problem, {.starts = 24});
  ASSERT_TRUE(found.complete);
  ASSERT_GE(found.basins.size(), 2u);  // the user's own start of 18 leads elsewhere
  EXPECT_THAT(problem.to_values(found.basins[0].scaled),
              testing::ElementsAre(testing::DoubleNear(7.0, 1e-5), testing::DoubleNear(0.5, 1e-5)));
  EXPECT_GE(found.basins[0].found, 2);
  int all = 0;
  for (const Basin& b : found.basins) all += b.found;
  EXPECT_EQ(all, 24);
  EXPECT_GT(found.starts[0].optimum.cost, 1.0);
}

TEST(MultiStart, StopsWhenTheBestWasFoundAgain) {
  const Wavy model(grid());
  const MultiStart found = find_optimum(wavy_problem(model), {.starts = 100, .found_again = 3});
  EXPECT_TRUE(found.complete);
  EXPECT_GE(found.basins[0].found, 3);
  EXPECT_LT(found.starts.size(), 100u);
}

TEST(MultiStart, AFlatValleyIsOneBasin) {
  const Product model(grid());
  const Problem problem({{"a", "", 0.1, 10.0, Scale::logarithmic, 1.0}, {"b", "", 0.1, 10.0, Scale::logarithmic, 1.0}},
                        {curve_from(model, grid(), {2.0, 1.5})}, {0}, {0.01}, model);
  const MultiStart found = find_optimum(problem, {.starts = 12});
  EXPECT_EQ(found.basins.size(), 1u);
  const std::vector<double> v = problem.to_values(found.basins[0].scaled);
  EXPECT_NEAR(v[0] * v[1], 3.0, 1e-6);
}

TEST(MultiStart, GivesTheSameBytesOnOneThreadAndOnMany) {
  const Wavy model(grid());
  const Problem problem = wavy_problem(model);
  const MultiStart many = find_optimum(problem, {.starts = 12});
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const MultiStart single = find_optimum(problem, {.starts = 12});
  ASSERT_EQ(many.starts.size(), single.starts.size());
  for (std::size_t i = 0; i < many.starts.size(); ++i)
    EXPECT_EQ(many.starts[i].optimum.scaled, single.starts[i].optimum.scaled) << i;
}

TEST(MultiStart, GoesOnFromWhatIsKnown) {
  const Wavy model(grid());
  const Problem problem = wavy_problem(model);
  const MultiStart whole = find_optimum(problem, {.starts = 12});
  std::vector<StartRecord> half(whole.starts.begin(), whole.starts.begin() + 5);
  const std::uint64_t before = problem.forward_runs();
  const MultiStart resumed = find_optimum(problem, {.starts = 12}, half);
  EXPECT_GT(problem.forward_runs(), before);
  ASSERT_EQ(resumed.starts.size(), 12u);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(resumed.starts[i].optimum.scaled, whole.starts[i].optimum.scaled) << i;
}

TEST(MultiStart, StopsWhenAsked) {
  const Wavy model(grid());
  const Problem problem = wavy_problem(model);
  std::atomic<bool> stop{false};
  MultiStartOptions options{.starts = 12};
  options.descent.stop = &stop;
  const MultiStart cut = find_optimum(problem, options, {}, [&](const MultiStart&) { stop = true; });
  EXPECT_FALSE(cut.complete);
  EXPECT_EQ(cut.starts.size(), 4u);
}

}  // namespace
}  // namespace glisson::fit
