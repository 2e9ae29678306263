// P is the gradient of W, and the tangent is the gradient of P, for every law.
//
// Differences take five points, so that their error is of fourth order in the step: at 1e-4 some 1e-13 of what the
// law bends, and 1e-16/1e-4 of rounding. 1e-8 leaves room for laws that bend sharply.
#include <gtest/gtest.h>

#include <functional>

#include "material/every_tissue.h"
#include "material/principal.h"

namespace glisson::energy_test {
namespace {

using test::Draw;
using test::inner;
using test::Specimen;

constexpr double kStep = 1e-4, kTolerance = 1e-8;

/// df/dh at 0 of numbers or tensors.
double slope(const std::function<double(double)>& f) {
  return (8.0 * (f(kStep) - f(-kStep)) - (f(2.0 * kStep) - f(-2.0 * kStep))) / (12.0 * kStep);
}
Mat3d slope(const std::function<Mat3d(double)>& f) {
  const Mat3d near = test::difference(f(kStep), f(-kStep)), far = test::difference(f(2.0 * kStep), f(-2.0 * kStep));
  return scaled(test::difference(scaled(near, 8.0), far), 1.0 / (12.0 * kStep));
}

/// @param smooth  whether the measure is; the smallest solid angle has edges between its corners, which differences
///                must not cross: near rest they are near everywhere
std::vector<Mat3d> states(bool smooth) {
  Draw draw(11);
  std::vector<Mat3d> all{Mat3d{}};
  for (int n = 0; n < 6; ++n) all.push_back(draw.stretched(0.7, 1.5));
  for (int n = 0; smooth && n < 3; ++n) all.push_back(draw.tensor(0.01));
  for (const double squashed : {-0.2, -0.5, -0.7}) {  // inverted, away from λ₂ = −λ₃ where there is no derivative
    const Mat3d F = product(draw.rotation(), product(detail::diagonal(1.4, 1.0, squashed), draw.rotation()));
    all.push_back(test::difference(F, identity<double>()));
  }
  return all;
}

Mat3<Dual> along(const Mat3d& H, const Mat3d& dH) {
  Mat3<Dual> r;
  for (std::size_t i = 0; i < 9; ++i) r(i / 3, i % 3) = {H(i / 3, i % 3), dH(i / 3, i % 3)};
  return r;
}

Mat3d tangent(const Specimen& s, const Mat3d& H, const Mat3d& dH) {
  return detail::derivatives_of(s.response.elastic(along(H, dH), s.shape));
}

Mat3d tangent_by_differences(const Specimen& s, const Mat3d& H, const Mat3d& dH) {
  return slope([&](double h) { return s.P(sum(H, scaled(dH, h))); });
}
double energy_by_differences(const Specimen& s, const Mat3d& H, const Mat3d& dH) {
  return slope([&](double h) { return s.response.energy(sum(H, scaled(dH, h)), s.shape); });
}

/// Scale of a tangent times dH [Pa].
double stiffness_scale(const Specimen& s) { return 3.0 * s.response.tissue().lame().lambda; }

// dW = P : dF. At rest and inverted as well.
TEST(Energy, StressIsItsGradient) {
  for (const Tissue& t : test::every_tissue()) {
    if (!test::is_conservative(t)) continue;
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    Draw draw(12);
    for (const Mat3d& H : states(t.measure != DeformationMeasure::solid_angle)) {
      const Mat3d dH = draw.tensor(1.0), P = s.P(H);
      EXPECT_NEAR(energy_by_differences(s, H, dH), inner(P, dH),
                  kTolerance * (test::size_of(P) + stiffness_scale(s) * kStep) * test::size_of(dH))
          << "J = " << jacobian(H);
    }
  }
}

// A secant law has no energy: its stress is not the gradient of ½ σ:ε, so the test above can fail.
TEST(Energy, SecantHasNone) {
  for (const Tissue& t : test::tensor_mass_tissues()) {
    if (test::is_conservative(t)) continue;
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    Draw draw(13);
    double worst = 0.0;
    for (int n = 0; n < 10; ++n) {
      const Mat3d H = draw.stretched(0.8, 1.2), dH = draw.tensor(1.0), P = s.P(H);
      const double dW = energy_by_differences(s, H, dH);
      worst = std::max(worst, std::abs(dW - inner(P, dH)) / (test::size_of(P) * test::size_of(dH)));
    }
    EXPECT_GT(worst, 1e-3);
  }
}

// The numbers that carry their derivative give what differences give.
TEST(Tangent, EqualsDifferences) {
  for (const Tissue& t : test::every_tissue()) {
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    Draw draw(14);
    for (const Mat3d& H : states(t.measure != DeformationMeasure::solid_angle)) {
      const Mat3d dH = draw.tensor(1.0), K = tangent(s, H, dH), D = tangent_by_differences(s, H, dH);
      const bool at_rest = test::size_of(H) == 0.0;  // s is not smooth there; its own share vanishes with the strain
      const double scale = test::size_of(K) + stiffness_scale(s) * test::size_of(dH);
      EXPECT_LT(test::size_of(test::difference(K, D)), (at_rest ? 1e-3 : kTolerance) * scale) << "J = " << jacobian(H);
    }
  }
}

// ∂P/∂F of an energy is symmetric: A : K B = B : K A. Of a secant law with a slope it is not.
TEST(Tangent, IsSymmetricWhereThereIsAnEnergy) {
  for (const Tissue& t : test::every_tissue()) {
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    Draw draw(15);
    double worst = 0.0;
    for (const Mat3d& H : states(t.measure != DeformationMeasure::solid_angle)) {
      const Mat3d A = draw.tensor(1.0), B = draw.tensor(1.0);
      const Mat3d KA = tangent(s, H, A), KB = tangent(s, H, B);
      const double size = test::size_of(KA) * test::size_of(B) + stiffness_scale(s);
      worst = std::max(worst, std::abs(inner(A, KB) - inner(B, KA)) / size);
    }
    if (test::is_conservative(t)) {
      EXPECT_LT(worst, 1e-10);
    } else {
      EXPECT_GT(worst, 1e-4);
    }
  }
}

// Closed forms. Small: C:sym dF. Green: dF S + F (λ tr Ė I + 2 μ Ė), Ė = sym FᵀdF.
TEST(Tangent, ClosedFormOfSmallAndGreen) {
  for (const Kinematics k : {Kinematics::small, Kinematics::green}) {
    Tissue t;
    t.kinematics = k;
    const Specimen s(t);
    const auto [lambda, mu] = t.lame();
    Draw draw(16);
    for (const Mat3d& H : states(t.measure != DeformationMeasure::solid_angle)) {
      const Mat3d dH = draw.tensor(1.0), F = deformation_gradient(H);
      Mat3d K = full(isotropic_stress(dH, lambda, mu));
      if (k == Kinematics::green) {
        const Mat3d C = transposed_product(F, F), rate = transposed_product(F, dH);
        const Mat3d E = scaled(test::difference(C, identity<double>()), 0.5);
        K = sum(product(dH, full(isotropic_stress(E, lambda, mu))),
                product(F, full(isotropic_stress(rate, lambda, mu))));
      }
      EXPECT_LT(test::apart(tangent(s, H, dH), K), 1e-12);
    }
  }
}

// Neo-Hookean, with G = F⁻ᵀ and d = G : dF:
//   dP = μ J^(−⅔) [ dF − ⅔ d (F − ⅓ I₁ G) − ⅔ (F:dF) G + ⅓ I₁ G dFᵀ G ] + κ J [ (2J − 1) d G − (J − 1) G dFᵀ G ]
TEST(Tangent, ClosedFormOfNeoHookean) {
  const NeoHookean law{.mu = 1300.0, .bulk_modulus = 6000.0};
  Tissue t;
  t.hyperelastic = law;
  const Specimen s(t);
  Draw draw(17);
  for (int n = 0; n < 20; ++n) {
    const Mat3d H = draw.stretched(0.7, 1.5), dH = draw.tensor(1.0), F = deformation_gradient(H);
    const Mat3d G = test::transposed(inverse(F)), turned = product(G, product(test::transposed(dH), G));
    const double J = determinant(F), I1 = squared_norm(F), d = inner(G, dH);
    Mat3d shear = sum(dH, scaled(test::difference(F, scaled(G, I1 / 3.0)), -2.0 / 3.0 * d));
    shear = sum(shear, sum(scaled(G, -2.0 / 3.0 * inner(F, dH)), scaled(turned, I1 / 3.0)));
    const Mat3d bulk = test::difference(scaled(G, (2.0 * J - 1.0) * d), scaled(turned, J - 1.0));
    const Mat3d K = sum(scaled(shear, law.mu * std::pow(J, -2.0 / 3.0)), scaled(bulk, law.bulk_modulus * J));
    EXPECT_LT(test::apart(tangent(s, H, dH), K), 1e-11);
  }
}

// The viscous stress has a tangent in F and one in Ḟ; both are those of differences.
TEST(Tangent, OfViscousStress) {
  for (const Tissue& t : test::viscous_tissues()) {
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    Draw draw(18);
    for (int n = 0; n < 5; ++n) {
      const Mat3d H = draw.stretched(0.7, 1.5), rate = draw.tensor(2.0), dH = draw.tensor(1.0), dR = draw.tensor(1.0);
      const Mat3d K = detail::derivatives_of(s.response.viscous(along(H, dH), along(rate, dR)));
      const Mat3d D =
          slope([&](double h) { return s.response.viscous(sum(H, scaled(dH, h)), sum(rate, scaled(dR, h))); });
      EXPECT_LT(test::apart(K, D), kTolerance);
    }
  }
}

}  // namespace
}  // namespace glisson::energy_test
