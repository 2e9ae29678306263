// The parts of a needle against closed forms: the mean over a zone of tissue, the bending cantilever, stick–slip.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "contact/shaft_block.h"
#include "instruments/needle/cantilever.h"
#include "instruments/needle/tissue_zone.h"

namespace glisson::needle_parts_test {
namespace {

const TetMesh& fine() {
  static const TetMesh mesh = box_mesh({.cells = {12, 12, 12}, .size = {0.024, 0.024, 0.024}});
  return mesh;
}

template <class F>
double mean(const std::vector<VertexWeight>& weights, F value) {
  double sum = 0.0;
  for (const VertexWeight& w : weights) sum += w.weight * value(fine().vertices[w.vertex]);
  return sum;
}

// Inside the body the mean of a linear field is its value at the point, whatever the mesh: the rule is symmetric and the
// shape functions hold linear fields. Up to 4704 points of sums of some 1: 1e-14.
TEST(TissueZone, MeanOfALinearFieldIsExact) {
  for (const double radius : {1e-4, 1e-3, 3e-3, 9e-3}) {
    const Vec3d x{0.0113, 0.0121, 0.0127};
    const auto weights = TissueZones(fine(), {}, radius).weights(x);
    EXPECT_NEAR(mean(weights, [](const Vec3d&) { return 1.0; }), 1.0, 1e-14);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(mean(weights, [&](const Vec3d& v) { return v[axis]; }), x[axis], 1e-15) << radius;
    }
  }
}

// The mean of s² over the ball is r²/3, that of φ = (1 − s²/r²)²; linear interpolation between vertices 2 mm apart adds up to
// h²/6 of the edge's square. r² = R² − 1.05 h_V², with h_V the edge of a regular tet of h³/6: h_V = 1.12 h.
TEST(TissueZone, SpreadIsThatOfTheKernel) {
  const Vec3d x{0.012, 0.012, 0.012};
  const double radius = 9e-3, h = 2e-3, squared = radius * radius - 1.05 * std::cbrt(2.0) * h * h;
  const auto weights = TissueZones(fine(), {}, radius).weights(x);
  const double spread = mean(weights, [&](const Vec3d& v) { return dot(v - x, v - x); });
  EXPECT_GT(spread, squared / 3.0);
  EXPECT_LT(spread, squared / 3.0 + 3.0 * h * h / 4.0);
}

TEST(TissueZone, SmallZoneIsTheTet) {
  EXPECT_EQ(TissueZones(fine(), {}, 1e-6).weights({0.0113, 0.0121, 0.0127}).size(), 4U);
}

TEST(TissueZone, HalfOutsideStillSumsToOne) {
  TissueZones zones(fine(), {}, 3e-3);
  EXPECT_NEAR(mean(zones.weights({0.012, 0.012, 0.024}), [](const Vec3d&) { return 1.0; }), 1.0, 1e-14);
  EXPECT_TRUE(zones.weights({0.012, 0.012, 0.03}).empty());
}

// Half of a ball on a flat surface has its centre at depth ∫ z φ dV / ∫ φ dV = 35/128 r; a rule with points in the surface
// would count them as of its half, and lie nearer. Of vertices 2 mm apart, 3 %.
TEST(TissueZone, CentreOfAHalfBallIsExact) {
  for (const double radius : {6e-3, 7e-3, 8e-3, 9e-3, 11e-3}) {
    const double r = std::sqrt(radius * radius - 1.05 * std::cbrt(2.0) * 4e-6);
    const auto weights = TissueZones(fine(), {}, radius).weights({0.012, 0.012, 0.024});
    EXPECT_NEAR(0.024 - mean(weights, [](const Vec3d& v) { return v.z; }), 35.0 / 128.0 * r, 0.03 * 35.0 / 128.0 * r)
        << radius;
  }
}

// Deflections of a clamped beam under loads at two points: P a²(3b − a)/6EI.
TEST(Shaft, CantileverBends) {
  const std::vector<double> from_hand{0.04, 0.1};
  const double bending = 0.0255, load = 0.2;
  const Eigen::MatrixXd C = cantilever(from_hand, bending);
  EXPECT_NEAR(C(1, 1) * load, load * 1e-3 / (3.0 * bending), 1e-15);
  EXPECT_NEAR(C(0, 1) * load, load * 0.0016 * (0.3 - 0.04) / (6.0 * bending), 1e-15);
  EXPECT_EQ(C(0, 1), C(1, 0));
  EXPECT_EQ(cantilever(from_hand, 0.0).norm(), 0.0);
  EXPECT_EQ(cantilever(std::vector<double>{-0.01}, bending)(0, 0), 0.0);  // behind the hand nothing bends
}

constexpr double kStep = 1e-3;
const ShaftFriction kFriction{.static_in = 20,
                              .static_out = 18,
                              .dynamic_in = 10,
                              .dynamic_out = 9,
                              .viscous_in = 200,
                              .viscous_out = 250,
                              .stick_speed = 1e-4};

/// Impulse on one row of 10 mm of shaft and mobility 1000/kg at a speed, and whether it slips.
std::pair<double, bool> one_row(double speed, bool slips) {
  Eigen::MatrixXd W(1, 1);
  W << 1000.0;
  const shaft::AxialLimit limit{.length = 0.01, .slips = slips, .is_tip = false, .tip_limit = 0.0};
  double p = 0.0;
  const auto s = shaft::solve_along(W, {&speed, 1}, {&limit, 1}, kFriction, kStep, {&p, 1});
  return {p, s[0] != 0};
}

// A row sticks as long as what stops it is below h D l = 2e-4 N s; speeds below 0.2 m/s do at 1000/kg.
TEST(Shaft, SticksUpToTheStaticLimit) {
  for (const double speed : {0.05, -0.05, 0.199, -0.179}) {
    const auto [p, slips] = one_row(speed, false);
    EXPECT_NEAR(p, speed / 1000.0, 1e-15);
    EXPECT_FALSE(slips);
  }
  EXPECT_TRUE(one_row(0.5, false).second);
  EXPECT_TRUE(one_row(-0.5, false).second);
}

// Slipping, p = h l (C + b v) at the speed v = v₀ − W p that is left: one equation, solved by hand.
TEST(Shaft, SlipsByTheDynamicLaw) {
  const double hl = kStep * 0.01;
  for (const double v0 : {0.5, 2.0}) {
    const double in = hl * (10 + 200 * v0) / (1 + hl * 200 * 1000), out = -hl * (9 + 250 * v0) / (1 + hl * 250 * 1000);
    EXPECT_NEAR(one_row(v0, true).first, in, 1e-15);
    EXPECT_NEAR(one_row(-v0, true).first, out, 1e-15);
  }
}

// Friction never turns a slip around: a slow row is stopped, and sticks again.
TEST(Shaft, SlowSlipIsStopped) {
  const auto [p, slips] = one_row(0.05, true);
  EXPECT_NEAR(p, 0.05 / 1000.0, 1e-15);
  EXPECT_FALSE(slips);
}

// Friction takes energy from the slip at every row, never gives any: p · v ≥ 0 for random coupled rows.
TEST(Shaft, FrictionOpposesSlip) {
  std::srand(5);
  for (int round = 0; round < 200; ++round) {
    const Eigen::MatrixXd B = Eigen::MatrixXd::Random(6, 9);
    const Eigen::MatrixXd W = 300.0 * B * B.transpose();
    const Eigen::VectorXd v0 = Eigen::VectorXd::Random(6);
    std::vector<shaft::AxialLimit> limits;
    for (int j = 0; j < 6; ++j)
      limits.push_back({.length = 0.002 * j, .slips = j % 2 == 0, .is_tip = false, .tip_limit = 0});
    std::vector<double> speed(v0.data(), v0.data() + 6), p(6, 0.0);
    shaft::solve_along(W, speed, limits, kFriction, kStep, p);
    const Eigen::VectorXd left = v0 - W * Eigen::Map<Eigen::VectorXd>(p.data(), 6);
    for (int j = 0; j < 6; ++j) EXPECT_GE(p[static_cast<std::size_t>(j)] * left(j), -1e-9);
  }
}

TEST(Shaft, TipPushesOnlyAndUpToItsLimit) {
  Eigen::MatrixXd W(1, 1);
  W << 1000.0;
  const shaft::AxialLimit limit{.length = 0, .slips = false, .is_tip = true, .tip_limit = 0.1};
  const auto tip = [&](double speed) {
    double p = 0.0;
    const auto cuts = shaft::solve_along(W, {&speed, 1}, {&limit, 1}, kFriction, kStep, {&p, 1});
    return std::pair(p, cuts[0] != 0);
  };
  EXPECT_EQ(tip(-1.0).first, 0.0);
  EXPECT_NEAR(tip(0.05).first, 5e-5, 1e-18);
  EXPECT_FALSE(tip(0.05).second);
  EXPECT_NEAR(tip(0.5).first, 1e-4, 1e-18);
  EXPECT_TRUE(tip(0.5).second);
}

}  // namespace
}  // namespace glisson::needle_parts_test
