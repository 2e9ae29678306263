// meridian_response_test.cpp — the short way of a body about its axis gives the stress and tangent of the general response.
#include "material/meridian_response.h"

#include <gtest/gtest.h>

#include <random>

#include "material/hyperelastic_response.h"

namespace glisson::meridian_response_test {
namespace {

constexpr std::array<std::array<std::size_t, 2>, 5> kPlaces{{{0, 0}, {0, 1}, {1, 0}, {1, 1}, {2, 2}}};

template <class T>
Mat3<T> full_of(const std::array<T, 5>& H) {
  Mat3<T> full;
  for (std::size_t a = 0; a < 5; ++a) full(kPlaces[a][0], kPlaces[a][1]) = H[a];
  return full;
}

// P, and ∂P/∂F in each of the five directions, of every law at 200 gradients, at rest and near it among them. Laws of the
// invariants take their powers in another order: 1e-10 of the largest entry. Where stretches in the meridian come closer than
// 1e-6 both ways take the limit, which is as far from the truth.
TEST(MeridianResponse, IsTheGeneralOne) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> entry(-0.3, 0.3);
  Invariants sum{.c10 = 200, .c01 = 100, .c20 = 30, .c11 = 20, .c02 = 10, .c30 = 5, .bulk_modulus = 9000};
  sum.a1 = 100, sum.b1 = 1.5, sum.a2 = 80, sum.b2 = 0.7, sum.q1 = 50, sum.r1 = 0.1, sum.q2 = 40, sum.r2 = 0.05;
  for (const HyperelasticLaw& law : std::initializer_list<HyperelasticLaw>{
           NeoHookean{1000, 9000}, MooneyRivlin{300, 200, 9000},
           Yeoh{.c1 = 400, .c2 = 50, .c3 = 7, .bulk_modulus = 9000}, Fung{1000, 2.0, 9000},
           VerondaWestmann{.c = 700, .b = 1.5, .bulk_modulus = 9000}, Ogden{{700, -100}, {6.0, -4.7}, 9000},
           Gent{.mu = 1000, .limit = 8.0, .bulk_modulus = 9000}, sum}) {
    for (int i = 0; i < 200; ++i) {
      const double scale = i == 0 ? 0.0 : (i % 4 == 0 ? 1e-3 : 1.0);
      std::array<double, 5> H;
      for (double& h : H) h = scale * entry(random);
      const MeridianStress s = isochoric_stress(law, {1.0 + H[0], H[1], H[2], 1.0 + H[3], 1.0 + H[4]});
      const Mat3d P = isochoric_piola(law, full_of(H));
      for (std::size_t b = 0; b < 5; ++b) {
        std::array<Dual, 5> direction;
        for (std::size_t a = 0; a < 5; ++a) direction[a] = {H[a], a == b ? 1.0 : 0.0};
        const Mat3<Dual> dP = isochoric_piola(law, full_of(direction));
        for (std::size_t a = 0; a < 5; ++a) {
          const auto [row, column] = kPlaces[a];
          EXPECT_NEAR(s.P[a], P(row, column), 1e-7) << law_name(law) << " " << i;
          EXPECT_NEAR(s.tangent[a][b], dP(row, column).d, 1e-6 * (1.0 + std::abs(dP(row, column).d)))
              << law_name(law) << " " << i << " " << a << b;
        }
      }
    }
  }
}

}  // namespace
}  // namespace glisson::meridian_response_test
