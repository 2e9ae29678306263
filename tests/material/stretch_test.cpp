// Bars, sheets and squashed tetrahedra: stresses known in closed form, and what must hold where no form is known.
//
// Nearly incompressible is κ = 10⁷ μ here: stresses differ from those of the incompressible law by some μ/κ, times
// some hundreds where the law is steep: 1e-4 of themselves.
#include <gtest/gtest.h>

#include "material/every_tissue.h"
#include "material/principal.h"
#include "material/volume_powers.h"

namespace glisson {
namespace {

using test::Specimen;

/// ∂W/∂Ī₁ and ∂W/∂Ī₂ as their authors write them.
struct Slopes {
  double first, second;
};
Slopes slopes(const HyperelasticLaw& law, double I1, double I2) {
  const reference::InvariantEnergy w = reference::invariant_energy(law, I1 - 3.0, I2 - 3.0);
  return {static_cast<double>(w.first), static_cast<double>(w.second)};
}

/// Engineering stress of an incompressible bar stretched by l: 2 (l − l⁻²) (W₁ + W₂/l).
template <class Law>
double bar(const Law& law, double l) {
  const Slopes w = slopes(law, l * l + 2.0 / l, 2.0 * l + 1.0 / (l * l));
  return 2.0 * (l - 1.0 / (l * l)) * (w.first + w.second / l);
}
double bar(const Ogden& law, double l) {
  double P = 0.0;
  for (std::size_t k = 0; k < law.mu.size(); ++k) {
    P += 2.0 * law.mu[k] / law.alpha[k] * (std::pow(l, law.alpha[k] - 1.0) - std::pow(l, -0.5 * law.alpha[k] - 1.0));
  }
  return P;
}
/// Engineering stress of an incompressible sheet stretched by l both ways: 2 (l − l⁻⁵) (W₁ + l² W₂).
template <class Law>
double sheet(const Law& law, double l) {
  const Slopes w = slopes(law, 2.0 * l * l + std::pow(l, -4.0), std::pow(l, 4.0) + 2.0 / (l * l));
  return 2.0 * (l - std::pow(l, -5.0)) * (w.first + l * l * w.second);
}
double sheet(const Ogden& law, double l) {
  double P = 0.0;
  for (std::size_t k = 0; k < law.mu.size(); ++k) {
    P += 2.0 * law.mu[k] / law.alpha[k] * (std::pow(l, law.alpha[k] - 1.0) - std::pow(l, -2.0 * law.alpha[k] - 1.0));
  }
  return P;
}

HyperelasticLaw nearly_incompressible(HyperelasticLaw law) {
  std::visit([](auto& l) { l.bulk_modulus = 1e7 * l.shear_modulus(); }, law);
  return law;
}

/// The free stretch l₃ (and l₂, where `l2` is null) at which the stress across vanishes, by Newton's method.
/// @return  P₁₁
double stress_with_free_sides(const Specimen& s, double l1, const double* l2) {
  double l3 = l2 != nullptr ? 1.0 / (l1 * *l2) : 1.0 / std::sqrt(l1);
  const auto P = [&](Dual free) {
    Mat3<Dual> H;
    H(0, 0) = l1 - 1.0, H(1, 1) = l2 != nullptr ? Dual(*l2 - 1.0) : free - 1.0, H(2, 2) = free - 1.0;
    return s.response.elastic(H, s.shape);
  };
  for (int n = 0; n < 30; ++n) {
    const Dual across = P({l3, 1.0})(2, 2);
    l3 -= across.v / across.d;
  }
  return P(l3)(0, 0).v;
}

TEST(UniformStretch, IncompressibleBar) {
  for (const HyperelasticLaw& base : test::every_hyperelastic_law()) {
    Tissue t;
    t.hyperelastic = nearly_incompressible(base);
    const Specimen s(t);
    for (const double l : {0.5, 0.8, 0.95, 1.05, 1.3, 2.0}) {
      const double exact = std::visit([&](const auto& law) { return bar(law, l); }, *t.hyperelastic);
      EXPECT_NEAR(stress_with_free_sides(s, l, nullptr), exact, 1e-4 * std::abs(exact)) << law_name(base) << " " << l;
    }
  }
}

TEST(UniformStretch, IncompressibleSheet) {
  for (const HyperelasticLaw& base : test::every_hyperelastic_law()) {
    Tissue t;
    t.hyperelastic = nearly_incompressible(base);
    const Specimen s(t);
    for (const double l : {0.7, 0.9, 1.1, 1.4}) {
      const double exact = std::visit([&](const auto& law) { return sheet(law, l); }, *t.hyperelastic);
      EXPECT_NEAR(stress_with_free_sides(s, l, &l), exact, 1e-4 * std::abs(exact)) << law_name(base) << " " << l;
    }
  }
}

// Pure dilation by l leaves κ (l³ − 1) l² on each side, whatever the law: the rest sees no change of volume.
TEST(UniformStretch, Dilation) {
  for (const Tissue& t : test::hyperelastic_tissues()) {
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    for (const double l : {0.7, 0.99, 1.01, 1.4}) {
      const double p = bulk_modulus(*t.hyperelastic) * (l * l * l - 1.0) * l * l;
      EXPECT_LT(test::apart(s.P(detail::diagonal(l - 1.0, l - 1.0, l - 1.0)), detail::diagonal(p, p, p)), 1e-12);
    }
  }
}

// Simple shear γ needs P₁₂ = 2 (W₁ + W₂) γ: the volume is kept, and the shear stress of an isotropic law is just this.
TEST(UniformStretch, SimpleShear) {
  for (const Tissue& t : test::hyperelastic_tissues()) {
    if (std::holds_alternative<Ogden>(*t.hyperelastic)) continue;  // no law of the invariants
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    for (const double gamma : {1e-3, 0.2, 0.8}) {
      Mat3d H;
      H(0, 1) = gamma;
      const Slopes w = slopes(*t.hyperelastic, 3.0 + gamma * gamma, 3.0 + gamma * gamma);
      const double stress = 2.0 * (w.first + w.second) * gamma;
      EXPECT_NEAR(s.P(H)(0, 1), stress, 1e-10 * t.lame().mu * gamma);
    }
  }
}

// St Venant–Kirchhoff along one axis, sides held: P = M l (l² − 1)/2. Corotational: M (l − 1). M = λ + 2 μ.
TEST(UniformStretch, ConfinedTensorMass) {
  for (const double l : {0.3, 0.8, 1.2, 2.0}) {
    Tissue t;
    const double M = t.lame().lambda + 2.0 * t.lame().mu;
    t.kinematics = Kinematics::green;
    EXPECT_NEAR(Specimen(t).P(detail::diagonal(0.0, 0.0, l - 1.0))(2, 2), 0.5 * M * l * (l * l - 1.0), 1e-11 * M);
    t.kinematics = Kinematics::corotational;
    EXPECT_NEAR(Specimen(t).P(detail::diagonal(0.0, 0.0, l - 1.0))(2, 2), M * (l - 1.0), 1e-11 * M);
  }
}

/// Squashed along z to the stretch l, then turned over.
Mat3d squashed(double l) { return detail::diagonal(0.0, 0.0, l - 1.0); }

// From no squash through flat to turned over, the stress is finite.
TEST(Squashed, StressIsFinite) {
  for (const Tissue& t : test::every_tissue()) {
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    for (const double l : {0.5, 0.2, 0.1, 1e-3, 1e-9, 1e-15, 0.0, -1e-15, -1e-3, -0.3, -1.0, -3.0}) {
      EXPECT_TRUE(std::isfinite(test::size_of(s.P(squashed(l))))) << l;
      EXPECT_TRUE(std::isfinite(s.response.energy(squashed(l), s.shape))) << l;
      EXPECT_TRUE(std::isfinite(s.response.stiffening(squashed(l), s.shape).ratio)) << l;
    }
    EXPECT_TRUE(std::isfinite(test::size_of(s.P(detail::diagonal(-1.0, -1.0, -1.0)))));  // a point
    EXPECT_TRUE(std::isfinite(test::size_of(s.P(detail::diagonal(-2.0, -2.0, -2.0)))));  // inside out
  }
}

// And it pushes back, P₃₃ < 0, all the way to where turning over another axis is shorter. St Venant–Kirchhoff does
// not: its force ends at a stretch of 1/√3 and is 0 when flat, a law of large rotation and small strain
// [Picinbono2003].
TEST(Squashed, StressRestores) {
  for (const Tissue& t : test::every_tissue()) {
    if (!t.hyperelastic && t.kinematics == Kinematics::green) continue;
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    for (double l = 0.95; l > -0.97; l -= 0.05) EXPECT_LT(s.P(squashed(l))(2, 2), 0.0) << l;
  }
  Tissue green;
  green.kinematics = Kinematics::green;
  const Specimen s(green);
  EXPECT_LT(s.P(squashed(0.58))(2, 2), s.P(squashed(0.3))(2, 2));
  EXPECT_EQ(s.P(squashed(0.0))(2, 2), 0.0);
  EXPECT_GT(s.P(squashed(-0.5))(2, 2), 0.0);
}

// A tet whose volume change is shared meets, for a shared change of 0, the isochoric stress alone while J ≥ 0.2, and below it
// β κ (J − 0.2) cof F too, β = 0.1: its neighbours cannot hide that it is nearly lost. The same change as a tet of its own,
// κ (J − 1) cof F, stands for the isochoric stress here.
TEST(Squashed, SharedVolumeLeavesAPushOfItsOwn) {
  for (Tissue t : test::hyperelastic_tissues()) {
    SCOPED_TRACE(t.name);
    const Response own(t);
    t.volume_change = VolumeChange::average_nodal;
    const Response shared(t);
    const Specimen s(t);
    const double kappa = bulk_modulus(*t.hyperelastic), none = 0.0;
    for (const double J : {0.9, 0.3, 0.2, 0.1, 0.0, -0.5}) {
      Mat3d H = squashed(J);
      H(0, 1) = 0.3;
      const Mat3d cof = deformation_gradient(cofactor_change(H));
      const double push = J < 0.2 ? 0.1 * kappa * (J - 0.2) : 0.0;
      const Mat3d expected = test::difference(own.elastic(H, s.shape), scaled(cof, kappa * (J - 1.0) - push));
      const Mat3d P = shared.elastic(H, s.shape, &none);
      EXPECT_LE(test::size_of(test::difference(P, expected)), 1e-12 * (test::size_of(P) + kappa)) << J;
      EXPECT_NEAR(shared.energy(H, s.shape, &none) - own.energy(H, s.shape) + 0.5 * kappa * (J - 1.0) * (J - 1.0),
                  J < 0.2 ? 0.05 * kappa * (J - 0.2) * (J - 0.2) : 0.0, 1e-12 * (kappa + own.energy(H, s.shape)));
    }
  }
}

// Nothing jumps where the laws leave their formula (J and stretches of 0.2) or where J changes sign.
TEST(Squashed, HyperelasticStressIsContinuous) {
  for (const Tissue& t : test::hyperelastic_tissues()) {
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    const double nearly = 1e-9;
    for (const double l : {0.2, 0.0}) {
      const Mat3d above = s.P(squashed(l + nearly)), below = s.P(squashed(l - nearly));
      EXPECT_LT(test::size_of(test::difference(above, below)), 1e-6 * test::size_of(above)) << l;
      const double W = s.response.energy(squashed(l + nearly), s.shape);
      EXPECT_NEAR(s.response.energy(squashed(l - nearly), s.shape), W, 1e-6 * W) << l;
    }
  }
}

}  // namespace
}  // namespace glisson
