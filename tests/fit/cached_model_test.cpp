// A forward run is made once for curves of the same history and for a point asked again, from any number of threads, and what
// is forgotten is made again with the same result.
#include "fit/search/cached_model.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

namespace glisson::fit {
namespace {

class Counting final : public Model {
 public:
  std::size_t curves() const override { return 3; }
  Prediction predict(std::size_t c, std::span<const double> v) const override {
    ++runs;
    return {{static_cast<double>(c) + v[0]}, ""};
  }
  mutable std::atomic<int> runs{0};
};

std::vector<Curve> curves() {
  Curve a, b, c;
  a.time = b.time = c.time = {0.0, 1.0};
  a.displacement = b.displacement = {0.0, 1.0};
  c.displacement = {0.0, 2.0};
  a.force = {0.0, 5.0};
  b.force = {0.0, 6.0};
  return {a, b, c};
}

TEST(CachedModel, RunsRepetitionsOnce) {
  const auto inner = std::make_shared<Counting>();
  const CachedModel model(inner, curves());
  const std::vector<double> at{0.5};
  EXPECT_EQ(model.predict(0, at).force[0], 0.5);
  EXPECT_EQ(model.predict(1, at).force[0], 0.5);  // the run of curve 0
  EXPECT_EQ(model.predict(2, at).force[0], 2.5);
  EXPECT_EQ(model.predict(2, std::vector{0.25}).force[0], 2.25);
  EXPECT_EQ(inner->runs, 3);
  EXPECT_EQ(model.runs(), 3u);
}

TEST(CachedModel, KeepsApartCurvesWithParametersOfTheirOwn) {
  const auto inner = std::make_shared<Counting>();
  const CachedModel model(inner, curves(), {0, 1, 0});
  EXPECT_EQ(model.predict(1, std::vector{0.5}).force[0], 1.5);
}

// Storage and loss modulus over the same frequencies are two answers, as tension and compression by the same strains are.
TEST(CachedModel, KeepsApartOtherTests) {
  const auto inner = std::make_shared<Counting>();
  std::vector<Curve> tests = curves();
  tests[1].measurement.measured = Measured::loss;
  const CachedModel model(inner, tests);
  EXPECT_EQ(model.predict(1, std::vector{0.5}).force[0], 1.5);
}

TEST(CachedModel, ManyThreadsWaitForOneRun) {
  const auto inner = std::make_shared<Counting>();
  const CachedModel model(inner, curves());
  tbb::parallel_for(0, 1000, [&](int i) { model.predict(0, std::vector{static_cast<double>(i % 4)}); });
  EXPECT_EQ(inner->runs, 4);
}

TEST(CachedModel, MakesAgainWhatItForgot) {
  const auto inner = std::make_shared<Counting>();
  const CachedModel model(inner, curves(), {}, 2);
  for (int round = 0; round < 2; ++round)
    for (int i = 0; i < 5; ++i) EXPECT_EQ(model.predict(0, std::vector{1.0 * i}).force[0], i);
  EXPECT_EQ(inner->runs, 10);
}

}  // namespace
}  // namespace glisson::fit
