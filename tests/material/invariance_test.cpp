// What no observer may see: rotations of the body before and after, spin, and rest.
#include <gtest/gtest.h>

#include <numbers>

#include "material/every_tissue.h"
#include "material/principal.h"

namespace glisson {
namespace {

using test::apart;
using test::Draw;
using test::every_tissue;
using test::Specimen;

Mat3d change(const Mat3d& F) { return test::difference(F, identity<double>()); }
Mat3d about_z(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{{{c, -s, 0.0}, {s, c, 0.0}, {0.0, 0.0, 1.0}}}};
}
/// A measure of single tetrahedra prefers the directions of its edges.
bool is_isotropic(const Tissue& t) { return !t.fibres && !test::has_directions(t); }

// At rest stress, energy and relaxing stress are exactly 0.
TEST(Invariance, NothingAtRest) {
  for (const Tissue& t : every_tissue()) {
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    EXPECT_EQ(test::size_of(s.P({})), 0.0);
    EXPECT_EQ(s.response.energy({}, s.shape), 0.0);
    EXPECT_EQ(test::size_of(full(s.response.relaxing(Mat3d{}, s.P({})))), 0.0);
  }
}

// Frame indifference: P(QF) = Q P(F), W(QF) = W(F). Rounding of QF is that of F times the stiffness over the stress.
TEST(Invariance, FrameIndifference) {
  for (const Tissue& t : every_tissue()) {
    if (test::is_small(t)) continue;
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    Draw draw(21);
    for (int n = 0; n < 20; ++n) {
      const Mat3d H = draw.stretched(0.67, 1.44), Q = draw.rotation(),
                  turned = change(product(Q, deformation_gradient(H)));
      EXPECT_LT(apart(s.P(turned), product(Q, s.P(H))), 1e-11);
      const double W = s.response.energy(H, s.shape);
      EXPECT_NEAR(s.response.energy(turned, s.shape), W, 1e-11 * W);
    }
  }
}

// Small strain is not indifferent: a rotation by θ is taken for the strain cos θ − 1 across its axis, and for no other.
TEST(Invariance, SmallStrainMistakesRotationForStrain) {
  Tissue t;
  const Specimen s(t);
  const auto [lambda, mu] = t.lame();
  for (const double angle : {0.01, 0.3, 1.0, std::numbers::pi / 2.0}) {
    const double e = std::cos(angle) - 1.0, p = 2.0 * lambda * e;
    const Mat3d expected = detail::diagonal(p + 2.0 * mu * e, p + 2.0 * mu * e, p);
    EXPECT_LT(apart(s.P(change(about_z(angle))), expected), 1e-12);
  }
}

// A rotation by 90° and by any other angle gives no force: what is left is rounding of the rotation itself.
TEST(Invariance, RotationGivesNoForce) {
  for (const Tissue& t : every_tissue()) {
    if (test::is_small(t)) continue;
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    const double scale = 3.0 * t.lame().lambda;
    Draw draw(22);
    EXPECT_LT(test::size_of(s.P(change(about_z(std::numbers::pi / 2.0)))), 1e-14 * scale);
    for (int n = 0; n < 20; ++n) EXPECT_LT(test::size_of(s.P(change(draw.rotation()))), 1e-14 * scale);
  }
}

// Isotropy: P(QᵀFQ) = Qᵀ P(F) Q for every kinematics, and P(FQ) = P(F) Q where rotations count for nothing.
TEST(Invariance, Isotropy) {
  for (const Tissue& t : every_tissue()) {
    if (!is_isotropic(t)) continue;
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    Draw draw(23);
    for (int n = 0; n < 20; ++n) {
      const Mat3d H = draw.stretched(0.67, 1.44), Q = draw.rotation(), F = deformation_gradient(H), P = s.P(H);
      EXPECT_LT(apart(s.P(transposed_product(Q, product(H, Q))), transposed_product(Q, product(P, Q))), 1e-11);
      if (!test::is_small(t)) {
        EXPECT_LT(apart(s.P(change(product(F, Q))), product(P, Q)), 1e-11);
      }
    }
  }
}

// Fibres are not isotropic, but a turn about them changes nothing.
TEST(Invariance, FibresAllowTurnsAboutThem) {
  for (const Tissue& t : test::fibre_tissues()) {
    if (test::is_small(t)) continue;
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    const Vec3d& a = s.shape.fibre;
    Draw draw(24);
    for (int n = 0; n < 10; ++n) {
      const Mat3d H = draw.stretched(0.67, 1.44), F = deformation_gradient(H);
      const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.4 + n, Eigen::Vector3d(a.x, a.y, a.z)).toRotationMatrix();
      const Mat3d Q = test::to_double(turn.cast<reference::Real>()), other = draw.rotation();
      EXPECT_LT(apart(s.P(change(product(F, Q))), product(s.P(H), Q)), 1e-11);
      EXPECT_GT(apart(s.P(change(product(F, other))), product(s.P(H), other)), 1e-3);
    }
  }
}

