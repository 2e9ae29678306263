// The series of U⁻¹ and tr U are the tensors as far as they say.
#include "material/root_series.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace glisson {
namespace {

// A thousand shapes at random; 1e-7 is the series' own limit, at shapes other than these.
TEST(RootSeries, IsTheRoot) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(0.0, 2.0 * std::numbers::pi);
  const RootSeries<> series = root_series();
  for (const double share : {1e-3, 0.1, 0.7, 1.0}) {
    const double delta = share * std::sqrt(4.0 / 3.0 * series.largest_J2), J2 = 0.75 * delta * delta;
    for (int n = 0; n < 250; ++n) {
      const double turn = angle(random), step = 2.0 * std::numbers::pi / 3.0;
      const std::array<double, 3> x{delta * std::cos(turn), delta * std::cos(turn + step),
                                    delta * std::cos(turn - step)};
      const double J3 = x[0] * x[1] * x[2], second = series_at(series.second, J2, J3);
      double trace = -3.0;
      for (const double xi : x) {
        const double bent = series_at(series.whole, J2, J3) + series_at(series.first, J2, J3) * xi;
        EXPECT_NEAR(1.0 + bent + second * (xi * xi - J2), 1.0 / std::sqrt(1.0 + xi), 1.1e-7 * delta) << share;
        trace += std::sqrt(1.0 + xi);
      }
      EXPECT_NEAR(series_at(series.trace, J2, J3), trace, 1.1e-7 * delta) << share;
    }
  }
}

// Half of δ is about the largest strain: 17 %.
TEST(RootSeries, HoldsForTheStrainsOfTissue) { EXPECT_GE(std::sqrt(4.0 / 3.0 * root_series().largest_J2), 0.34); }

// What is of second order at rest starts there: tr U/√m − 3 = −¼ J₂, U⁻¹ = I − ½ X.
TEST(RootSeries, BeginsAsTheRootDoes) {
  const RootSeries<> series = root_series();
  EXPECT_EQ(series.trace[0][0], 0.0);
  EXPECT_DOUBLE_EQ(series.trace[0][1], -0.25);
  EXPECT_EQ(series.whole[0][0], 0.0);
  EXPECT_DOUBLE_EQ(series.first[0][0], -0.5);
}

}  // namespace
}  // namespace glisson
