// The stable step follows how stiff tets become: the ratio r of a law grows with its tangent.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "material/every_tissue.h"
#include "material/stiffness_bound.h"

namespace glisson {
namespace {

/// Largest eigenvalue of the symmetric part of ∂P/∂F − A [Pa]. @param without  A(r, c)
template <class Without>
double stiffest(const test::Specimen& s, const Mat3d& H, Without without) {
  Eigen::Matrix<double, 9, 9> K;
  for (std::size_t c = 0; c < 9; ++c) {
    Mat3<Dual> D;
    for (std::size_t i = 0; i < 9; ++i) D(i / 3, i % 3) = {H(i / 3, i % 3), i == c ? 1.0 : 0.0};
    const Mat3<Dual> P = s.response.elastic(D, s.shape);
    for (std::size_t r = 0; r < 9; ++r) K(static_cast<int>(r), static_cast<int>(c)) = P(r / 3, r % 3).d - without(r, c);
  }
  const Eigen::Matrix<double, 9, 9> even = 0.5 * (K + K.transpose());
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>>(even, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

double stiffest(const test::Specimen& s, const Mat3d& H) {
  return stiffest(s, H, [](std::size_t, std::size_t) { return 0.0; });
}

// At rest r is 1. Stretched by up to 30 %, a hyperelastic tangent is at most 1.2 r times that at rest, soft or nearly
// incompressible: an automatic step, 0.9 h*, leaves 1/0.81 = 1.23.
TEST(Stiffening, FollowsTheHyperelasticTangent) {
  for (const double times : {1.0, 100.0}) {
    for (Tissue t : test::hyperelastic_tissues()) {
      SCOPED_TRACE(t.name);
      std::visit([&](auto& law) { law.bulk_modulus *= times; }, *t.hyperelastic);
      const test::Specimen s(t);
      const double at_rest = stiffest(s, {});
      EXPECT_NEAR(s.response.stiffening({}, s.shape).ratio, 1.0, 1e-12);
      for (const double stretch : {0.05, 0.1, 0.2, 0.3}) {
        test::Draw draw(51);
        for (int n = 0; n < 1000; ++n) {
          const Mat3d H = draw.stretched(1.0 - stretch, 1.0 / (1.0 - stretch));
          ASSERT_LT(stiffest(s, H), 1.2 * at_rest * s.response.stiffening(H, s.shape).ratio) << stretch;
        }
      }
    }
  }
}

// So do laws that stiffen steeply, where the second slopes of W are most of the tangent: chains near their end, exponents of
// twenty, squares without a linear part.
TEST(Stiffening, FollowsSteepLawsOfTheInvariants) {
  for (const HyperelasticLaw& law : std::initializer_list<HyperelasticLaw>{
           Gent{.mu = 1300.0, .limit = 0.5}, Invariants{.c01 = 650.0, .c02 = 13000.0},
           Invariants{.c10 = 325.0, .c01 = 325.0, .c11 = 13000.0}, Invariants{.a1 = 1300.0, .b1 = 20.0},
           Invariants{.a2 = 1300.0, .b2 = 20.0}, Invariants{.c10 = 650.0, .q1 = 13000.0, .r1 = 10.0},
           Invariants{.c01 = 650.0, .q2 = 13000.0, .r2 = 10.0},
           Invariants{.c10 = 1000.0, .c01 = -350.0, .c20 = 500.0, .c11 = -300.0, .c02 = 100.0}}) {
    for (const double bulk : {6000.0, 6e5}) {
      Tissue t;
      t.hyperelastic = law;
      std::visit([&](auto& l) { l.bulk_modulus = bulk; }, *t.hyperelastic);
      const test::Specimen s(t);
      const double at_rest = stiffest(s, {});
      test::Draw draw(55);
      for (int n = 0; n < 2000; ++n) {
        const Mat3d H = draw.stretched(0.7, 1.0 / 0.7);
        ASSERT_LT(stiffest(s, H), 1.2 * at_rest * s.response.stiffening(H, s.shape).ratio) << law_name(law) << " " << n;
      }
      for (int n = 0; n < 2000; ++n) {
        const Mat3d H = draw.stretched(0.3, 1.5);
        ASSERT_LE(stiffest(s, H), at_rest * s.response.stiffening(H, s.shape).norm * (1.0 + 1e-9)) << law_name(law);
      }
    }
  }
}

// A corotational tet resists turning as soon as it is drawn out by more than its shear modulus lets go: the tangent without
// λ R ⊗ R stays below 2 μ and the part that the stiffening tells of, which is needed to a tenth.
TEST(Stiffening, FollowsTheCorotationalTangentAgainstTurning) {
  Tissue t;
  t.name = "corotational", t.youngs_modulus = 1000.0, t.kinematics = Kinematics::corotational;
  for (const double nu : {0.2, 0.4, 0.49}) {
    t.poisson_ratio = nu;
    const test::Specimen s(t);
    const LameParameters lame = t.lame();
    const double rest = 3.0 * lame.lambda + 2.0 * lame.mu;
    EXPECT_EQ(s.response.stiffening({}, s.shape).ratio, 1.0);
    test::Draw draw(52);
    double tightest = 0.0;
    for (int n = 0; n < 2000; ++n) {
      const Mat3d H = draw.stretched(0.5, 3.0);
      const PrincipalFrame f = principal_frame(H);
      const Mat3d R = product(f.u, test::transposed(f.n));
      const double turning = (s.response.stiffening(H, s.shape).ratio - 1.0) * rest;
      const double most =
          stiffest(s, H, [&](std::size_t r, std::size_t c) { return lame.lambda * R(r / 3, r % 3) * R(c / 3, c % 3); });
      ASSERT_LE(most, (2.0 * lame.mu + turning) * (1.0 + 1e-9)) << nu;
      if (turning > 0.0) tightest = std::max(tightest, most / (2.0 * lame.mu + turning));
    }
    EXPECT_GT(tightest, 0.9) << nu;
  }
}

/// F = R diag(λ) Q with the third stretch down to `least`, which is below 0 for tets that are inside out.
Mat3d squashed(test::Draw& draw, std::mt19937& random, double least) {
  const PrincipalFrame f = principal_frame(draw.stretched(0.5, 2.0));
  const auto between = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const double third = between(least, 1.0), second = between(std::max(std::abs(third), 0.1), 1.5);
  Mat3d H = detail::out_of_frame(f, detail::diagonal(between(second, 2.0), second, third));
  for (std::size_t i = 0; i < 3; ++i) H(i, i) -= 1.0;
  return H;
}

// However squashed a tet is, flat or inside out, the norm is finite and bounds the tangent: no room, no strain that it ends at.
// Only where two stretches add up to nearly nothing has an inverted tet no tangent.
TEST(Stiffening, NormBoundsTheHyperelasticTangentOfALostTet) {
  for (const Tissue& t : test::hyperelastic_tissues()) {
    SCOPED_TRACE(t.name);
    const test::Specimen s(t);
    const double rest = stiffest(s, {});
    test::Draw draw(53);
    std::mt19937 random(54);
    for (int n = 0; n < 4000; ++n) {
      const Mat3d H = squashed(draw, random, n % 2 == 0 ? 0.02 : -0.8);
      const std::array<double, 3> b = principal_frame(H).b;
      if (2.0 + b[1] + b[2] < 2.0 * kSmallestFlip) continue;
      const Stiffening bound = s.response.stiffening(H, s.shape);
      ASSERT_TRUE(std::isfinite(bound.norm) && std::isfinite(bound.ratio)) << b[2] + 1.0;
      ASSERT_LE(stiffest(s, H), bound.norm * rest * (1.0 + 1e-9))
          << b[0] + 1.0 << " " << b[1] + 1.0 << " " << b[2] + 1.0;
    }
  }
}

// So with laws on E that have an energy, in 20 % of stretch, but for what r does not see: how sharply a step bends, and
// nearly pure dilation. There W_x = ½ λ' tr² is not 0 while s has the edge of a norm, so that no bound holds.
TEST(Stiffening, FollowsTheTangentOfAnEnergy) {
  for (const Tissue& t : test::tensor_mass_tissues()) {
    const bool bends = std::holds_alternative<StepLaw>(t.law) || t.lambda_law || t.mu_law;
    if (t.law_form != LawForm::energy || bends || test::is_small(t)) continue;
    if (t.measure == DeformationMeasure::regular_mean_ratio || t.measure == DeformationMeasure::solid_angle) continue;
    SCOPED_TRACE(t.name);
    const test::Specimen s(t);
    const double at_rest = stiffest(s, {});
    for (const double stretch : {0.05, 0.1, 0.2}) {
      test::Draw draw(52);
      for (int n = 0; n < 1000; ++n) {
        const Mat3d H = draw.stretched(1.0 - stretch, 1.0 / (1.0 - stretch));
        if (intensity_of(one_minus_q(H)) < 0.3 * std::abs(jacobian(H) - 1.0)) continue;
        ASSERT_LT(stiffest(s, H), 1.23 * at_rest * s.response.stiffening(H, s.shape).ratio) << stretch;
      }
    }
  }
}

}  // namespace
}  // namespace glisson
