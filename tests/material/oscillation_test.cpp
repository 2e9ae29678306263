// The complex modulus of a small oscillation is that of the generalised Maxwell body and of Kelvin and Voigt in closed form, follows
// a static stretch as neo-Hooke's law says, and is what a run in time of the same oscillation settles to.
#include "glisson/oscillation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "glisson/material_point.h"
#include "material/every_tissue.h"

namespace glisson {
namespace {

using Complex = std::complex<double>;
constexpr auto kShear = OscillationMode::simple_shear;
constexpr auto kAxial = OscillationMode::uniaxial;
const std::vector<double> kFrequencies{0.0, 1e-3, 0.05, 1.0, 40.0, 1e4};

double angular(double frequency) { return 2.0 * std::numbers::pi * frequency; }

void expect_modulus(const ComplexModulus& found, Complex exact, double within, const std::string& what) {
  EXPECT_NEAR(found.storage, exact.real(), within * std::abs(exact)) << what;
  EXPECT_NEAR(found.loss, exact.imag(), within * std::abs(exact)) << what;
}

/// 1 − Σ g/(1 + iωτ).
Complex left(const Tissue& tissue, double omega) {
  Complex share = 1.0;
  for (const MaxwellBranch& b : tissue.maxwell) share -= b.share / Complex{1.0, omega * b.time};
  return share;
}

/// E* of G* and a bulk modulus that stays elastic.
Complex young_of(Complex shear, double bulk) { return 9.0 * bulk * shear / (3.0 * bulk + shear); }

// At rest G* = μ (1 − Σ g/(1 + iωτ)) of every law without viscosity, and E* that of G* and κ where the deviator relaxes, of the same
// share as G* where all does. 1e-8; the tangent is exact, so that only rounding is left.
TEST(Oscillation, GeneralisedMaxwellBody) {
  int tissues = 0;
  for (Tissue tissue : test::every_tissue()) {
    if (test::has_directions(tissue) || tissue.fibres || tissue.viscosity > 0.0) continue;
    ++tissues;
    for (const MaxwellPart part : {MaxwellPart::deviator, MaxwellPart::all}) {
      tissue.maxwell = {{0.3, 0.02}, {0.25, 1.5}, {0.2, 60.0}}, tissue.maxwell_part = part;
      const LameParameters lame = lame_at(tissue, 0.0);
      const double mu = tissue.hyperelastic ? tissue.lame().mu : lame.mu;
      const double bulk = (tissue.hyperelastic ? tissue.lame().lambda : lame.lambda) + 2.0 / 3.0 * mu;
      const std::vector<ComplexModulus> G = oscillation(tissue, kFrequencies, 1.0, kShear),
                                        E = oscillation(tissue, kFrequencies, 1.0, kAxial);
      ASSERT_EQ(G.size(), kFrequencies.size());
      for (std::size_t k = 0; k < kFrequencies.size(); ++k) {
        const Complex share = left(tissue, angular(kFrequencies[k]));
        expect_modulus(G[k], mu * share, 1e-8, tissue.name);
        const Complex young = part == MaxwellPart::all ? young_of(mu, bulk) * share : young_of(mu * share, bulk);
        expect_modulus(E[k], young, 1e-8, tissue.name);
      }
    }
  }
  EXPECT_GT(tissues, 40);
}

// Kelvin–Voigt: G* = μ + iωη; E* of that G* and κ with the deviatoric tensor, E + iωη with the proportional one. Pioletti's
// viscosity is 0 at rest.
TEST(Oscillation, KelvinVoigt) {
  for (const Kinematics kinematics : {Kinematics::small, Kinematics::corotational, Kinematics::green}) {
    Tissue tissue;
    tissue.kinematics = kinematics, tissue.viscosity = 30.0, tissue.viscous_tensor = ViscousTensor::deviatoric;
    const LameParameters lame = tissue.lame();
    const double bulk = lame.lambda + 2.0 / 3.0 * lame.mu;
    const std::vector<ComplexModulus> G = oscillation(tissue, kFrequencies),
                                      E = oscillation(tissue, kFrequencies, 1.0, kAxial);
    tissue.viscous_tensor = ViscousTensor::proportional;
    const std::vector<ComplexModulus> P = oscillation(tissue, kFrequencies, 1.0, kAxial);
    tissue.viscous_tensor = ViscousTensor::pioletti;  // a law of large strain
    const std::vector<ComplexModulus> none = kinematics == Kinematics::small
                                                 ? std::vector(kFrequencies.size(), ComplexModulus{lame.mu, 0.0})
                                                 : oscillation(tissue, kFrequencies);
    for (std::size_t k = 0; k < kFrequencies.size(); ++k) {
      const Complex rate{0.0, angular(kFrequencies[k])}, exact = lame.mu + rate * tissue.viscosity;
      expect_modulus(G[k], exact, 1e-8, "shear");
      expect_modulus(E[k], young_of(exact, bulk), 1e-8, "axial, deviatoric");
      expect_modulus(P[k], tissue.youngs_modulus + rate * tissue.viscosity, 1e-8, "axial, proportional");
      expect_modulus(none[k], lame.mu, 1e-8, "pioletti");
    }
  }
}

// Neo-Hooke about a static stretch, incompressible: dP_xz/dF_xz = μ of the elastic part, of which S holds μ (1 − c) while the
// branches stay and μ c goes with dS, c = I₁/(3 λ²). With λ/a² = λ² and one branch
//   G* = μ λ² (1 − g (1 − c) − g c/(1 + iωτ)),   and without branches E* = μ (λ² + 2/λ)
// which is λ² dP/dλ of P = μ (λ − λ⁻²). κ = 3·10¹¹ Pa: 1e-6.
TEST(Oscillation, StretchedNeoHooke) {
  const double mu = 1000.0, g = 0.4, tau = 0.3;
  Tissue tissue;
  tissue.hyperelastic = HyperelasticLaw{NeoHookean{mu, 3e11}};
  for (const double stretch : {0.6, 0.9, 1.2, 1.7}) {
    const double square = stretch * stretch, c = (square + 2.0 / stretch) / (3.0 * square);
    tissue.maxwell.clear();
    const std::vector<double> one{1.0};
    expect_modulus(oscillation(tissue, one, stretch, kShear)[0], mu * square, 1e-6, "shear");
    expect_modulus(oscillation(tissue, one, stretch, kAxial)[0], mu * (square + 2.0 / stretch), 1e-6, "axial");
    tissue.maxwell = {{g, tau}};
    const std::vector<ComplexModulus> G = oscillation(tissue, kFrequencies, stretch);
    for (std::size_t k = 0; k < kFrequencies.size(); ++k) {
      const Complex relaxing = g * c / Complex{1.0, angular(kFrequencies[k]) * tau};
      expect_modulus(G[k], mu * square * (1.0 - g * (1.0 - c) - relaxing), 1e-6, "with a branch");
    }
  }
}

/// The modulus that a run in time shows: Fourier's coefficient of the force over the eighth period, by that of the strain, about a
/// state that has relaxed. The strain is a polygon, so viscous stress jumps at its corners: each side is integrated from its own
/// first stress, after a millionth of the step, to its last.
Complex measured(const Tissue& tissue, OscillationMode mode, double stretch, double frequency, double amplitude,
                 int steps) {
  MaterialPoint point(tissue);
  MaterialTargets targets = test_targets(MaterialTest::uniaxial, MaterialControl::deformation, stretch);
  point.advance(1e9, targets);
  const Mat3d F = point.state().deformation;
  const bool shear = mode == kShear;
  if (shear) {
    for (std::size_t i = 0; i < 2; ++i) targets(i, i) = {MaterialControl::deformation, F(i, i)};
  }
  const std::size_t i = shear ? 0 : 2;
  const double rest = F(i, 2), period = 1.0 / frequency;
  constexpr double kFirst = 1e-6;
  const auto strain = [&](double step) { return rest + amplitude * std::sin(2.0 * std::numbers::pi * step / steps); };
  Complex force = 0.0;
  for (int k = 0; k < 8 * steps; ++k) {
    const double phase = 2.0 * std::numbers::pi / steps, h = period / steps;
    targets(i, 2).value = strain(k) + kFirst * (strain(k + 1) - strain(k));
    const double first = point.advance(kFirst * h, targets).nominal(i, 2);
    targets(i, 2).value = strain(k + 1);
    const double last = point.advance((1.0 - kFirst) * h, targets).nominal(i, 2);
    if (k < 7 * steps) continue;
    force += 0.5 * (first * std::polar(1.0, -phase * k) + last * std::polar(1.0, -phase * (k + 1))) / double(steps);
  }
  // sin is the imaginary part of e^(iωt): its coefficient is −i/2
  const Complex per_strain = force / (amplitude * Complex{0.0, -0.5});
  const double slenderness = test::is_small(tissue) ? 1.0 : F(2, 2) / (F(0, 0) * F(1, 1));
  return slenderness * per_strain;
}

// A run in time settles to the same modulus. Its amplitude of 1e-4 adds some 1e-8; what is left is the error of a sine as a polygon of
// N sides and of the trapezoidal rule, (2π/N)²/12 each, 1e-5 of a 600th of a period, and where viscous sides move some 5e-5 of their
// stages: bound 1e-4. In shear a quarter of it with twice the steps.
TEST(Oscillation, IsWhatARunInTimeSettlesTo) {
  Tissue ogden;
  ogden.name = "ogden", ogden.hyperelastic = HyperelasticLaw{Ogden{{600.0, 300.0}, {-4.0, 3.0}, 2e4}};
  ogden.maxwell = {{0.3, 0.05}, {0.2, 0.2}}, ogden.viscosity = 8.0;
  Tissue green;
  green.name = "green", green.kinematics = Kinematics::green,
  green.law = ExponentialLaw{.amplitude = 900.0, .rate = 4.0};
  green.law_form = LawForm::energy, green.maxwell = {{0.5, 0.1}}, green.maxwell_part = MaxwellPart::all;
  Tissue piolet = green;
  piolet.name = "pioletti", piolet.viscosity = 50.0, piolet.viscous_tensor = ViscousTensor::pioletti;
  const double frequency = 1.5;
  for (const Tissue& tissue : {ogden, green, piolet}) {
    for (const OscillationMode mode : {kShear, kAxial}) {
      for (const double stretch : {0.85, 1.15}) {
        const ComplexModulus found = oscillation(tissue, {&frequency, 1}, stretch, mode)[0];
        const Complex exact{found.storage, found.loss};
        const auto error = [&](int steps) {
          return std::abs(measured(tissue, mode, stretch, frequency, 1e-4, steps) - exact) / std::abs(exact);
        };
        const double fine = error(600);
        EXPECT_LT(fine, 1e-4) << tissue.name << ", λ = " << stretch;
        if (mode == kShear) {
          EXPECT_NEAR(error(300) / fine, 4.0, 0.1) << tissue.name << ", λ = " << stretch;
        }
        EXPECT_GT(found.loss, 0.0);
      }
    }
  }
}

TEST(Oscillation, MagnitudeAndLossTangent) {
  const ComplexModulus m{300.0, 400.0};
  EXPECT_DOUBLE_EQ(m.magnitude(), 500.0);
  EXPECT_DOUBLE_EQ(m.loss_tangent(), 4.0 / 3.0);
}

// What cannot be is refused by name.
TEST(Oscillation, RefusesBadInput) {
  const auto message = [](const std::function<void()>& call) -> std::string {
    try {
      call();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return {};
  };
  const std::vector<double> wrong{1.0, -2.0}, right{1.0};
  EXPECT_NE(message([&] { oscillation(Tissue{}, wrong); }).find("frequency 2 = -2 Hz"), std::string::npos);
  EXPECT_NE(message([&] { oscillation(Tissue{}, right, 0.0); }).find("stretch = 0 is outside"), std::string::npos);
  Tissue raw;
  raw.law = LinearLaw{1000.0}, raw.measure = DeformationMeasure::regular_mean_ratio;
  EXPECT_NE(message([&] { oscillation(raw, right); }).find("regular_mean_ratio"), std::string::npos);
}

}  // namespace
}  // namespace glisson
