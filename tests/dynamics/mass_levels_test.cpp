// The mass that stiff tets ask for in the place of a shorter step: enough by the dense spectrum, and only while they are stiff.
#include "dynamics/step/mass_levels.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <sstream>

#include "dynamics/step/stable_step.h"
#include "dynamics/stiff_tets.h"
#include "glisson/archive.h"

namespace glisson {
namespace {

using test::add_element, test::small_body, test::some_stiff, test::top_eigenvalue;

// With the masses that stiff tets ask for, the dense spectrum of all of the body is as good as without stiff tets; a quarter of them is
// not enough where one tet is far stiffer than its block.
TEST(MassLevels, MassesLeaveTheStepAsItIs) {
  int short_of_mass = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random(seed);
    const Body body = small_body(random);
    const std::vector<double> base{1.0, 2.5};
    const std::vector<StiffElement> stiff = some_stiff(body, 1 + seed % 7, false, random);
    MassLevels levels(body);
    levels.raise(stiff, base, base);
    const std::vector<double> none(body.vertex_count, 0.0);
    const double h = stable_step(body, base, none).step;
    std::vector<VertexMass> masses;
    levels.find_masses(base, {0, 0}, {.step = h}, masses);
    EXPECT_TRUE(std::ranges::is_sorted(masses, {}, &VertexMass::vertex));
    const Eigen::Index n = static_cast<Eigen::Index>(3 * body.vertex_count);
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
    std::vector<double> ratio(body.elements.size());
    for (std::uint32_t e = 0; e < body.elements.size(); ++e) {
      ratio[e] = base[static_cast<std::size_t>(&body.block_of(e) - body.blocks.data())];
    }
    for (const StiffElement& s : stiff) ratio[s.element] = std::max(ratio[s.element], s.ratio);
    for (std::uint32_t e = 0; e < body.elements.size(); ++e) {
      add_element(body, e, body.block_of(e).elastic, ratio[e], false, K);
    }
    const auto step_with = [&](double share) {
      Body heavy = body;
      for (const VertexMass& m : masses) heavy.masses[m.vertex] += share * m.mass;
      return 2.0 / std::sqrt(top_eigenvalue(heavy, K));
    };
    EXPECT_GE(step_with(1.0), h) << seed;
    if (step_with(0.25) < h) ++short_of_mass;
  }
  EXPECT_GT(short_of_mass, 20);
}

// Where a body does not bear a level itself at h, its elements get what they lack: the dense spectra of stiffness and viscosity, with a
// stiff tet among them, are as the step asks; a third of the mass is not enough. The scheme's own step with drag at v₋, and stages.
TEST(MassLevels, ElementsGetWhatTheyLack) {
  int short_of_mass = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random(seed);
    const Body body = small_body(random, 4.0);
    const std::vector<double> base{1.25, 2.5};
    const std::vector<StiffElement> stiff = some_stiff(body, seed % 3, false, random);
    const Eigen::Index n = static_cast<Eigen::Index>(3 * body.vertex_count);
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n), C = K;
    for (std::uint32_t e = 0; e < body.elements.size(); ++e) {
      const TissueBlock& block = body.block_of(e);
      double ratio = base[static_cast<std::size_t>(&block - body.blocks.data())];
      for (const StiffElement& s : stiff) ratio = s.element == e ? std::max(ratio, s.ratio) : ratio;
      add_element(body, e, block.elastic, ratio, false, K);
      add_element(body, e, block.viscous, 1.0, false, C);
    }
    const std::vector<double> none(body.vertex_count, 0.0);
    const double h = (2.0 + seed % 4) * stable_step(body, base, none).step;
    MassLevels levels(body);
    levels.raise(stiff, base, base);
    const auto bears = [&](const MassNeed& need, double share) {
      std::vector<VertexMass> masses;
      levels.find_masses(base, {0, 0}, need, masses);
      Body heavy = body;
      for (const VertexMass& m : masses) heavy.masses[m.vertex] += share * m.mass;
      if (need.drag_end == 0.0) return top_eigenvalue(heavy, h * h * K + 2.0 * h * C) <= 4.0;
      return top_eigenvalue(heavy, h * h * K) <= 4.0 && top_eigenvalue(heavy, h * C) <= need.drag_end;
    };
    const MassNeed lags{.step = h, .at_level = true, .drags = true},
        staged{.step = h, .at_level = true, .drag_end = 0.5};
    EXPECT_TRUE(bears(lags, 1.0)) << seed;
    EXPECT_TRUE(bears(staged, 1.0)) << seed;
    if (!bears(lags, 0.3) && !bears(staged, 0.3)) ++short_of_mass;
  }
  EXPECT_GT(short_of_mass, 30);
}

