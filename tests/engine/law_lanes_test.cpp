// A law in lanes is its law in double: value and slope, over its range and at its corners.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/engine_run.h"
#include "material/stiffness_formulas.h"
#include "support/samples.h"

namespace glisson {
namespace {

using engine::Kernels;
using test::number;

constexpr std::size_t kCount = engine::kBlockTets;
constexpr double kUlp = 0x1p-23;  ///< of a float between 1 and 2

/// Arguments, and what a law makes of them.
struct Lanes {
  alignas(64) std::array<float, kCount> x{}, value{}, slope{};

  void run(const Kernels& kernels, const StiffnessLaw& law, double base, double unit) {
    const engine::LaneLaw lanes = engine::lane_law(law, base, unit);
    kernels.law[law.index()](lanes, x.data(), kCount, value.data(), slope.data());
  }
  /// From 0 to the largest intensity and a little beyond, ends included.
  static Lanes spread() {
    Lanes l;
    for (std::size_t i = 0; i < kCount; ++i) l.x[i] = 1.3F * float(i) / float(kCount - 1);
    return l;
  }
};

/// What float can hold of a law at x: `value` and `slope` are off by this much at most [modulus].
struct Bound {
  double value, slope;
};

/// What it does to any law that each of its numbers is off by e of itself, up or down.
template <class Law>
Bound bound_by_numbers(const Law& law, double base, double x, double e) {
  auto numbers = law.numbers(base);
  const ValueSlope<double> exact = law.at(numbers, x);
  Bound bound{0.0, 0.0};
  for (double& number : numbers) {
    const double kept = number;
    Bound largest{0.0, 0.0};
    for (const double factor : {1.0 - e, 1.0 + e}) {
      number = kept * factor;
      const ValueSlope<double> moved = law.at(numbers, x);
      largest.value = std::max(largest.value, std::abs(moved.value - exact.value));
      largest.slope = std::max(largest.slope, std::abs(moved.slope - exact.slope));
    }
    number = kept;
    bound.value += largest.value, bound.slope += largest.slope;
  }
  return bound;
}

/// `roundings` ulps of the largest term of the law's sum near x, and what the parameters and x, rounded to
/// float themselves, move its value by.
Bound bound_of(const StiffnessLaw& law, double base, double x, double roundings) {
  const double e = roundings * kUlp;
  if (const auto* step = std::get_if<StepLaw>(&law)) {
    // t = (x − threshold)/width + ½ is off by e times the larger of them over the width
    const double rise = std::abs(step->above - base), size = std::max(base, step->above);
    const double t = step->width > 0.0 ? e * std::max(x, step->threshold) / step->width : 0.0;
    return {e * size + 1.5 * rise * t, step->width > 0.0 ? rise / step->width * (6.0 * t + 1.5 * e) : 0.0};
  }
  if (const auto* exponential = std::get_if<ExponentialLaw>(&law)) {
    // the exponent b x is off by e b x, the exponential by that relative to itself
    const double E = std::min(exponential->rate * x, ExponentialLaw::kLargestExponent), grown = std::exp(E) * (1.0 + E);
    const double A = std::abs(exponential->amplitude);
    return {e * (std::abs(base) + A * grown), e * A * exponential->rate * grown};
  }
  if (const auto* table = std::get_if<TableLaw>(&law)) {
    const double largest = *std::max_element(table->moduli.begin(), table->moduli.end());
    const double slope = std::abs(law_derivative(law, base, x));
    return {e * (largest + slope * std::max(x, 1.0)), e * slope};
  }
  return std::visit([&](const auto& l) { return bound_by_numbers(l, base, x, e); }, law);
}

/// Whether the law's slope jumps within rounding of x: there either slope is right.
bool at_a_jump(const StiffnessLaw& law, double base, double x) {
  const double d = 8.0 * kUlp * std::max(x, 0.1);
  const double left = law_derivative(law, base, x - d), right = law_derivative(law, base, x + d);
  return std::abs(left - right) > 1e-3 * std::max(std::abs(left), std::abs(right));
}

/// Compares at every x; `base` is the modulus at rest [Pa], `unit` that of the lanes [Pa].
void expect_equal(const Kernels& kernels, const StiffnessLaw& law, double base, double unit) {
  Lanes lanes = Lanes::spread();
  constexpr double kRoundings = 8.0;
  lanes.run(kernels, law, base, unit);
  for (std::size_t i = 0; i < kCount; ++i) {
    const auto x = double(lanes.x[i]);
    const Bound bound = bound_of(law, base, x, kRoundings);
    const double value = law_value(law, base, x), slope = law_derivative(law, base, x);
    ASSERT_LE(std::abs(double(lanes.value[i]) * unit - value), bound.value)
        << law_name(law) << " at " << x << ": " << double(lanes.value[i]) * unit << ", exact " << value;
    if (at_a_jump(law, base, x)) continue;
    ASSERT_LE(std::abs(double(lanes.slope[i]) * unit - slope), bound.slope)
        << law_name(law) << ", slope at " << x << ": " << double(lanes.slope[i]) * unit << ", exact " << slope;
  }
}

class LawLanes : public testing::TestWithParam<const Kernels*> {
 protected:
  void expect_all(const StiffnessLaw& law, double base = 3600.0) const {
    SCOPED_TRACE(law_name(law));
    expect_equal(*GetParam(), law, base, base);  // a law on E, relative to it
    expect_equal(*GetParam(), law, base, 1.0);   // a law on λ or μ, in Pa
  }
};

// Random parameters of every law. Within 8 ulps of the largest term of the law's sum.
TEST_P(LawLanes, EqualTheLaws) {
  const bool held = rc::check([this] {
    const double base = number(500.0, 50000.0);
    const StiffnessLaw law = test::random_law(base);
    expect_all(law, base);
    RC_ASSERT(!HasFailure());
  });
  EXPECT_TRUE(held);
}

// The paper's sharp step: below the threshold M₀, at it and above it M₁, no slope anywhere.
TEST_P(LawLanes, SharpStepIncludesItsThreshold) {
  const StepLaw law{.threshold = 0.125, .above = 7200.0, .width = 0.0};
  Lanes lanes;
  lanes.x.fill(0.125F);
  for (std::size_t i = 0; i < kCount; i += 2) lanes.x[i] = std::nextafter(0.125F, 0.0F);
  lanes.run(*GetParam(), law, 3600.0, 3600.0);
  for (std::size_t i = 0; i < kCount; ++i) {
    EXPECT_EQ(lanes.value[i], i % 2 == 0 ? 1.0F : 2.0F);
    EXPECT_EQ(lanes.slope[i], 0.0F);
  }
  expect_all(law);
}

// A smooth step at its ends and in its middle, rising and falling, to nothing and from a negative λ.
TEST_P(LawLanes, SmoothSteps) {
  expect_all(StepLaw{.threshold = 0.5, .above = 36000.0, .width = 0.25});
  expect_all(StepLaw{.threshold = 0.0, .above = 36000.0, .width = 0.25});
  expect_all(StepLaw{.threshold = 0.5, .above = 0.0, .width = 2.0});
  expect_equal(*GetParam(), StepLaw{.threshold = 0.5, .above = 100.0, .width = 0.2}, -300.0, 1.0);
}

// A modulus that falls below 0 is 0 from there, without slope.
TEST_P(LawLanes, NegativeModuliAreZero) {
  for (const StiffnessLaw& law : std::vector<StiffnessLaw>{LinearLaw{-7200.0}, PolynomialLaw{{-10000.0, 0.0, 2000.0}},
                                                           ExponentialLaw{-500.0, 4.0}}) {
    expect_all(law);
    Lanes lanes = Lanes::spread();
    lanes.run(*GetParam(), law, 3600.0, 3600.0);
    EXPECT_EQ(lanes.value[kCount - 1], 0.0F) << law_name(law);
    EXPECT_EQ(lanes.slope[kCount - 1], 0.0F) << law_name(law);
  }
}

// The exponent stops at 60, so that the modulus of an inverted tet is finite; beyond there is no slope.
TEST_P(LawLanes, ExponentIsLimited) {
  const ExponentialLaw law{.amplitude = 10.0, .rate = 1000.0};
  expect_all(law);
  Lanes lanes = Lanes::spread();
  lanes.run(*GetParam(), law, 3600.0, 3600.0);
  EXPECT_TRUE(std::isfinite(lanes.value[kCount - 1]));
  EXPECT_EQ(lanes.slope[kCount - 1], 0.0F);
}

// A table is constant outside its range, for few points and many.
TEST_P(LawLanes, TablesEndFlat) {
  expect_all(TableLaw{{0.25, 0.75}, {3600.0, 1800.0}});
  expect_all(TableLaw{{-1.0, 2.0}, {0.0, 9000.0}});
  TableLaw many;
  for (int i = 0; i < 40; ++i) {
    many.arguments.push_back(0.03 * i + 0.01), many.moduli.push_back(3600.0 * (1.0 + std::sin(double(i))));
  }
  expect_all(many);
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, LawLanes, testing::ValuesIn(test::every_kernels()), test::kernels_name);

}  // namespace
}  // namespace glisson
