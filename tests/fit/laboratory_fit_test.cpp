// Several tests of a laboratory in one fit: measured tissue against known optima, twins against the truth.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fit/run_fit.h"
#include "laboratory.h"
#include "phantom.h"

namespace glisson::fit::laboratory_fit_test {
namespace {

using namespace laboratory;

// One Ogden term fitted to the three tests together, each weighed by its largest stress: the optimum of least squares with an
// incompressible law has R² 0.926, 0.997 and 0.977 at α = −18.7.
TEST(LaboratoryFit, CortexIsFittedInThreeTestsTogether) {
  const FitResult r = run_fit(test::shipped("scenes/fit/brain_cortex.toml"));
  ASSERT_EQ(r.tests.size(), 3u);
  const double expected[]{0.926, 0.997, 0.977};
  for (std::size_t t = 0; t < 3; ++t) {
    EXPECT_NEAR(r.tests[t].r2, expected[t], 0.002) << r.tests[t].name;
    EXPECT_EQ(r.tests[t].points, 17u);
    EXPECT_EQ(r.tests[t].unit, "Pa");
    ASSERT_EQ(r.tests[t].r2_of_alone.size(), 3u);
    EXPECT_GT(r.tests[t].r2_of_alone[t], 0.98) << "alone, each test is met";
  }
  EXPECT_LT(r.tests[1].r2_of_alone[0], 0.0) << "tension alone knows nothing of compression";
  EXPECT_NEAR(r.parameters[1].value, -18.7, 0.2);
  EXPECT_EQ(r.unit, "Pa");
}

constexpr const char* kQuasiLinear = R"(
[specimen]
kind = "point"
[tissue]
hyperelastic = { kind = "ogden", mu_Pa = [800], alpha = [-9], bulk_modulus_Pa = 1e6 }
maxwell = [{ share = 0.6, time_s = 2 }, { share = 0.2, time_s = 80 }]
[[parameter]]
key = "tissue.hyperelastic.mu_Pa[0]"
low = 10
high = 1e5
[[parameter]]
key = "tissue.hyperelastic.alpha[0]"
low = -30
high = -0.5
scale = "linear"
[[parameter]]
key = "tissue.maxwell[0].share"
low = 0.01
high = 0.7
scale = "linear"
[[parameter]]
key = "tissue.maxwell[0].time_s"
low = 0.2
high = 20
[[parameter]]
key = "tissue.maxwell[1].share"
low = 0.01
high = 0.29
scale = "linear"
[[parameter]]
key = "tissue.maxwell[1].time_s"
low = 20
high = 1000
[[data]]
name = "to 0.9"
files = ["muscle_hold_10.csv"]
test = "relaxation"
columns.cauchy_stress = { name = "cauchy_stress_kPa" }
[[data]]
name = "to 0.8"
files = ["muscle_hold_20.csv"]
test = "relaxation"
columns.cauchy_stress = { name = "cauchy_stress_kPa" }
[[data]]
name = "to 0.7"
files = ["muscle_hold_30.csv"]
test = "relaxation"
columns.cauchy_stress = { name = "cauchy_stress_kPa" }
[search]
starts = 2
weighing = "peak"
[proof]
profiles = false
bootstrap = 0
)";

// Quasi-linear branches: the least squares of one Ogden term and two branches leave R² 0.73, 0.41 and 0.90 of three depths.
// Along the same ramp, 1 % of height a second to a stretch of 0.9, the specimens carry 0.163, 0.300 and 0.255 kPa.
TEST(LaboratoryFit, ThreeDepthsOfMuscleShareNoQuasiLinearLaw) {  // long
  const FitResult r = run_fit(parse_fit(kQuasiLinear, test::shipped("scenes/fit/quasi_linear.toml").string()), {});
  ASSERT_EQ(r.tests.size(), 3u);
  const double expected[]{0.73, 0.41, 0.90};
  for (std::size_t t = 0; t < 3; ++t) EXPECT_NEAR(r.tests[t].r2, expected[t], 0.01) << r.tests[t].name;
  const std::vector<double> at_tenth{163.0, 300.0, 255.0};
  for (std::size_t c = 0; c < 3; ++c) {
    const Curve& curve = r.curves[c].curve;
    EXPECT_EQ(curve.measurement.deforming, Deforming::compression);
    std::size_t i = 1;
    while (i + 1 < curve.size() && curve.displacement[i] < 0.1 - 1e-9) ++i;
    const double part = (0.1 - curve.displacement[i - 1]) / (curve.displacement[i] - curve.displacement[i - 1]);
    EXPECT_NEAR(curve.force[i - 1] + part * (curve.force[i] - curve.force[i - 1]), at_tenth[c], 2.0);
  }
}

// Branches whose times follow the strain as powers of it meet all three depths with R² of 0.90 and more, by eight numbers.
TEST(LaboratoryFit, ThreeDepthsOfMuscleShareTimesThatFollowTheStrain) {  // long
  FitSpec spec = load_fit(test::shipped("scenes/fit/muscle_hold.toml"));
  spec.search.starts = 2;
  const FitResult r = run_fit(spec, {});
  ASSERT_EQ(r.tests.size(), 3u);
  for (const auto& t : r.tests) EXPECT_GE(t.r2, 0.90) << t.name;
  EXPECT_LE(r.parameters.size(), 8u);
  EXPECT_NEAR(r.parameters[7].value, 3.0, 0.2);  // of the slow branch, (s/0.2)³
}

// By name the law of one Ogden term comes before all others of one number or two.
TEST(LaboratoryFit, CortexPrefersOgden) {  // long
  FitOptions options;
  options.laws = {"neo_hookean", "mooney_rivlin", "fung", "veronda_westmann", "ogden", "ogden2"};
  FitSpec spec = load_fit(test::shipped("scenes/fit/brain_cortex.toml"));
  spec.proof.bootstrap = 0;
  const FitResult r = run_fit(spec, {options, {}, {}});
  std::vector<std::string> short_ones;
  for (const LawResult& law : r.laws) {
    if (law.parameters <= 2) short_ones.push_back(law.name);
  }
  EXPECT_EQ(short_ones.front(), "ogden");
}

// A sweep of frequencies and a creep of the same tissue, together: its branch is found, and each file's columns with it.
TEST(LaboratoryFit, ASweepAndACreepGiveTheBranch) {
  const phantom::Folder folder;
  std::vector<double> hertz, storage, loss, time, stress, strain;
  for (int i = 0; i < 15; ++i) {
    hertz.push_back(std::pow(10.0, -2.0 + 0.2 * i));
    const double x = 2.0 * std::numbers::pi * hertz.back() * 3.0;
    storage.push_back(1e3 * (0.5 + 0.5 * x * x / (1.0 + x * x)));
    loss.push_back(1e3 * 0.5 * x / (1.0 + x * x));
  }
  // γ = τ/μ (1 + g/(1 − g) (1 − e^{−(1 − g) t/τ})) after a load at once
  for (int i = 0; i < 40; ++i) {
    time.push_back(0.5 * i);
    stress.push_back(50.0);
    strain.push_back(0.05 * (1.0 + 1.0 * -std::expm1(-0.5 * time.back() / 3.0)));
  }
  folder.write("sweep.csv", table({"frequency (Hz)", "storage (Pa)", "loss (Pa)"}, {hertz, storage, loss}));
  folder.write("creep.csv", table({"time (s)", "stress (Pa)", "shear_strain"}, {time, stress, strain}));
  const std::string text = R"([specimen]
kind = "point"
[tissue]
hyperelastic = { kind = "neo_hookean", mu_Pa = 500, bulk_modulus_Pa = 1e6 }
maxwell = [{ share = 0.2, time_s = 1 }]
[[parameter]]
key = "tissue.hyperelastic.mu_Pa"
low = 10
high = 1e5
[[parameter]]
key = "tissue.maxwell.0.share"
low = 0.01
high = 0.95
[[parameter]]
key = "tissue.maxwell.0.time_s"
low = 0.1
high = 100
[[data]]
files = ["sweep.csv"]
test = "oscillation"
columns.storage_modulus.name = "storage"
columns.loss_modulus.name = "loss"
[[data]]
files = ["creep.csv"]
test = "creep"
mode = "simple_shear"
[search]
starts = 4
[proof]
bootstrap = 0
)";
  const FitResult r = run_fit_text(text, (folder.path() / "fit.toml").string());
  EXPECT_NEAR(r.parameters[0].value, 1000.0, 2.0);
  EXPECT_NEAR(r.parameters[1].value, 0.5, 0.002);
  EXPECT_NEAR(r.parameters[2].value, 3.0, 0.02);
  ASSERT_EQ(r.tests.size(), 3u);
  EXPECT_EQ(r.unit, "") << "moduli and strains have no unit in common";
  for (const TestResult& t : r.tests) EXPECT_GT(t.r2, 0.9999) << t.name;
}

