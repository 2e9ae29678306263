// What single stiff tets take off the step: never less than they do by the dense spectrum, and far less than if the whole body
// were as stiff.
#include "dynamics/step/stiffness_levels.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "dynamics/step/stable_step.h"
#include "glisson/archive.h"
#include "support/bodies.h"

namespace glisson {
namespace {

/// A jittered box of 40 tets in two tissues.
Body small_body(std::mt19937& random, double viscosity = 0.0) {
  TetMesh mesh = test::jittered_box({2, 2, 2}, 0.01, 0.2, random);
  mesh.regions.assign(mesh.tets.size(), 0);
  for (std::size_t t = mesh.tets.size() / 2; t < mesh.tets.size(); ++t) mesh.regions[t] = 1;
  Tissue soft, firm;
  soft.viscosity = viscosity;
  firm.youngs_modulus *= 5.0, firm.density *= 2.0;
  return build_body(mesh, {{0, soft}, {1, firm}});
}

/// Adds factor times the stiffness of an element: λ tr(H)² + 2 μ ‖sym H‖², or with `norm` the bound m ‖H‖² of it.
void add_element(const Body& body, std::uint32_t e, const LameParameters& lame, double factor, bool norm,
                 Eigen::MatrixXd& K) {
  const ElementRest& rest = body.rest[e];
  const std::array<Vec3d, 4> s{-(rest.s[0] + rest.s[1] + rest.s[2]), rest.s[0], rest.s[1], rest.s[2]};
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) {
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
          const double same = i == j ? dot(s[a], s[b]) : 0.0;
          const double value = norm ? modulus_bound(lame) * same
                                    : lame.lambda * s[a][i] * s[b][j] + lame.mu * (same + s[a][j] * s[b][i]);
          K(static_cast<Eigen::Index>(3 * body.elements[e][a] + i),
            static_cast<Eigen::Index>(3 * body.elements[e][b] + j)) += factor * rest.volume * value;
        }
      }
    }
  }
}

double top_eigenvalue(const Body& body, const Eigen::MatrixXd& K) {
  Eigen::VectorXd scale(K.rows());
  for (Eigen::Index i = 0; i < K.rows(); ++i) scale(i) = 1.0 / std::sqrt(body.masses[static_cast<std::size_t>(i) / 3]);
  const Eigen::MatrixXd A = scale.asDiagonal() * K * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

/// Elements that have become stiff, all with the same norm and ratio, or with a norm that is a fraction of it.
std::vector<StiffElement> some_stiff(const Body& body, std::size_t count, bool by_norm, std::mt19937& random) {
  std::vector<StiffElement> stiff;
  for (std::size_t i = 0; i < count; ++i) {
    const auto e = static_cast<std::uint32_t>(random() % body.elements.size());
    const double ratio = std::pow(10.0, 0.5 + 3.0 * static_cast<double>(random() % 1000) * 1e-3);
    if (std::any_of(stiff.begin(), stiff.end(), [&](const StiffElement& s) { return s.element == e; })) continue;
    stiff.push_back({e, ratio, by_norm ? 0.2 * ratio : ratio});
  }
  return stiff;
}

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

// With the masses that stiff tets ask for, the dense spectrum of all of the body is as good as without stiff tets; a quarter of them is
// not enough where one tet is far stiffer than its block.
TEST(StiffnessLevels, MassesLeaveTheStepAsItIs) {
  int short_of_mass = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random(seed);
    const Body body = small_body(random);
    const std::vector<double> base{1.0, 2.5};
    const std::vector<StiffElement> stiff = some_stiff(body, 1 + seed % 7, false, random);
    StiffnessLevels levels(body);
    levels.meet(stiff, base, base);
    levels.raise(1.0);
    const std::vector<double> none(body.vertex_count, 0.0);
    const double h = stable_step(body, base, none).step;
    std::vector<VertexMass> masses;
    levels.masses_for(base, {0, 0}, h, 1.0, masses);
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
