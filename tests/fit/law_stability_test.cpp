// A fitted law that loses stability, dσ : dε ≤ 0, is told where: closed forms of Mooney and Rivlin's law with c01 < 0.
#include <gmock/gmock.h>

#include <cmath>

#include "fit/laws/law_stability.h"

namespace glisson::fit::law_stability_test {
namespace {

using ::testing::HasSubstr;

Tissue mooney_rivlin(double c10, double c01) {
  Tissue tissue;
  tissue.hyperelastic = MooneyRivlin{.c10 = c10, .c01 = c01, .bulk_modulus = 2e3 * (c10 + c01)};
  return tissue;
}

/// Where a slope has its zero, by bisection.
template <class Slope>
double zero(double a, double b, Slope slope) {
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (a + b);
    ((slope(a) > 0.0) == (slope(middle) > 0.0) ? a : b) = middle;
  }
  return a;
}

const StabilityResult& path(const std::vector<StabilityResult>& all, const std::string& name) {
  for (const StabilityResult& x : all) {
    if (x.path == name) return x;
  }
  throw std::runtime_error(name);
}

// Incompressible, σ = 2(λ² − 1/λ)(c10 + c01/λ): dσ/dλ = 0 where 2λ c10 + c10/λ² + c01 (1 + 2/λ³) = 0. The bulk modulus is 2000 times the
// shear modulus, and 200 parts of the path are on straight lines: 1 % of the stretch.
TEST(LawStability, UniaxialLossIsThatOfTheClosedForm) {
  constexpr double c10 = 1000.0, c01 = -400.0;
  const double lost =
      zero(0.4, 1.0, [&](double x) { return 2 * x * c10 + c10 / (x * x) + c01 * (1 + 2 / (x * x * x)); });
  const auto all =
      law_stability(mooney_rivlin(c10, c01), {.least_stretch = 0.9, .largest_stretch = 1.2, .largest_shear = 0.4});
  const StabilityResult& uniaxial = path(all, "uniaxial");
  ASSERT_TRUE(uniaxial.lost_below);
  EXPECT_NEAR(*uniaxial.lost_below, lost, 0.01 * lost);
  EXPECT_FALSE(uniaxial.lost_above);
  EXPECT_DOUBLE_EQ(uniaxial.high, 2.4);
}

// Equibiaxial, σ = 2(λ² − 1/λ⁴)(c10 + c01 λ²): dσ/dλ = 0 where (2λ + 4/λ⁵)(c10 + c01 λ²) + (λ² − 1/λ⁴) 2 c01 λ = 0: in tension, where the
// same law is stable in uniaxial tension. Simple shear has the modulus 2(c10 + c01) > 0 at any amount.
TEST(LawStability, EquibiaxialLossIsThatOfTheClosedForm) {
  constexpr double c10 = 1000.0, c01 = -300.0;
  const double lost = zero(1.0, 3.0, [&](double x) {
    return (2 * x + 4 / std::pow(x, 5)) * (c10 + c01 * x * x) + (x * x - std::pow(x, -4)) * 2 * c01 * x;
  });
  const DataRange range{.least_stretch = 0.95, .largest_stretch = 1.5, .largest_shear = 0.4};
  const auto all = law_stability(mooney_rivlin(c10, c01), range);
  const StabilityResult& biaxial = path(all, "equibiaxial");
  ASSERT_TRUE(biaxial.lost_above);
  EXPECT_NEAR(*biaxial.lost_above, lost, 0.01 * lost);
  const StabilityResult& shear = path(all, "simple_shear");
  EXPECT_FALSE(shear.lost_above);
  EXPECT_DOUBLE_EQ(shear.high, 0.8);
  EXPECT_THAT(stability_sentence(all, range), HasSubstr("equibiaxial stretch above"));
  EXPECT_THAT(stability_sentence(all, range), HasSubstr("within the range of the data"));
}

// Laws with positive terms are stable wherever they are looked at, and nothing is said.
TEST(LawStability, StableLawsAreSilent) {
  const DataRange range{.least_stretch = 0.8, .largest_stretch = 1.4, .largest_shear = 0.5};
  Tissue linear, gent;
  linear.youngs_modulus = 3000.0, linear.poisson_ratio = 0.45;
  gent.hyperelastic = Gent{.mu = 1000.0, .limit = 30.0, .bulk_modulus = 1e5};
  for (const Tissue& tissue : {linear, mooney_rivlin(500.0, 100.0), gent}) {
    const auto all = law_stability(tissue, range);
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(stability_sentence(all, range), "");
    EXPECT_LE(path(all, "uniaxial").low, 0.8);
  }
}

// The range is that of the data, of whatever homogeneous test; shear and stretch stand for each other.
TEST(LawStability, RangeIsThatOfTheData) {
  const auto curve = [](Deforming how, double most) {
    CurveResult c;
    c.curve.displacement = {0.0, most * 0.02}, c.curve.time = {0.0, 1.0}, c.curve.force = {0.0, 1.0};
    c.curve.measurement.deforming = how;
    return c;
  };
  const std::vector<CurveResult> both{curve(Deforming::compression, 0.3), curve(Deforming::tension, 0.2)};
  const DataRange range = data_range(both, 0.02, 0.0);
  EXPECT_NEAR(range.least_stretch, 0.7, 1e-12);
  EXPECT_NEAR(range.largest_stretch, 1.2, 1e-12);
  EXPECT_NEAR(range.largest_shear, 1.0 / 0.7 - 0.7, 1e-12);
  const DataRange sheared = data_range(std::vector{curve(Deforming::simple_shear, 0.5)}, 0.02, 0.0);
  EXPECT_NEAR(sheared.largest_shear, 0.5, 1e-12);
  EXPECT_NEAR(sheared.largest_stretch - sheared.least_stretch, 0.5, 1e-12) << "λ − 1/λ = γ";
}

}  // namespace
}  // namespace glisson::fit::law_stability_test
