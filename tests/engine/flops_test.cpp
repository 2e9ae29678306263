// Operations are counted from the stages as they run: what reaches the forces, and nothing else.
#include "engine/kernels/flops.h"

#include <gtest/gtest.h>

namespace glisson::engine {
namespace {

Tissue with(HyperelasticLaw law) {
  Tissue tissue;
  tissue.hyperelastic = std::move(law);
  return tissue;
}

// Small strain by hand: sym H 6, its trace 2, 2 μ ε 6, λ tr ε 1, its sum 3; where a law gives the moduli, these 2 and 2 μ 1. The
// bound of the stable step, which the same stage works out, has more than as many again and counts nothing.
TEST(ResponseFlops, AreThoseOfTheFormulaCountedByHand) {
  EXPECT_EQ(count_response_flops({}).tet, 18u);
  EXPECT_EQ(count_response_flops({}).volume, 0u);
  Tissue tissue;
  tissue.law = LinearLaw{1000.0};
  EXPECT_EQ(count_response_flops(tissue).tet, 21u);
}

// Fibres by hand, on small strain: H a 15, a·H a 5, and for each of nine components c times it, a_i a_k and a multiply-add.
TEST(ResponseFlops, OfFibresComeOnTop) {
  Tissue tissue;
  tissue.fibres = Fibres{.direction = {1.0, 0.0, 0.0}, .stiffness = 1000.0};
  EXPECT_EQ(count_response_flops(tissue).tet, 18u + 15u + 5u + 9u * (1u + 1u + 2u));
}

// Laws by hand: a smooth step has x − x₀, t t, t + t, 3 − 2t, their product and two multiply-adds; a polynomial one
// multiply-add a coefficient; an exponential its argument, Highway's 25 and one. Comparing and choosing are none.
TEST(LawFlops, AreThoseOfTheFormulaCountedByHand) {
  EXPECT_EQ(count_law_flops(ConstantLaw{}), 0u);
  EXPECT_EQ(count_law_flops(StepLaw{.threshold = 0.1, .above = 2.0, .width = 0.0}), 0u);
  EXPECT_EQ(count_law_flops(StepLaw{.threshold = 0.1, .above = 2.0, .width = 0.2}), 9u);
  EXPECT_EQ(count_law_flops(LinearLaw{1.0}), 2u);
  EXPECT_EQ(count_law_flops(PolynomialLaw{{1.0, 2.0, 3.0}}), 6u);
  EXPECT_EQ(count_law_flops(ExponentialLaw{1.0, 2.0}), 1u + 25u + 2u);
  EXPECT_EQ(count_law_flops(TableLaw{{0.0, 0.1, 1.0}, {1.0, 2.0, 3.0}}), 3u);
}

// Each branch of Maxwell does the same: two cost the same more than one as three more than two.
TEST(ResponseFlops, GrowWithEachBranchAlike) {
  Tissue tissue = with(NeoHookean{.mu = 1000.0, .bulk_modulus = 1e4});
  std::vector<std::size_t> counts{count_response_flops(tissue).tet};
  for (int k = 0; k < 3; ++k) {
    tissue.maxwell.push_back({.share = 0.2, .time = 1.0});
    counts.push_back(count_response_flops(tissue).tet);
  }
  EXPECT_GT(counts[1], counts[0]);
  EXPECT_GT(counts[2], counts[1]);
  EXPECT_EQ(counts[3] - counts[2], counts[2] - counts[1]);
}

// Small strain with branches in one pass: strain 3, stress 3 + 2 + 6, of the deviator 6 more; a branch adds 6 products of two to
// q, as many to what has relaxed, and 6 × 3 to its memory.
TEST(ResponseFlops, OfOnePassAreCountedByHand) {
  Tissue tissue;
  tissue.maxwell = {{.share = 0.2, .time = 1.0}};
  tissue.maxwell_part = MaxwellPart::all;
  const std::size_t one = count_response_flops(tissue).tet;
  tissue.maxwell.push_back({.share = 0.2, .time = 2.0});
  EXPECT_EQ(count_response_flops(tissue).tet - one, 6u * (2 + 2 + 3));
  tissue.maxwell_part = MaxwellPart::deviator;
  EXPECT_EQ(count_response_flops(tissue).tet - one, 6u * (2 + 2 + 3) + 6u);
}

// A law with more in it counts more; shared volumes have a pass of their own.
TEST(ResponseFlops, FollowTheLaw) {
  const std::size_t neo_hookean = count_response_flops(with(NeoHookean{.mu = 1000.0, .bulk_modulus = 1e4})).tet;
  const std::size_t mooney =
      count_response_flops(with(MooneyRivlin{.c10 = 300.0, .c01 = 200.0, .bulk_modulus = 1e4})).tet;
  const std::size_t fung = count_response_flops(with(Fung{.mu = 1000.0, .b = 1.0, .bulk_modulus = 1e4})).tet;
  EXPECT_GT(mooney, neo_hookean);
  EXPECT_GT(fung, neo_hookean + 24u) << "an exponential, and its argument";
  Tissue shared = with(NeoHookean{.mu = 1000.0, .bulk_modulus = 1e4});
  shared.volume_change = VolumeChange::average_nodal;
  EXPECT_GT(count_response_flops(shared).volume, 0u);
}

}  // namespace
}  // namespace glisson::engine
