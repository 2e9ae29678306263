// Meshes of regions carry load as the bodies they stand for: a thick shell under pressure, a stiff core in a soft ball, and a ball
// squeezed between soft pads, each against its exact solution, and the same however the lattice lies in the body.
//
// The mesher keeps the volume of a ball, so that no radius has to be corrected. Displacements are means over a surface with the
// weight of the load: what the load does work on. Small strain; ν = 0.3.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ball_series.h"
#include "region_mesh_load.h"

namespace glisson {
namespace region_mesh_mechanics {

/// What two meshes of a second-order method make of the value for edge 0.
double extrapolated(double coarse, double fine, double coarse_edge, double fine_edge) {
  const double ratio = (coarse_edge / fine_edge) * (coarse_edge / fine_edge);
  return (ratio * fine - coarse) / (ratio - 1.0);
}

// --- a stiff core in a soft ball under pressure from outside ---------------------------------------------------------------

struct CoreErrors {
  double outside, core;
  std::size_t tets;
};

/// u = A r in the core, B r + C / r² around it; u and σ_rr = 3 K B − 4 μ C / r³ continuous.
CoreErrors core(double edge, const Lay& lay) {
  const double a = 0.5 * kRadius, b = kRadius, p = 1.0;
  const Tissue soft = tissue(5000.0), stiff = tissue(50000.0);
  const auto bulk = [](const Tissue& t) { return t.youngs_modulus / (3.0 * (1.0 - 2.0 * t.poisson_ratio)); };
  Loaded body({ball("core", a, lay), ball("around", b, lay)}, {.edge = edge}, {{1, stiff}, {2, soft}}, lay);
  body.press(false, 0.0, [&](const Vec3d&) { return p; });
  EXPECT_TRUE(body.solve());
  // A a = B a + C/a²;  3 K₁ A = 3 K B − 4 μ C/a³;  3 K B − 4 μ C/b³ = −p
  const double K = bulk(soft), K1 = bulk(stiff), mu = soft.lame().mu, a3 = a * a * a, b3 = b * b * b;
  const double ratio = 3.0 * (K - K1) / (3.0 * K1 + 4.0 * mu);  // C / (a³ B)
  const double B = -p / (3.0 * K - 4.0 * mu * ratio * a3 / b3), C = ratio * a3 * B, A = B + C / a3;
  return {body.radial(false, 0.0) / (B * b + C / (b * b)) - 1.0, body.dilatation(1) / (3.0 * A) - 1.0, body.tets()};
}

// --- a ball squeezed along its axis by p cos⁸θ -----------------------------------------------------------------------------

/// P_n(x).
double legendre(int n, double x) {
  double before = 1.0, at = n == 0 ? 1.0 : x;
  for (int k = 2; k <= n; ++k) {
    const double next = ((2 * k - 1) * x * at - (k - 1) * before) / k;
    before = at, at = next;
  }
  return at;
}

/// What the load does work on: the traction −p x⁸, x = cos θ, has five terms of Legendre.
double squeeze_work(double p, double R, const Tissue& t) {
  std::vector<double> traction(9, 0.0);
  for (int n = 0; n <= 8; n += 2) {
    double coefficient = 0.0;  // of x⁸: (2n + 1)/2 ∫ x⁸ P_n dx
    const int steps = 20000;
    for (int i = 0; i < steps; ++i) {
      const double x = -1.0 + 2.0 * (i + 0.5) / steps;
      coefficient += 0.5 * (2 * n + 1) * std::pow(x, 8) * legendre(n, x) * 2.0 / steps;
    }
    traction[static_cast<std::size_t>(n)] = -p * coefficient;
  }
  return ball_work(traction, R, t);
}

struct SqueezeError {
  double error;
  std::size_t tets;
};

SqueezeError squeeze(const RegionMeshOptions& options, const Lay& lay) {
  const Tissue t = tissue(5000.0);
  Loaded body({ball("ball", kRadius, lay)}, options, {{1, t}}, lay);
  body.press(false, 0.0, [&](const Vec3d& x) { return std::pow(dot(x, lay.axis) / norm(x), 8); });
  EXPECT_TRUE(body.solve());
  return {body.work() / squeeze_work(1.0, kRadius, t) - 1.0, body.tets()};
}

// Displacement elements are too stiff, by the square of the edge: −10.9, −5.8 % at the inner radius were measured with 3000 and 6800
// tets, and 0.7 % extrapolated. The lattice makes no difference.
TEST(RegionMeshMechanics, ThickShellComesToLame) {
  const ShellErrors coarse = shell({.edge = 0.012}, kLevel), fine = shell({.edge = 0.009}, kLevel),
                    turned = shell({.edge = 0.009}, kTurned);
  record("coarse", coarse.inside), record("fine", fine.inside), record("turned", turned.inside);
  EXPECT_LT(fine.tets, 8000u);
  EXPECT_LT(coarse.inside, fine.inside);
  EXPECT_LT(fine.inside, 0.0);
  EXPECT_NEAR(extrapolated(coarse.inside, fine.inside, 0.012, 0.009), 0.0, 0.02);
  EXPECT_NEAR(extrapolated(coarse.outside, fine.outside, 0.012, 0.009), 0.0, 0.02);
  EXPECT_NEAR(turned.inside, fine.inside, 0.01);
  EXPECT_NEAR(turned.outside, fine.outside, 0.01);
}

// −1.9 % inside, −1.5 % outside were measured with 50 400 tets.
TEST(RegionMeshMechanicsLong, ThickShellIsWithinTwoPercent) {  // long
  const ShellErrors s = shell({.edge = 0.0045}, kLevel);
  record("inside", s.inside), record("outside", s.outside);
  EXPECT_LT(s.tets, 52000u);
  EXPECT_NEAR(s.inside, 0.0, 0.02);
  EXPECT_NEAR(s.outside, 0.0, 0.02);
}

// What is measured from outside is right to a thousandth; the core's change of volume, a ninth of that around it, converges:
// 4.8, 2.4 % with 3300 and 8000 tets, −0.6 % extrapolated.
TEST(RegionMeshMechanics, StiffCoreTakesItsShare) {
  const CoreErrors coarse = core(0.012, kLevel), fine = core(0.009, kLevel), turned = core(0.009, kTurned);
  record("coarse", coarse.core), record("fine", fine.core), record("turned", turned.core);
  EXPECT_LT(fine.tets, 9000u);
  EXPECT_NEAR(fine.outside, 0.0, 0.002);
  EXPECT_NEAR(turned.outside, fine.outside, 0.001);
  EXPECT_NEAR(fine.core, 0.0, 0.03);
  EXPECT_LT(fine.core, 0.6 * coarse.core);
  EXPECT_NEAR(extrapolated(coarse.core, fine.core, 0.012, 0.009), 0.0, 0.02);
  EXPECT_NEAR(turned.core, fine.core, 0.01);
}

// 1.4 % was measured with 20 300 tets.
TEST(RegionMeshMechanicsLong, StiffCoreIsWithinTwoPercent) {  // long
  const CoreErrors c = core(0.0065, kTurned);
  record("core", c.core);
  EXPECT_LT(c.tets, 22000u);
  EXPECT_NEAR(c.core, 0.0, 0.02);
}

// The load has an axis, and the lattice may lie along it or not: −2.8 and −3.5 % were measured with 7200 tets, 0.8 and 0.2 %
// extrapolated.
TEST(RegionMeshMechanics, SqueezedBallDoesTheWorkOfTheSeries) {
  for (const Lay& lay : {kLevel, kTurned}) {
    const SqueezeError coarse = squeeze({.edge = 0.012}, lay), fine = squeeze({.edge = 0.009}, lay);
    record(lay.axis.x == 0.0 ? "level" : "turned", fine.error);
    EXPECT_LT(fine.tets, 8000u);
    EXPECT_LT(fine.error, 0.0);
    EXPECT_NEAR(extrapolated(coarse.error, fine.error, 0.012, 0.009), 0.0, 0.02);
  }
}

// −1.6 and −1.9 % were measured with 19 700 tets.
TEST(RegionMeshMechanicsLong, SqueezedBallIsWithinTwoPercentHoweverTheLatticeLies) {  // long
  const SqueezeError level = squeeze({.edge = 0.0065}, kLevel), turned = squeeze({.edge = 0.0065}, kTurned);
  record("level", level.error), record("turned", turned.error);
  EXPECT_LT(level.tets, 21000u);
  EXPECT_NEAR(level.error, 0.0, 0.02);
  EXPECT_NEAR(turned.error, 0.0, 0.02);
  EXPECT_NEAR(turned.error, level.error, 0.01);
}

}  // namespace region_mesh_mechanics
}  // namespace glisson
