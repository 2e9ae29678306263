// The curve of a tensile test: closed forms of linear and of incompressible tissue.
#include "material/uniaxial.h"

#include <gtest/gtest.h>

namespace glisson {
namespace {

// Small strain: σ = E (λ − 1), and the sides give way by ν.
TEST(Uniaxial, LinearTissueIsHookes) {
  const Response response(Tissue{});
  for (const double stretch : {0.7, 0.99, 1.0, 1.2}) {
    const UniaxialState s = uniaxial_state(response, stretch);
    EXPECT_TRUE(s.converged);
    EXPECT_NEAR(s.stress, 3600.0 * (stretch - 1.0), 1e-9 * 3600.0);
    EXPECT_NEAR(s.lateral_stretch, 1.0 - 0.4 * (stretch - 1.0), 1e-12);
  }
}

// Neo-Hooke with κ = 1e6 μ is incompressible to 1e-6 of its strain: P = μ (λ − λ⁻²).
TEST(Uniaxial, StiffBulkIsIncompressible) {
  Tissue tissue;
  tissue.hyperelastic = NeoHookean{.mu = 1000.0, .bulk_modulus = 1e9};
  const Response response(tissue);
  for (const double stretch : {0.4, 0.8, 1.3, 2.0}) {
    const UniaxialState s = uniaxial_state(response, stretch);
    EXPECT_TRUE(s.converged);
    const double exact = 1000.0 * (stretch - 1.0 / (stretch * stretch));
    EXPECT_NEAR(s.stress, exact, 1e-5 * std::abs(exact)) << stretch;
  }
}

}  // namespace
}  // namespace glisson
