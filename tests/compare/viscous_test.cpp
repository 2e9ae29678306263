// Models with viscosity do what is published of them: the closed forms of a bar that is stretched or pressed at a constant rate and held.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "compare/experiments.h"
#include "compare/models/calibration.h"
#include "compare/models/engine.h"

namespace glisson::models {
namespace {

const Stop kGoOn{false};
constexpr double kFace = kEdge * kEdge;
constexpr double kRamp = 0.5, kEnd = 2.0;

/// A smooth step from 0 to 1 over the ramp, and its slope [1/s]: without a jump of the speed nothing rings.
double rise(double t) {
  const double x = std::min(1.0, t / kRamp);
  return x * x * (3.0 - 2.0 * x);
}
constexpr double kMiddleSlope = 1.5 / kRamp;  // half way

/// A bar that is stretched in kRamp and held to kEnd, its sides free.
Problem ramp_and_hold(double strain, const Tissue& tissue, std::array<int, 3> cells = {2, 2, 2}) {
  Problem p = stretched(strain, cells);
  p.tools.front().motion = [strain](double t) { return Vec3d{0, 0, strain * kEdge * rise(t)}; };
  p.duration = p.test_time = kEnd;
  p.stations = {0.25, 0.5, 1.0, 1.5, 2.0};
  p.tissues[0] = tissue;
  return p;
}

/// G(t)/G(0).
double share_at(const Tissue& tissue, double time) {
  double share = 1.0;
  for (const MaxwellBranch& b : tissue.maxwell) share += b.share * std::expm1(-time / b.time);
  return share;
}

/// ∫ (1 − Σ g (1 − e^(−(t − s)/τ))) ds-increments of a stress that grows over the ramp, by the trapezoidal rule in small parts.
template <class Stress>
double faded(const Tissue& tissue, double time, const Stress& stress) {
  constexpr int kParts = 2000;
  const double end = std::min(time, kRamp);
  double sum = 0.0, before = 0.0;
  for (int i = 1; i <= kParts; ++i) {
    const double s = end * i / kParts, now = stress(s);
    sum += share_at(tissue, time - end * (i - 0.5) / kParts) * (now - before);
    before = now;
  }
  return sum;
}

Tissue relaxing(HyperelasticLaw law) {
  Tissue tissue;
  tissue.hyperelastic = std::move(law);
  tissue.maxwell = {{.share = 0.45, .time = 0.3}, {.share = 0.365, .time = 5.0}};
  tissue.maxwell_part = MaxwellPart::all;
  return tissue;
}

/// Where all of the stress fades, sides that are free stay so: S_zz is the elastic one, faded, and P = λ S.
template <class Nominal>
void expect_faded_bar(const Problem& p, const Answer& answer, double strain, const Nominal& nominal) {
  ASSERT_EQ(answer.forces.size(), p.stations.size()) << answer.trouble;
  const auto stretch_at = [&](double t) { return 1.0 + strain * rise(t); };
  for (std::size_t i = 0; i < p.stations.size(); ++i) {
    const double t = p.stations[i];
    const auto second = [&](double s) { return nominal(stretch_at(s)) / stretch_at(s); };
    const double expected = stretch_at(t) * faded(p.tissues.at(0), t, second) * kFace;
    EXPECT_NEAR(answer.forces[i].z / expected, 1.0, 0.015) << "κ = 100 μ and inertia; at " << t;
  }
}

// The brain law: its constants are found again in a tissue of that law, and a bar has its nominal stress 2 (λ − λ⁻²) [C₁₀ + 2 C₂₀ (I₁ − 3) +
// (C₀₁ + 2 C₀₂ (I₂ − 3))/λ], fading by the one course of all constants.
TEST(MillerBrain, ABarFadesAsPublished) {
  constexpr double kC10 = 263.0, kC20 = 491.0;
  Invariants law;
  law.c10 = law.c01 = kC10, law.c20 = law.c02 = kC20;
  law.bulk_modulus = 100.0 * 4.0 * kC10;
  const auto nominal = [&](double l) {
    const double i1 = l * l + 2.0 / l - 3.0, i2 = 2.0 * l + 1.0 / (l * l) - 3.0;
    return 2.0 * (l - 1.0 / (l * l)) * (kC10 + 2.0 * kC20 * i1 + (kC10 + 2.0 * kC20 * i2) / l);
  };
  for (const double strain : {-0.2, 0.15}) {
    const Problem p = ramp_and_hold(strain, relaxing(law));
    expect_faded_bar(p, miller_brain(p, {}, kGoOn), strain, nominal);
  }
}

constexpr double kAlpha = 500.0, kBeta = 1.5;
double pioletti_nominal(double l) {
  return 2.0 * (l - 1.0 / (l * l)) * kAlpha * kBeta * (std::exp(kBeta * (l * l + 2.0 / l - 3.0)) - 0.5 / l);
}

// The ligament law with memory: 2 (λ − λ⁻²) α β [e^(β (I₁ − 3)) − 1/(2 λ)] that fades.
TEST(Pioletti, ABarWithMemoryFades) {
  const Problem p = ramp_and_hold(0.2, relaxing(VerondaWestmann{kAlpha, kBeta, 100.0 * kAlpha * kBeta}));
  expect_faded_bar(p, pioletti_memory(p, {}, kGoOn), 0.2, pioletti_nominal);
}

// With its potential of the rate the stress of a bar that is stretched has 2 η′ (I₁ − 3) (λ² + 1/(2 λ⁴)) dλ/dt more, which is gone at once
// where the bar is held. The three constants are found again in a tissue of that law.
TEST(Pioletti, TheRateAddsStressAndIsForgotten) {
  constexpr double kEta = 3000.0, kStrain = 0.2;
  Tissue tissue;
  tissue.hyperelastic = VerondaWestmann{kAlpha, kBeta, 1000.0 * kAlpha * kBeta};  // I₁ − 3 is small: κ counts
  tissue.viscosity = kEta;
  tissue.viscous_tensor = ViscousTensor::pioletti;
  const Problem p = ramp_and_hold(kStrain, tissue);
  const Answer answer = pioletti_rate(p, {}, kGoOn);
  ASSERT_EQ(answer.forces.size(), p.stations.size()) << answer.trouble;
  const double l = 1.1, i1 = l * l + 2.0 / l;
  const double rate = 2.0 * kEta * (i1 - 3.0) * (l * l + 0.5 / std::pow(l, 4)) * kStrain * kMiddleSlope;
  EXPECT_GT(rate, 0.2 * pioletti_nominal(l)) << "the part is large enough to be seen";
  EXPECT_NEAR(answer.forces[0].z / ((pioletti_nominal(l) + rate) * kFace), 1.0, 0.02);
  EXPECT_NEAR(answer.forces[4].z / (pioletti_nominal(1.2) * kFace), 1.0, 0.02);
}

// A spring and a dashpot: E ε + η ε̇ while it is stretched, E ε where it is held. (proportional: the sides follow by ν)
TEST(KelvinVoigt, StressIsThatOfSpringAndDashpot) {
  constexpr double kEta = 1500.0, kStrain = 0.02;
  const Tissue tissue{.youngs_modulus = kYoung,
                      .poisson_ratio = kPoisson,
                      .viscosity = kEta,
                      .viscous_tensor = ViscousTensor::proportional};
  const Problem p = ramp_and_hold(kStrain, tissue);
  const Answer answer = kelvin_voigt(p, {}, kGoOn);
  ASSERT_EQ(answer.forces.size(), p.stations.size()) << answer.trouble;
  const double stretching = (kYoung * 0.5 * kStrain + kEta * kStrain * kMiddleSlope) * kFace;
  EXPECT_NEAR(answer.forces[0].z / stretching, 1.0, 0.01);
  EXPECT_NEAR(answer.forces[4].z / (kYoung * kStrain * kFace), 1.0, 0.01);
}

// A tissue whose branch is quick is to a slow test a spring of what is left and a dashpot of g E τ.
TEST(KelvinVoigt, IsWhatAQuickBranchLooksLike) {
  constexpr double kStrain = 0.02, kShare = 0.5, kTime = 0.02;
  Tissue tissue{.youngs_modulus = kYoung, .poisson_ratio = kPoisson};
  tissue.maxwell = {{.share = kShare, .time = kTime}};
  tissue.maxwell_part = MaxwellPart::all;
  const Problem p = ramp_and_hold(kStrain, tissue);
  const Answer spring = kelvin_voigt(p, {}, kGoOn), branch = linear_maxwell(p, {}, kGoOn);
  ASSERT_EQ(branch.forces.size(), p.stations.size()) << branch.trouble;
  ASSERT_EQ(spring.forces.size(), p.stations.size()) << spring.trouble;
  for (std::size_t i : {0U, 4U}) EXPECT_NEAR(spring.forces[i].z / branch.forces[i].z, 1.0, 0.02) << i;
  EXPECT_NEAR(branch.forces[4].z / (kYoung * (1.0 - kShare) * kStrain * kFace), 1.0, 0.005);
}

// Linear branches fade by E (1 − Σ g (1 − e^(−t/τ))).
TEST(LinearMaxwell, ABarFades) {
  constexpr double kStrain = 0.02;
  Tissue tissue = relaxing(NeoHookean{1.0, 1.0});
  tissue.hyperelastic.reset();
  const Problem p = ramp_and_hold(kStrain, tissue, {4, 4, 4});  // short steps: forces are read within half of one
  const Answer answer = linear_maxwell(p, {}, kGoOn);
  ASSERT_EQ(answer.forces.size(), p.stations.size()) << answer.trouble;
  for (std::size_t i = 0; i < p.stations.size(); ++i) {
    const double expected =
        faded(tissue, p.stations[i], [&](double s) { return tissue.youngs_modulus * kStrain * rise(s); });
    EXPECT_NEAR(answer.forces[i].z / (expected * kFace), 1.0, 0.01) << p.stations[i];
  }
}

// Models without viscosity have the modulus that a ramp over the test finds: at its end they are where linear tissue that relaxes is.
TEST(ElasticModels, AgreeWithRelaxingTissueAtTheEndOfARamp) {
  Tissue tissue = relaxing(NeoHookean{1.0, 1.0});
  tissue.hyperelastic.reset();
  Problem p = ramp_and_hold(0.02, tissue);
  p.tools.front().motion = ramp_to({0, 0, 0.02 * kEdge}, kEnd);
  const double relaxed = linear_maxwell(p, {}, kGoOn).forces.back().z;
  for (const auto model : {linear_fem, linear_tensor_mass, corotational}) {
    EXPECT_NEAR(model(p, {}, kGoOn).forces.back().z / relaxed, 1.0, 0.01);
  }
  p.test_time = 0.0;
  EXPECT_NEAR(linear_fem(p, {}, kGoOn).forces.back().z / (tissue.youngs_modulus * 0.02 * kFace), 1.0, 1e-9);
}

// The same tissue by explicit and by long implicit steps; elastic tissue is refused where it would be another row.
TEST(OwnTissue, IsTheSameInLongSteps) {
  const Problem p = ramp_and_hold(-0.15, relaxing(NeoHookean{1285.0, 6000.0}));
  const Answer explicit_steps = own_tissue(p, {}, kGoOn), long_steps = own_tissue_implicit(p, {40, 0}, kGoOn);
  ASSERT_EQ(long_steps.forces.size(), p.stations.size()) << long_steps.trouble;
  EXPECT_EQ(long_steps.steps, 40U);
  for (std::size_t i = 0; i < p.stations.size(); ++i) {
    const bool moves = p.stations[i] < kRamp;  // explicit forces are those of up to half a step of 3 ms before or after
    EXPECT_NEAR(long_steps.forces[i].z / explicit_steps.forces[i].z, 1.0, moves ? 0.015 : 0.003) << p.stations[i];
  }
  const Problem elastic = stretched(0.1);
  for (const auto model :
       {own_tissue_implicit, kelvin_voigt, linear_maxwell, miller_brain, pioletti_rate, pioletti_memory})
    EXPECT_NE(model(elastic, {20, 0}, kGoOn).trouble.find("no viscosity"), std::string::npos);
}

// Stations that are not evenly spaced are whole numbers of common steps apart.
TEST(CommonStep, DividesAllStations) {
  EXPECT_DOUBLE_EQ(common_step(std::array{0.25, 0.5, 1.0, 4.0}), 0.25);
  EXPECT_DOUBLE_EQ(common_step(std::array{0.3, 0.4, 1.0}), 0.1);
}

}  // namespace
}  // namespace glisson::models