// What elements lack is kept while step and levels stay as they are: after another step, another level, another shape or other tissue
// it is what levels give that have kept nothing.
TEST(MassLevels, AskAnewWhereTheStepOrTheBodyIsAnother) {
  std::mt19937 random(11);
  Body body = small_body(random, 4.0);
  const std::vector<double> low{1.25, 2.5}, high{2.0, 2.5};
  const std::vector<StiffElement> stiff = some_stiff(body, 3, false, random);
  const std::vector<double> none(body.vertex_count, 0.0);
  const double h = 3.0 * stable_step(body, low, none).step;
  const auto masses_of = [&](MassLevels& levels, std::span<const double> base, const MassNeed& need) {
    std::vector<VertexMass> masses;
    levels.find_masses(base, {0, 0}, need, masses);
    std::vector<double> all(body.vertex_count, 0.0);
    for (const VertexMass& m : masses) all[m.vertex] = m.mass;
    return all;
  };
  MassLevels levels(body);
  levels.raise(stiff, low, low);
  const auto expect_as_fresh = [&](std::span<const double> base, const MassNeed& need) {
    MassLevels fresh(body);
    fresh.raise(stiff, low, low);
    const std::vector<double> masses = masses_of(levels, base, need);
    EXPECT_EQ(masses, masses_of(fresh, base, need));
    return masses;
  };
  const MassNeed need{.step = h, .at_level = true, .drag_end = 0.5},
      longer{.step = 1.1 * h, .at_level = true, .drag_end = 0.5};
  const std::vector<double> first = expect_as_fresh(low, need);
  EXPECT_EQ(expect_as_fresh(low, need), first);
  EXPECT_NE(expect_as_fresh(low, longer), first);
  EXPECT_NE(expect_as_fresh(high, need), first);
  EXPECT_NE(expect_as_fresh(low, {.step = h, .drag_end = 0.5}), first);
  EXPECT_NE(expect_as_fresh(low, {.step = 0.1 * h}), first) << "where elements lack nothing";
  EXPECT_EQ(expect_as_fresh(low, need), first);
  const std::vector<std::uint32_t> seven{7};
  body.rest[7].volume *= 2.0;
  levels.reshape(seven);
  const std::vector<double> reshaped = expect_as_fresh(low, need);
  EXPECT_NE(reshaped, first);
  for (TissueBlock& block : body.blocks) block.viscous.mu *= 3.0, block.viscous.lambda *= 3.0;
  levels.tissues_changed();
  EXPECT_NE(expect_as_fresh(low, need), reshaped);
}

struct OneTet {
  std::mt19937 random{6};
  Body body = small_body(random);
  std::vector<double> base{1.0, 1.0};
  MassLevels levels{body};
  std::vector<StiffElement> told(double ratio, double norm = 0.0) const {
    return {{7, ratio, norm > 0.0 ? norm : ratio}};
  }
  void settle() {
    for (std::uint32_t part = 0; part < MassLevels::kParts; ++part) levels.settle(part);
  }
  double mass() {
    std::vector<VertexMass> masses;
    levels.find_masses(base, {0, 0}, {.step = 1e-4}, masses);
    double sum = 0.0;
    for (const VertexMass& m : masses) sum += m.mass;
    return sum;
  }
};

// A level has a tenth of room above what was seen; a tet above it says how much it has risen since it was told last, and the first
// time of all not at all. Once it has softened its mass follows down, and one that is not told any more has none.
TEST(MassLevels, FollowATetUpAndDown) {
  OneTet one;
  EXPECT_FALSE(one.levels.bear(one.told(10.0), one.base));
  EXPECT_EQ(one.levels.raise(one.told(10.0), one.base, one.base), 1.0);
  EXPECT_TRUE(one.levels.bear(one.told(10.99), one.base));
  EXPECT_FALSE(one.levels.bear(one.told(11.01), one.base));
  EXPECT_FALSE(one.levels.bear(one.told(10.0, 11.01), one.base));
  EXPECT_TRUE(one.levels.bear(std::vector<StiffElement>{{8, 0.99, 0.99}}, one.base));
  EXPECT_NEAR(one.levels.raise(one.told(13.0), one.base, one.base), 1.3, 1e-6);
  const std::vector<StiffElement> newcomer{{9, 3.0, 3.0}};
  EXPECT_NEAR(one.levels.raise(newcomer, one.base, std::vector<double>{2.0, 2.0}), 1.5, 1e-6);
  const double at_peak = one.mass();
  one.settle();
  EXPECT_NEAR(one.mass(), at_peak, 1e-6 * at_peak);
  one.levels.raise(one.told(2.0), one.base, one.base);
  one.settle();
  EXPECT_LT(one.mass(), 0.15 * at_peak);
  EXPECT_GT(one.mass(), 0.0);
  one.settle();
  EXPECT_EQ(one.mass(), 0.0);
}

// A tet has to be told from just below its level on: every tet that bear() would refuse is above its limit.
TEST(MassLevels, LimitWhatHasToBeTold) {
  OneTet one;
  EXPECT_EQ(one.levels.limits()[7].ratio, 0.0F);
  one.levels.raise(one.told(10.0, 4.0), one.base, one.base);
  EXPECT_TRUE(one.levels.limits()[7].covers(one.told(10.7, 4.2).front()));
  EXPECT_FALSE(one.levels.limits()[7].covers(one.told(10.9, 4.0).front()));
  EXPECT_FALSE(one.levels.limits()[7].covers(one.told(10.0, 4.39).front()));
  EXPECT_FALSE(one.levels.limits()[8].covers({8, 1.01, 1.01}));
}

// Elements that are gone ask for nothing, one that is larger at rest asks for more; what is saved is read back.
TEST(MassLevels, FollowTheMeshAndSurviveACheckpoint) {
  OneTet one, read;
  one.levels.raise(std::vector<StiffElement>{{30, 8.0, 5.0}, {7, 10.0, 10.0}, {2, 3.0, 3.0}}, one.base, one.base);
  restore(read.levels, archived(one.levels));
  const double before = one.mass();
  EXPECT_EQ(read.mass(), before);
  EXPECT_EQ(read.levels.limits()[30].norm, one.levels.limits()[30].norm);
  one.body.rest[7].volume *= 2.0;
  const std::vector<std::uint32_t> seven{7}, gone{7, 30};
  one.levels.reshape(seven);
  EXPECT_GT(one.mass(), before);
  one.levels.remove(gone);
  EXPECT_GT(one.mass(), 0.0);
  EXPECT_LT(one.mass(), 0.5 * before);
  EXPECT_EQ(one.levels.limits()[7].ratio, 0.0F);
}

}  // namespace
}  // namespace glisson
