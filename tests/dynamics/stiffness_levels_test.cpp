// What single stiff tets take off the step: never less than they do by the dense spectrum, and far less than if the whole body
// were as stiff.
#include "dynamics/step/stiffness_levels.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "dynamics/step/stable_step.h"
#include "dynamics/stiff_tets.h"
#include "glisson/archive.h"

namespace glisson {
namespace {

using test::add_element, test::small_body, test::some_stiff, test::top_eigenvalue;

// φ of the level and what is beside it bound the spectrum of the body with each tet's own stiffness, and the step that follows is
// never above the exact one: with one stiff tet and with many, by ratio (a tensor r C₀) and by norm (any tensor below m n).
TEST(StiffnessLevels, BoundTheDenseSpectrum) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random(seed);
    const Body body = small_body(random);
    const std::vector<double> base{1.0, 2.5};
    const bool by_norm = seed % 2 == 0;
    const std::vector<StiffElement> stiff = some_stiff(body, 1 + seed % 7, by_norm, random);
    StiffnessLevels levels(body);
    levels.meet(stiff, base, base);
    levels.raise(1.0);
    const AddedStiffness added = levels.added(base, {0, 0});
    const Eigen::Index n = static_cast<Eigen::Index>(3 * body.vertex_count);
    Eigen::MatrixXd level = Eigen::MatrixXd::Zero(n, n), more = level;
    for (std::uint32_t e = 0; e < body.elements.size(); ++e) {
      const TissueBlock& block = body.block_of(e);
      add_element(body, e, block.elastic, base[static_cast<std::size_t>(&block - body.blocks.data())], false, level);
    }
    for (const StiffElement& s : stiff) {
      const TissueBlock& block = body.block_of(s.element);
      const double above = s.ratio - base[static_cast<std::size_t>(&block - body.blocks.data())];
      if (above > 0.0)
        add_element(body, s.element, block.elastic, by_norm ? std::min(above, s.norm) : above, by_norm, more);
    }
    const std::vector<double> none(body.vertex_count, 0.0);
    const double h_level = stable_step(body, base, none).step;
    const double h = 1.0 / std::sqrt(1.0 / (h_level * h_level) + 0.25 * added.k);
    const double exact = 2.0 / std::sqrt(top_eigenvalue(body, level + more));
    EXPECT_LE(h, exact) << seed;
    EXPECT_GE(h, 0.4 * exact) << "a bound from single tets is within a few times, seed " << seed;
    EXPECT_GE(added.k, top_eigenvalue(body, more)) << seed;
  }
}

// Where viscosity grows with the tets, what they add to it is bounded in the same way.
TEST(StiffnessLevels, BoundTheViscositysSpectrum) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    std::mt19937 random(seed);
    const Body body = small_body(random, 3.0);
    const std::vector<double> base{1.5, 1.0};
    const std::vector<StiffElement> stiff = some_stiff(body, 3, false, random);
    StiffnessLevels levels(body);
    levels.meet(stiff, base, base);
    levels.raise(1.0);
    const Eigen::Index n = static_cast<Eigen::Index>(3 * body.vertex_count);
    Eigen::MatrixXd more = Eigen::MatrixXd::Zero(n, n);
    for (const StiffElement& s : stiff) {
      if (&body.block_of(s.element) == &body.blocks[0]) {
        add_element(body, s.element, body.blocks[0].viscous, s.ratio - base[0], false, more);
      }
    }
    const double c = levels.added(base, {1, 0}).c;
    EXPECT_GE(c, top_eigenvalue(body, more)) << seed;
    EXPECT_EQ(levels.added(base, {0, 0}).c, 0.0);
  }
}

// One tet of many a thousand times as stiff: for most tets the step is more than twice that of a body as stiff throughout. At a
// corner a tet has its vertices for itself and is all that counts; there the level of the body says a little more.
TEST(StiffnessLevels, OneStiffTetCostsLessThanABodyAsStiff) {
  std::mt19937 random(5);
  const TetMesh mesh = test::jittered_box({5, 5, 5}, 0.01, 0.2, random);
  const Body body = build_body(mesh, {{0, Tissue{}}});
  const std::vector<double> one{1.0}, none(body.vertex_count, 0.0);
  const double h = stable_step(body, one, none).step;
  std::vector<double> gain;
  for (std::uint32_t e = 0; e < body.elements.size(); ++e) {
    StiffnessLevels levels(body);
    levels.meet(std::vector<StiffElement>{{e, 1000.0, 1000.0}}, one, one);
    levels.raise(1.0);
    gain.push_back(std::sqrt(1000.0 / (1.0 + 0.25 * h * h * levels.added(one, {0}).k)));
  }
  std::sort(gain.begin(), gain.end());
  EXPECT_GE(gain[gain.size() / 2], 2.0);
  EXPECT_GE(gain.front(), 0.8);
}

// A level has room, so that a tet which stiffens by less is not above it; it follows the tet down, and a tet that is told no more
// is forgotten.
TEST(StiffnessLevels, FollowATetUpAndDown) {
  std::mt19937 random(6);
  const Body body = small_body(random);
  const std::vector<double> base{1.0, 1.0};
  const auto told = [](double ratio) { return std::vector<StiffElement>{{7, ratio, ratio}}; };
  StiffnessLevels levels(body);
  EXPECT_TRUE(levels.meet(told(10.0), base, base).above);
  levels.raise(1.0);
  EXPECT_FALSE(levels.meet(told(10.4), base, base).above);
  const StiffnessLevels::Met met = levels.meet(told(13.0), base, base);
  EXPECT_TRUE(met.above);
  EXPECT_NEAR(met.rise, 1.25, 1e-12);
  levels.raise(4.0);
  const double at_peak = levels.added(base, {0, 0}).k;
  levels.settle();
  levels.meet(told(2.0), base, base);
  levels.settle();
  EXPECT_LT(levels.added(base, {0, 0}).k, 0.15 * at_peak);
  levels.settle();
  EXPECT_TRUE(levels.empty());
  EXPECT_EQ(levels.added(base, {0, 0}).k, 0.0);
}

// Elements that are gone take nothing; and what is saved is read back.
TEST(StiffnessLevels, ForgetWhatIsRemovedAndSurviveACheckpoint) {
  std::mt19937 random(6);
  Body body = small_body(random);
  const std::vector<double> base{1.0, 1.0};
  StiffnessLevels levels(body), read(body);
  levels.meet(std::vector<StiffElement>{{30, 8.0, 5.0}, {7, 10.0, 10.0}, {2, 3.0, 3.0}}, base, base);
  levels.raise(1.0);
  restore(read, archived(levels));
  EXPECT_EQ(read.added(base, {0, 0}).k, levels.added(base, {0, 0}).k);
  const std::vector<std::uint32_t> gone{7, 30};
  levels.remove(gone);
  EXPECT_EQ(levels.count_above(base), 1U);
  EXPECT_LT(levels.added(base, {0, 0}).k, read.added(base, {0, 0}).k);
}

}  // namespace
}  // namespace glisson
