// Errors per curve, group and set add up by samples, and repetitions are compared at the same displacements, where all have data.
#include "fit/uncertainty/validation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "small_models.h"

namespace glisson::fit {
namespace {

using testing_models::plan;

Curve ramp(double slope, double last, std::size_t points, bool held_out = false) {
  Curve c = plan(points, 0.0, last);
  c.name = std::to_string(slope);
  c.group = "2 mm/s";
  c.held_out = held_out;
  for (std::size_t i = 0; i < points; ++i) c.force[i] = slope * c.displacement[i];
  return c;
}

// Slopes 1, 2, 3 sampled differently: about their mean they are −x, 0, x; rms over 0 … 1 is √(2/3 · 1/3).
TEST(Validation, ComparesRepetitionsAtCommonDisplacements) {
  const std::vector<Curve> curves{ramp(1.0, 1.0, 20), ramp(2.0, 1.5, 37), ramp(3.0, 1.2, 91)};
  const std::vector<const Curve*> all{&curves[0], &curves[1], &curves[2]};
  const Spread s = spread_of(all);
  EXPECT_EQ(s.curves, 3u);
  EXPECT_DOUBLE_EQ(s.high, 1.0);
  // mean of x² on 200 equal points instead of the integral: 1/3 (1 + 1 / (2 · 199)) to first order
  EXPECT_NEAR(s.about_mean, std::sqrt(2.0 / 9.0), 2e-3);
  EXPECT_NEAR(s.deviation, s.about_mean * std::sqrt(1.5), 1e-12);
  EXPECT_NEAR(spread_of(all, 0.5).about_mean, 0.5 * s.about_mean, 1e-9);
}

// A cycle is compared on its way in alone.
TEST(Validation, TakesTheLoadingOfACycle) {
  Curve cycle = ramp(1.0, 1.0, 11);
  for (int i = 9; i >= 0; --i) {
    cycle.time.push_back(cycle.time.back() + 0.1);
    cycle.displacement.push_back(0.1 * i);
    cycle.force.push_back(-5.0);
  }
  const Curve other = ramp(1.0, 1.0, 50);
  const std::vector<const Curve*> both{&cycle, &other};
  EXPECT_NEAR(spread_of(both).about_mean, 0.0, 1e-12);
}

TEST(Validation, AddsUpBySamples) {
  const std::vector<Curve> curves{ramp(2.0, 1.0, 10), ramp(2.0, 1.0, 30), ramp(2.2, 1.0, 20, true)};
  std::vector<Prediction> predictions(3);
  const double error[] = {0.1, 0.2, 0.05};
  for (std::size_t k = 0; k < 3; ++k)
    for (const double f : curves[k].force) predictions[k].force.push_back(f + error[k]);
  const Validation v = validate(curves, predictions);
  EXPECT_NEAR(v.curves[1].rms, 0.2, 1e-12);
  EXPECT_NEAR(v.curves[1].mean, 0.2, 1e-12);
  EXPECT_NEAR(v.rms_fit, std::sqrt((10 * 0.01 + 30 * 0.04) / 40.0), 1e-12);
  EXPECT_NEAR(v.rms_heldout, 0.05, 1e-12);
  ASSERT_EQ(v.groups.size(), 1u);
  // slopes 2, 2, 2.2: standard deviation 0.2/√3 · x, rms over x: / √3: 0.067 N
  EXPECT_TRUE(v.groups[0].within_spread);
  EXPECT_NEAR(v.groups[0].spread.deviation, 0.2 / 3.0, 1e-3);
}

TEST(Validation, LeavesOutWhatLiesBeyondTheLimit) {
  const std::vector<Curve> curves{ramp(2.0, 1.0, 11)};
  std::vector<Prediction> predictions(1);
  for (const double x : curves[0].displacement) predictions[0].force.push_back(2.0 * x + (x > 0.55 ? 1.0 : 0.0));
  EXPECT_NEAR(validate(curves, predictions, 0.55).rms_fit, 0.0, 1e-12);
  EXPECT_EQ(validate(curves, predictions, 0.55).curves[0].samples, 6u);
  EXPECT_GT(validate(curves, predictions).rms_fit, 0.5);
}

TEST(Validation, TellsWhatCouldNotBePredicted) {
  const std::vector<Curve> curves{ramp(2.0, 1.0, 11), ramp(2.0, 1.0, 11, true)};
  std::vector<Prediction> predictions{{curves[0].force, ""}, {{}, "the mesh inverted"}};
  const Validation v = validate(curves, predictions);
  EXPECT_EQ(v.curves[1].failure, "the mesh inverted");
  EXPECT_TRUE(std::isnan(v.rms_heldout));
  EXPECT_FALSE(v.groups[0].within_spread);
  predictions.pop_back();
  EXPECT_THROW(validate(curves, predictions), std::invalid_argument);
}

}  // namespace
}  // namespace glisson::fit
