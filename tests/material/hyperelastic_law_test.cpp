// Hyperelastic laws of the invariants know the slopes of their own energy.
#include "material/hyperelastic_formulas.h"

#include <gtest/gtest.h>

#include <cmath>

#include "material/dual.h"
#include "support/law_examples.h"

namespace glisson {
namespace {

/// `law.energy` on dual numbers gives what `law.slopes` says; i1 up to where exponents have ended.
template <class Law>
void expect_slopes(const Law& law) {
  for (const double i1 : {0.0, 1e-3, 0.4, 5.0, 14.9, 15.1, 40.0}) {
    const double i2 = 0.7 * i1;
    const InvariantSlopes<Dual> w = law.slopes(Dual{i1, 1.0}, Dual{i2}), v = law.slopes(Dual{i1}, Dual{i2, 1.0});
    const auto expect = [&](double slope, double derivative) {
      EXPECT_NEAR(slope, derivative, 1e-13 * std::abs(derivative)) << Law::kName << " at " << i1;
    };
    expect(w.first.v, law.energy(Dual{i1, 1.0}, Dual{i2}).d);
    expect(w.second.v, law.energy(Dual{i1}, Dual{i2, 1.0}).d);
    expect(w.bend.v, w.first.d);
    expect(w.mixed.v, w.second.d);
    expect(w.mixed.v, v.first.d);
    expect(w.second_bend.v, v.second.d);
    EXPECT_EQ(Law::kSecond != SecondInvariant::none, w.second.v != 0.0) << Law::kName;
    if (Law::kSecond != SecondInvariant::general) EXPECT_TRUE(w.mixed.v == 0.0 && w.second_bend.v == 0.0) << Law::kName;
  }
}

// ∂W/∂Ī₁, ∂W/∂Ī₂ and the three second slopes of every law are the derivatives of its energy, to rounding.
TEST(HyperelasticLaw, SlopesAreThoseOfTheEnergy) {
  for (const HyperelasticLaw& law : test::every_hyperelastic_law()) {
    std::visit(
        []<class Law>(const Law& l) {
          if constexpr (!std::is_same_v<Law, Ogden>)
            expect_slopes(l);  // a law of stretches: tests/material/energy_test.cpp
        },
        law);
  }
}

// Gent's chains have a hundredth of their length left where the parabola begins: W, its slope and its second slope are continuous,
// and the second slope, 10⁴ times that of rest, stays.
TEST(Limits, GentGoesOnAsAParabola) {
  const Gent law{.mu = 1300.0, .limit = 0.7};
  const double end = 0.7 * (1.0 - Gent::kLeast), below = end - 1e-12, above = end + 1e-12, far = 100.0;
  const InvariantSlopes<double> v = law.slopes(below, 0.0), w = law.slopes(above, 0.0), f = law.slopes(far, 0.0);
  EXPECT_NEAR(w.first, 650.0 / Gent::kLeast, 1e-6 * w.first);
  EXPECT_NEAR(v.first, w.first, 1e-8 * w.first);
  EXPECT_NEAR(v.bend, w.bend, 1e-8 * w.bend);
  EXPECT_NEAR(law.energy(above, 0.0), law.energy(below, 0.0), 1e-8 * law.energy(below, 0.0));
  EXPECT_EQ(f.bend, w.bend);
  EXPECT_NEAR(f.first, w.first + w.bend * (far - above), 1e-9 * f.first);
  const double risen = (far - above) * (w.first + 0.5 * w.bend * (far - above));
  EXPECT_NEAR(law.energy(far, 0.0), law.energy(above, 0.0) + risen, 1e-9 * risen);
  EXPECT_TRUE(std::isfinite(law.slopes(-2.9, 0.0).first)) << "a tet that has shrunk to nothing";
}

}  // namespace
}  // namespace glisson
