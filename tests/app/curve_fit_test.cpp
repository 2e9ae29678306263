// Fits that verdicts on figures rest on: exact on polynomials, and R² as it is defined.
#include "paper/curve_fit.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace glisson::app {
namespace {

// A quadratic in metres and newtons, as the figures have them, is recovered to rounding.
TEST(CurveFit, RecoversAPolynomial) {
  std::vector<double> x, y;
  for (int i = 0; i <= 100; ++i) {
    x.push_back(0.015 * i / 100);
    y.push_back(0.01 + 50.0 * x.back() + 3600.0 * x.back() * x.back());
  }
  const PolynomialFit fit = fit_polynomial(x, y, 2);
  EXPECT_NEAR(fit.coefficients[0], 0.01, 1e-12);
  EXPECT_NEAR(fit.coefficients[1], 50.0, 1e-8);
  EXPECT_NEAR(fit.coefficients[2], 3600.0, 1e-6);
  EXPECT_NEAR(fit.r2, 1.0, 1e-14);
  EXPECT_NEAR(fit(0.01), 0.01 + 0.5 + 0.36, 1e-12);
}

// R² of a line through (0,0), (1,1), (2,0) by hand: the best line is y = 1/3, which explains nothing.
TEST(CurveFit, RSquaredIsTheExplainedShare) {
  const std::vector<double> x{0, 1, 2}, peak{0, 1, 0}, rise{0, 1, 4};
  EXPECT_NEAR(fit_polynomial(x, peak, 1).r2, 0.0, 1e-14);
  // (0,0), (1,1), (2,4): line 2 x − 1/3, residuals 1/3, −2/3, 1/3, total 78/9 → R² = 1 − (6/9)/(78/9)
  EXPECT_NEAR(fit_polynomial(x, rise, 1).r2, 1.0 - 6.0 / 78.0, 1e-14);
  EXPECT_THROW(fit_polynomial(x, rise, 3), std::invalid_argument) << "three points do not fix four coefficients";
}

// Between points by straight lines, the outermost values beyond them.
TEST(CurveFit, InterpolatesByLines) {
  const std::vector<double> x{0, 1, 3}, y{0, 2, 4};
  EXPECT_DOUBLE_EQ(interpolate(x, y, 0.5), 1.0);
  EXPECT_DOUBLE_EQ(interpolate(x, y, 2.0), 3.0);
  EXPECT_DOUBLE_EQ(interpolate(x, y, -1.0), 0.0);
  EXPECT_DOUBLE_EQ(interpolate(x, y, 9.0), 4.0);
  EXPECT_DOUBLE_EQ(median({5, 1, 3}), 3.0);
  EXPECT_DOUBLE_EQ(median({4, 1, 3, 2}), 2.5);
}

// A line has no risers; one with two jumps, the second over two samples, has those two, at their places and heights.
TEST(CurveFit, FindsTheRisersOfAStaircase) {
  std::vector<double> line, stairs;
  for (int i = 0; i <= 100; ++i) {
    line.push_back(0.01 * i);
    stairs.push_back(0.01 * i + (i > 30 ? 0.2 : 0.0) + (i > 60 ? 0.1 : 0.0) + (i > 62 ? 0.1 : 0.0));
  }
  EXPECT_TRUE(risers(line).empty());
  const std::vector<Riser> found = risers(stairs);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].first, 30U);
  EXPECT_EQ(found[0].last, 30U);
  EXPECT_NEAR(found[0].height, 0.2, 1e-12);
  EXPECT_EQ(found[1].first, 60U);
  EXPECT_EQ(found[1].last, 62U);
  EXPECT_NEAR(found[1].height, 0.2, 1e-12);
}

}  // namespace
}  // namespace glisson::app
