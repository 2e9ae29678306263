// Laws of stiffness: each does what its formula says, in float and double, and knows its own derivative.
#include "material/stiffness_formulas.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "glisson/material/tissue.h"
#include "material/dual.h"
#include "support/law_examples.h"

namespace glisson {
namespace {

using test::kExampleModulus;

constexpr double kBase = 3600.0;

// The slope is the derivative of the value, which the same formula gives on dual numbers. Some roundings of the largest term.
TEST(StiffnessLaw, SlopeIsThatOfTheValue) {
  for (const StiffnessLaw& law : test::every_stiffness_law()) {
    for (const double x : {0.03, 0.087, 0.11, 0.25, 0.37, 0.9}) {
      const ValueSlope<Dual> m = law_at(law, kExampleModulus, Dual{x, 1.0});
      EXPECT_NEAR(m.slope.v, m.value.d, 1e-14 * (kExampleModulus + std::abs(m.value.d)))
          << law_name(law) << " at " << x;
    }
  }
}

// At rest every law here starts from the base modulus.
TEST(StiffnessLaw, StartsAtTheBaseModulus) {
  for (const StiffnessLaw& law : test::every_stiffness_law()) {
    EXPECT_DOUBLE_EQ(law_value(law, kExampleModulus, 0.0), kExampleModulus) << law_name(law);
  }
}

// Float follows double to a few units of its own rounding.
TEST(StiffnessLaw, FloatFollowsDouble) {
  for (const StiffnessLaw& law : test::every_stiffness_law()) {
    for (const double x : {0.0, 0.03, 0.11, 0.25, 0.9}) {
      const double exact = law_value(law, kExampleModulus, x);
      const double in_float = double(law_at(law, kExampleModulus, static_cast<float>(x)).value);
      EXPECT_NEAR(in_float, exact, 1e-5 * exact) << law_name(law) << " at " << x;
    }
  }
}

template <class... Laws>
void expect_values_by_hand(std::type_identity<std::variant<Laws...>>) {
  const auto expect = []<class Law>(std::type_identity<Law>) {
    using Example = test::LawExample<Law>;
    EXPECT_DOUBLE_EQ(law_value(Example::law(), kExampleModulus, Example::kAt), Example::kModulus) << Law::kName;
  };
  (expect(std::type_identity<Laws>()), ...);
}

// Each law at a point where its modulus has been worked out by hand.
TEST(StiffnessLaw, ValuesByHand) { expect_values_by_hand(std::type_identity<StiffnessLaw>()); }

// Closed forms at single points.
TEST(StiffnessLaw, ClosedForms) {
  EXPECT_DOUBLE_EQ(law_value(StepLaw{.threshold = 0.1, .above = 7200.0}, kBase, 0.0999), 3600.0);
  EXPECT_DOUBLE_EQ(law_value(StepLaw{.threshold = 0.1, .above = 7200.0}, kBase, 0.1), 7200.0);
  EXPECT_DOUBLE_EQ(law_value(StepLaw{.threshold = 0.1, .above = 7200.0, .width = 0.02}, kBase, 0.1), 5400.0);
  EXPECT_DOUBLE_EQ(law_value(LinearLaw{1000.0}, kBase, 0.5), 4100.0);
  EXPECT_DOUBLE_EQ(law_value(PolynomialLaw{{10.0, 100.0}}, kBase, 2.0), 4020.0);
  EXPECT_DOUBLE_EQ(law_value(ExponentialLaw{.amplitude = 100.0, .rate = 2.0}, kBase, 1.0),
                   3600.0 + 100.0 * std::expm1(2.0));
  EXPECT_DOUBLE_EQ(law_value(TableLaw{{0.0, 1.0}, {100.0, 300.0}}, kBase, 0.25), 150.0);
}

// A modulus never becomes negative or infinite, whatever the argument of an inverted tetrahedron.
TEST(StiffnessLaw, StaysFiniteAndNotNegative) {
  const std::vector<StiffnessLaw> harsh{LinearLaw{-1e6}, PolynomialLaw{{-1e6, -1e6}}, ExponentialLaw{-1e6, 900.0},
                                        ExponentialLaw{1e3, 1000.0}, TableLaw{{0.2, 0.3}, {0.0, 5.0}}};
  for (const StiffnessLaw& law : harsh) {
    for (const double x : {0.0, 0.5, 1.0, 1.2247}) {
      EXPECT_GE(law_value(law, kBase, x), 0.0) << law_name(law);
      EXPECT_TRUE(std::isfinite(law_value(law, kBase, x)) && std::isfinite(law_derivative(law, kBase, x)))
          << law_name(law);
    }
  }
}

// The Lamé parameters of E = 3600 Pa, ν = 0.4 are those of the paper's tissue.
TEST(Tissue, LameParametersOfThePaper) {
  const LameParameters lame = Tissue{}.lame();
  EXPECT_NEAR(lame.lambda, 5142.857, 1e-3);
  EXPECT_NEAR(lame.mu, 1285.714, 1e-3);
}

// A law on E scales λ and μ alike, which keeps ν; laws on λ and μ act apart.
TEST(Tissue, LawsOnYoungOrOnLame) {
  Tissue tissue;
  tissue.law = LinearLaw{3600.0};
  EXPECT_NEAR(lame_at(tissue, 1.0).lambda, 2.0 * tissue.lame().lambda, 1e-9);
  EXPECT_NEAR(lame_at(tissue, 1.0).mu, 2.0 * tissue.lame().mu, 1e-9);
  tissue.law = ConstantLaw{};
  tissue.mu_law = LinearLaw{1000.0};
  EXPECT_DOUBLE_EQ(lame_at(tissue, 1.0).lambda, tissue.lame().lambda);
  EXPECT_DOUBLE_EQ(lame_at(tissue, 1.0).mu, tissue.lame().mu + 1000.0);
}

struct BadTissue {
  const char* fragment;
  std::function<void(Tissue&)> spoil;
};

// Each precondition of a tissue is refused with the field, its value and the range.
TEST(Tissue, RefusesWhatMeansNothing) {
  const BadTissue cases[] = {
      {"youngs_modulus [Pa] = -1", [](Tissue& t) { t.youngs_modulus = -1.0; }},
      {"youngs_modulus [Pa] = inf", [](Tissue& t) { t.youngs_modulus = INFINITY; }},
      {"poisson_ratio = 0.5", [](Tissue& t) { t.poisson_ratio = 0.5; }},
      {"poisson_ratio = nan", [](Tissue& t) { t.poisson_ratio = NAN; }},
      {"density [kg/m³] = 0", [](Tissue& t) { t.density = 0.0; }},
      {"viscosity [Pa·s] = -2", [](Tissue& t) { t.viscosity = -2.0; }},
      {"law (polynomial): `coefficients_Pa` needs", [](Tissue& t) { t.law = PolynomialLaw{}; }},
      {"mu_law (table): `arguments` must be strictly",
       [](Tissue& t) {
         t.mu_law = TableLaw{{0.0, 0.0}, {1.0, 1.0}};
       }},
      {"contradict each other", [](Tissue& t) { t.law = LinearLaw{1.0}, t.mu_law = ConstantLaw{}; }},
  };
  for (const BadTissue& c : cases) {
    Tissue tissue;
    c.spoil(tissue);
    try {
      require_valid(tissue);
      ADD_FAILURE() << "accepted: " << c.fragment;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(c.fragment), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace glisson