// Torque and normal force of Rivlin's cylinder side by side: T = π (c₁ + c₂) R⁴ ψ, and it pushes the plates apart by
// N = ½ π (c₁ + 2 c₂) R⁴ ψ² [Rivlin1949], ψ twist over height. The torque knows the sum of both coefficients alone.
TEST(LaboratoryFit, TorqueAndNormalForcePartMooneysCoefficients) {
  constexpr double kC1 = 300.0, kC2 = 180.0, kRadius = 0.0125, kHeight = 0.01;
  const phantom::Folder folder;
  std::vector<double> angle, torque, normal;
  for (int i = 0; i <= 20; ++i) {
    angle.push_back(0.02 * i);
    const double psi = angle.back() / kHeight, r4 = std::pow(kRadius, 4);
    torque.push_back(1e3 * std::numbers::pi * (kC1 + kC2) * r4 * psi);
    normal.push_back(1e3 * 0.5 * std::numbers::pi * (kC1 + 2.0 * kC2) * r4 * psi * psi);
  }
  folder.write("twist.csv", table({"angle (rad)", "torque (mN m)", "normal force (mN)"}, {angle, torque, normal}));
  const std::string text = R"([specimen]
kind = "cylinder"
diameter_mm = 25
height_mm = 10
[tissue]
hyperelastic = { kind = "mooney_rivlin", c10_Pa = 200, c01_Pa = 200, bulk_modulus_Pa = 1e8 }
[[parameter]]
key = "tissue.hyperelastic.c10_Pa"
low = 1
high = 1e4
[[parameter]]
key = "tissue.hyperelastic.c01_Pa"
low = 1
high = 1e4
[[data]]
files = ["twist.csv"]
test = "torsion"
columns.angle.name = "angle"
columns.torque.name = "torque"
columns.axial_force.name = "normal force"
[search]
starts = 4
[proof]
bootstrap = 0
)";
  const FitResult r = run_fit_text(text, (folder.path() / "fit.toml").string());
  EXPECT_NEAR(r.parameters[0].value, kC1, 1e-3 * kC1);
  EXPECT_NEAR(r.parameters[1].value, kC2, 1e-3 * kC2);
  ASSERT_EQ(r.tests.size(), 2u);
  for (const TestResult& t : r.tests) EXPECT_GT(t.r2, 0.99999) << t.name;
}

// Of all laws of at most two terms one is above 0.985 in each of cortex's tests.
TEST(LaboratoryFit, AFewTermsAreFoundForCortex) {  // long
  FitOptions options;
  options.discover = 2;
  FitSpec spec = load_fit(test::shipped("scenes/fit/brain_cortex.toml"));
  spec.proof.bootstrap = 0, spec.search.starts = 8;
  const FitResult r = run_fit(spec, {options, {}, {}});
  ASSERT_EQ(r.discovered.size(), 36u) << "4 terms alone, 30 pairs with a modulus at rest, one and two of Ogden";
  for (std::size_t i = 1; i < r.discovered.size(); ++i) {
    const DiscoveredLaw &a = r.discovered[i - 1], &b = r.discovered[i];
    EXPECT_TRUE(a.terms < b.terms || (a.terms == b.terms && a.cost <= b.cost));
  }
  double best = 0.0;
  for (const DiscoveredLaw& d : r.discovered) best = std::max(best, d.r2);
  EXPECT_GE(best, 0.985);
}

}  // namespace
}  // namespace glisson::fit::laboratory_fit_test
