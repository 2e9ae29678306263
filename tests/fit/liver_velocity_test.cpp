// Viscous tissue by the paper's protocol: fitted at 2 mm/s, 6 and 10 mm/s are predicted within the noise of the curves, and
// the parameters that made them are inside the intervals.
#include <gtest/gtest.h>

#include <algorithm>

#include "fit/run_fit.h"
#include "support/places.h"

namespace glisson::fit {
namespace {

TEST(LiverVelocity, FittedAtOneSpeedPredictsOthers) {
  FitSpec spec = load_fit(test::shipped("scenes/fit/liver_velocity.toml"));
  spec.search.starts = 1;
  spec.proof.profiles = false;
  spec.proof.bootstrap = 0;
  spec.proof.next = false;
  const FitResult result = run_fit(spec, {});
  ASSERT_EQ(result.parameters.size(), 3u);
  const double truth[] = {4000.0, 15000.0, 1000.0};
  for (std::size_t p = 0; p < 3; ++p) {
    ASSERT_TRUE(result.parameters[p].ci95());
    EXPECT_TRUE(result.parameters[p].ci95()->holds(truth[p]))
        << result.parameters[p].parameter.name << " = " << result.parameters[p].value;
  }
  ASSERT_EQ(result.curves.size(), 9u);
  for (const CurveResult& c : result.curves) {
    const double peak = *std::max_element(c.curve.force.begin(), c.curve.force.end());
    EXPECT_LT(c.rms, 0.02 * peak) << c.curve.name << ": the noise that was added to each reading";
  }
}

}  // namespace
}  // namespace glisson::fit