// Balance of angular momentum: P Fᵀ is symmetric; of small strain P itself. The secant form keeps it.
TEST(Invariance, KirchhoffStressIsSymmetric) {
  for (const Tissue& t : every_tissue()) {
    const bool small_energy = test::is_small(t) && t.law_form == LawForm::energy;
    if (small_energy) continue;  // ∂x/∂F of a measure of F is no symmetric tensor beside a stress of sym H
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    Draw draw(25);
    for (int n = 0; n < 20; ++n) {
      const Mat3d H = draw.stretched(0.67, 1.44), P = s.P(H);
      const Mat3d K = test::is_small(t) ? P : product(P, test::transposed(deformation_gradient(H)));
      EXPECT_LT(apart(test::transposed(K), K), 1e-11);
    }
  }
}

// Near rest every law is Hooke's with the moduli it reports, plus its fibres. Its own second order is what is left.
TEST(Invariance, SmallStrainLimitIsHooke) {
  for (const Tissue& t : every_tissue()) {
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    auto [lambda, mu] = t.lame();
    if (!t.hyperelastic && t.measure == DeformationMeasure::regular_mean_ratio) {
      const double x = static_cast<double>(reference::shape_measure(s.point, test::real_gradient({})));
      lambda = lame_at(t, x).lambda, mu = lame_at(t, x).mu;  // this measure is not 0 at rest
    }
    if (std::holds_alternative<TableLaw>(t.law)) lambda = lame_at(t, 0.0).lambda, mu = lame_at(t, 0.0).mu;
    if (std::holds_alternative<StepLaw>(t.law)) lambda = lame_at(t, 0.0).lambda, mu = lame_at(t, 0.0).mu;
    Draw draw(26);
    for (int n = 0; n < 10; ++n) {
      const Mat3d H = draw.tensor(1e-7);
      Mat3d sigma = full(isotropic_stress(H, lambda, mu));
      if (t.fibres) {
        const Vec3d& a = s.shape.fibre;
        const double tension = t.fibres->stiffness * dot(a, symmetric(H) * a);
        for (std::size_t i = 0; i < 9; ++i) sigma(i / 3, i % 3) += tension * a[i / 3] * a[i % 3];
      }
      EXPECT_LT(apart(s.P(H), sigma), 2e-5);
    }
  }
}

// Fibres answer stretch along them by c (a·E a) F a ⊗ a, and stretch across them not at all.
TEST(Invariance, FibresPullOnlyAlongThemselves) {
  Tissue plain;
  plain.kinematics = Kinematics::green;
  Tissue tissue = plain;
  tissue.fibres = Fibres{{0.0, 0.0, 2.0}, 5000.0};
  const Specimen with(tissue), without(plain);
  const auto fibre_stress = [&](const Mat3d& H) { return test::difference(with.P(H), without.P(H)); };
  EXPECT_EQ(test::size_of(fibre_stress(detail::diagonal(0.3, -0.2, 0.0))), 0.0);
  EXPECT_EQ(test::size_of(fibre_stress({{{{0.0, 0.4, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.0, 0.0}}}})), 0.0);
  const double stretch = 1.2, E = 0.5 * (stretch * stretch - 1.0);
  const Mat3d expected = detail::diagonal(0.0, 0.0, 5000.0 * E * stretch);
  EXPECT_LT(apart(fibre_stress(detail::diagonal(0.3, -0.2, stretch - 1.0)), expected), 1e-11);
}

// A rigid spin Ḟ = W F, W skew, drags no viscous stress; F = I + H may be deformed. Small strain only sees it at rest.
TEST(Invariance, SpinIsNotViscous) {
  for (const Tissue& t : test::viscous_tissues()) {
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    Draw draw(27);
    for (int n = 0; n < 10; ++n) {
      const Mat3d A = draw.tensor(1.0), W = test::difference(A, test::transposed(A));
      const Mat3d H = test::is_small(t) ? Mat3d{} : draw.stretched(0.7, 1.4);
      const Mat3d P = s.response.viscous(H, product(W, deformation_gradient(H)));
      EXPECT_LT(test::size_of(P), 1e-13 * t.viscosity * test::size_of(W));
    }
  }
}

// Viscosity takes work out of any motion: P_v : Ḟ ≥ 0.
TEST(Invariance, ViscosityDissipates) {
  for (const Tissue& t : test::viscous_tissues()) {
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    Draw draw(28);
    for (int n = 0; n < 50; ++n) {
      const Mat3d H = draw.stretched(0.6, 1.6), rate = draw.tensor(1.0);
      EXPECT_GE(test::inner(s.response.viscous(H, rate), rate), 0.0);
    }
  }
}

}  // namespace
}  // namespace glisson
