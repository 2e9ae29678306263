// Ice that has formed and melted at any times and strains is one network: its energy, stress and tangent are those of all networks that
// have formed, each kept by itself.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "material/ice_network.h"
#include "material/reference/reference_ice.h"

namespace glisson::ice_network_test {
namespace {

constexpr LameParameters kLame{.lambda = 8000.0, .mu = 3000.0};

Mat3d random_gradient(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> number(-size, size);
  Mat3d H;
  for (std::size_t i = 0; i < 9; ++i) H(i / 3, i % 3) = number(random);
  return H;
}

Eigen::Matrix3d eigen_gradient(const Mat3d& H) {
  Eigen::Matrix3d F;
  for (Eigen::Index i = 0; i < 9; ++i)
    F(i / 3, i % 3) = H(static_cast<std::size_t>(i / 3), static_cast<std::size_t>(i % 3)) + (i % 4 == 0 ? 1.0 : 0.0);
  return F;
}

/// A network that has frozen and thawed in turn, and all that has formed.
struct Both {
  IceNetwork ice;
  reference::Ice all{kLame};

  explicit Both(std::mt19937& random) {
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (int k = 0; k < 6; ++k) {
      const Mat3d H = random_gradient(random, 0.2);
      if (k == 0) {
        ice.inverse = inverse(deformation_gradient(H));
        ice.volume_ratio = determinant(deformation_gradient(H));
      }
      const double more = 50.0 * share(random);
      set_amount(ice, ice_strain(ice, H), kLame, ice.amount + more);
      all.form(more, eigen_gradient(H));
      if (k % 2 == 0) continue;
      const double kept = share(random);
      set_amount(ice, ice_strain(ice, random_gradient(random, 0.2)), kLame, kept * ice.amount);
      all.melt(kept);
    }
  }
  Mat3d piola(const Mat3d& H) const {
    return ice_piola(ice, since_frozen(ice, H), ice_stress(ice, ice_strain(ice, H), kLame));
  }
  double energy(const Mat3d& H) const { return ice_energy(ice, ice_strain(ice, H), kLame); }
};

// Rounding alone lies between the two: numbers of 1e5 Pa, some of which cancel.
TEST(IceNetwork, IsTheSumOfAllThatFormed) {
  std::mt19937 random(11);
  for (int k = 0; k < 100; ++k) {
    const Both both(random);
    EXPECT_NEAR(both.ice.amount, both.all.amount(), 1e-12 * both.ice.amount);
    const Mat3d H = random_gradient(random, 0.3);
    const Eigen::Matrix3d P = both.all.piola(eigen_gradient(H));
    EXPECT_NEAR(both.energy(H), both.all.energy(eigen_gradient(H)), 1e-11 * both.all.energy(eigen_gradient(H)));
    const Mat3d found = both.piola(H);
    for (std::size_t i = 0; i < 9; ++i) {
      EXPECT_NEAR(found(i / 3, i % 3), P(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)),
                  1e-11 * P.norm());
    }
  }
}

// P = ∂W/∂F, and the tangent is ∂P/∂F with Ḟ following F: central differences, of error h².
TEST(IceNetwork, StressAndTangentAreDerivatives) {
  std::mt19937 random(12);
  const LameParameters drag{.lambda = 40.0, .mu = 25.0};
  constexpr double kStep = 1e-6, kRate = 30.0;
  for (int k = 0; k < 20; ++k) {
    const Both both(random);
    const Mat3d H = random_gradient(random, 0.2), Hdot = random_gradient(random, 2.0);
    const auto stress = [&](const Mat3d& h, const Mat3d& hdot) {
      const IceResponse r(both.ice, kLame, drag, h, hdot);
      return ice_piola(both.ice, r.F_r, r.elastic + r.viscous);
    };
    const auto slope = ice_tangent(both.ice, kLame, drag, {both.ice, kLame, drag, H, Hdot}, kRate);
    double size = 0.0;
    for (const double x : slope) size = std::max(size, std::abs(x));
    for (std::size_t c = 0; c < 9; ++c) {
      Mat3d up = H, down = H, up_rate = Hdot, down_rate = Hdot;
      up(c / 3, c % 3) += kStep, down(c / 3, c % 3) -= kStep;
      up_rate(c / 3, c % 3) += kRate * kStep, down_rate(c / 3, c % 3) -= kRate * kStep;
      EXPECT_NEAR((both.energy(up) - both.energy(down)) / (2.0 * kStep), both.piola(H)(c / 3, c % 3), 1e-7 * size);
      const Mat3d high = stress(up, up_rate), low = stress(down, down_rate);
      for (std::size_t r = 0; r < 9; ++r)
        EXPECT_NEAR((high(r / 3, r % 3) - low(r / 3, r % 3)) / (2.0 * kStep), slope[9 * r + c], 1e-7 * size);
    }
  }
}

// More ice changes neither stress nor energy; less takes its share of both; none leaves nothing.
TEST(IceNetwork, IsContinuousWhereItForms) {
  std::mt19937 random(13);
  for (int k = 0; k < 20; ++k) {
    Both both(random);
    const Mat3d H = random_gradient(random, 0.2);
    const Sym3<double> E = ice_strain(both.ice, H);
    const double energy = both.energy(H);
    const Mat3d P = both.piola(H);
    set_amount(both.ice, E, kLame, both.ice.amount + 70.0);
    EXPECT_NEAR(both.energy(H), energy, 1e-12 * energy);
    for (std::size_t i = 0; i < 9; ++i)
      EXPECT_NEAR(both.piola(H)(i / 3, i % 3), P(i / 3, i % 3), 1e-12 * squared_norm(P));
    set_amount(both.ice, E, kLame, 0.25 * both.ice.amount);
    EXPECT_NEAR(both.energy(H), 0.25 * energy, 1e-12 * energy);
    set_amount(both.ice, E, kLame, 0.0);
    EXPECT_EQ(both.energy(H), 0.0);
    EXPECT_EQ(squared_norm(both.piola(H)), 0.0);
  }
}

}  // namespace
}  // namespace glisson::ice_network_test
