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
    if (Law::kSecond != SecondInvariant::general) {
      EXPECT_TRUE(w.mixed.v == 0.0 && w.second_bend.v == 0.0) << Law::kName;
    }
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

/// That slopes and energy of two laws agree to rounding.
template <class A, class B>
void expect_same(const A& a, const B& b) {
  for (const double i1 : {0.0, 1e-3, 0.4, 3.0, 40.0}) {
    const double i2 = 1.3 * i1;
    const InvariantSlopes<double> v = a.slopes(i1, i2), w = b.slopes(i1, i2);
    const auto expect = [&](double x, double y) { EXPECT_NEAR(x, y, 1e-14 * std::abs(y)) << B::kName << " at " << i1; };
    expect(v.first, w.first);
    expect(v.second, w.second);
    expect(v.bend, w.bend);
    EXPECT_EQ(v.mixed, 0.0);
    EXPECT_EQ(v.second_bend, 0.0);
    EXPECT_NEAR(a.energy(i1, i2), b.energy(i1, i2), 1e-13 * std::abs(b.energy(i1, i2))) << B::kName << " at " << i1;
  }
  EXPECT_DOUBLE_EQ(a.shear_modulus(), b.shear_modulus());
}

// A sum of terms of the invariants is neo-Hooke's, Mooney and Rivlin's, Yeoh's and Fung's law where only their terms are there.
TEST(Invariants, ContainTheLawsOfTheirTerms) {
  expect_same(Invariants{.c10 = 650.0}, NeoHookean{.mu = 1300.0});
  expect_same(Invariants{.c10 = 400.0, .c01 = 250.0}, MooneyRivlin{.c10 = 400.0, .c01 = 250.0});
  expect_same(Invariants{.c10 = 650.0, .c20 = 120.0, .c30 = 15.0}, Yeoh{.c1 = 650.0, .c2 = 120.0, .c3 = 15.0});
  expect_same(Invariants{.a1 = 1300.0, .b1 = 0.8}, Fung{.mu = 1300.0, .b = 0.8});
}

// An exponential ends at an exponent of 12: W and its slope are continuous there, the slope stays what it is, and all is finite
// however far a tet is out. Both sides differ by the slope times 2e-9 of x.
TEST(Limits, EnergyGoesOnAlongItsTangent) {
  const auto expect = [](const auto& law, bool second, double end) {
    const auto energy = [&](double x) { return second ? law.energy(0.0, x) : law.energy(x, 0.0); };
    const auto slope = [&](double x) {
      const InvariantSlopes<double> w = second ? law.slopes(0.0, x) : law.slopes(x, 0.0);
      EXPECT_TRUE(std::isfinite(w.first) && std::isfinite(w.second) && std::isfinite(w.bend + w.second_bend))
          << law.kName;
      if (x > end) {
        EXPECT_EQ(second ? w.second_bend : w.bend, 0.0) << law.kName;
      }
      return second ? w.second : w.first;
    };
    const double below = end * (1.0 - 1e-9), above = end * (1.0 + 1e-9), far = 1e6 * end;
    EXPECT_NEAR(slope(above), slope(below), 1e-4 * slope(above)) << law.kName;
    EXPECT_NEAR(energy(above) - energy(below), slope(above) * (above - below), 1e-4 * slope(above) * (above - below));
    EXPECT_EQ(slope(far), slope(above)) << law.kName;
    EXPECT_NEAR(energy(far), energy(above) + slope(above) * (far - above), 1e-12 * energy(far)) << law.kName;
    EXPECT_TRUE(std::isfinite(slope(-2.9))) << "a tet that has shrunk to nothing";
  };
  expect(Invariants{.a1 = 1300.0, .b1 = 3.0}, false, 4.0);
  expect(Invariants{.a2 = 1300.0, .b2 = 3.0}, true, 4.0);
  expect(Invariants{.c10 = 1.0, .q1 = 1300.0, .r1 = 3.0}, false, 2.0);
  expect(Invariants{.c10 = 1.0, .q2 = 1300.0, .r2 = 3.0}, true, 2.0);
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

// What a sum needs is said in words: a shear modulus above 0, whichever terms it comes from.
TEST(Invariants, NeedAShearModulus) {
  EXPECT_NE(Invariants{}.check(), "");
  EXPECT_NE((Invariants{.c10 = 200.0, .c01 = -200.0, .q2 = 1000.0}.check()), "");
  EXPECT_EQ((Invariants{.c10 = 200.0, .c01 = -150.0}.check()), "");
  EXPECT_EQ((Invariants{.c10 = -200.0, .a2 = 500.0}.check()), "");
}

}  // namespace
}  // namespace glisson
