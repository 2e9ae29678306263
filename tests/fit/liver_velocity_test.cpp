// Viscous tissue by the paper's protocol: five specimens at 2 mm/s are fitted; five others at 2, five at 6 and five at 10 mm/s are predicted
// as well as they agree among themselves, and the mean of what the specimens were made of is inside the intervals.
#include <gtest/gtest.h>

#include <algorithm>

#include "fit/run_fit.h"
#include "support/places.h"

namespace glisson::fit {
namespace {

TEST(LiverVelocity, FittedAtOneSpeedPredictsOthers) {  // long
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
  ASSERT_EQ(result.curves.size(), 20u);
  // The means of five fitted and of five other specimens differ by √(2/5) t of their scatter, t Student's with 4 degrees of freedom: a
  // perfect law is within √(1 + 2/5 × 2.78²) = 2.0 times the scatter in 95 % of all draws; 1.09, 1.84, 1.08 and 1.00 measured.
  ASSERT_EQ(result.groups.size(), 4u);
  for (const GroupResult& g : result.groups) {
    EXPECT_EQ(g.held_out, g.name != "2 mm/s") << g.name;
    ASSERT_TRUE(g.spread) << g.name;
    EXPECT_LT(g.rms, 2.0 * *g.spread) << g.name;
  }
  // 4 % of scatter, 2 % of noise: no curve is further off than three deviations of both.
  for (const CurveResult& c : result.curves) {
    const double peak = *std::max_element(c.curve.force.begin(), c.curve.force.end());
    EXPECT_LT(c.rms, 0.134 * peak) << c.curve.name;
  }
}

}  // namespace
}  // namespace glisson::fit
