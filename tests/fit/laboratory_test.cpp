// Tests of a laboratory: a material point under each of them against closed forms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>

#include "laboratory.h"

namespace glisson::fit::laboratory_test {
namespace {

using namespace laboratory;
using testing::HasSubstr;

TEST(Laboratory, StressesAreRivlins) {
  const std::vector<double> strains{0.0, 0.05, 0.1, 0.3, 0.5};
  for (const Form& form : kForms) {
    const Curve curve = test_of(test_named(form.name), form.deforming, Measured::nominal, strains);
    for (const auto& [tissue, c10, c01] :
         {std::tuple{neo_hooke(), 0.5 * kMu, 0.0}, {mooney(), 0.5 * kMu - kC01, kC01}}) {
      const std::vector<double> stress = answer(tissue, curve);
      for (std::size_t i = 0; i < strains.size(); ++i) {
        const bool sheared = form.deforming == Deforming::simple_shear;
        const double at = sheared ? strains[i] : 1.0 + form.side * strains[i];
        const double exact = form.side * form.stress(at, c10, c01);
        EXPECT_NEAR(stress[i], exact, 1e-6 * kMu + 1e-6 * std::abs(exact)) << form.name << " at " << strains[i];
      }
    }
  }
}

// A body that keeps its volume: σ = P λ, S = P/λ along the axis. In simple shear σ_xz = P_xz = μγ and S_xz = μγ − γ P_zz, where
// P_zz = −μγ²/3 is the deviator's: all of F is held.
TEST(Laboratory, MeasuresOfStressAreThoseOfTheBooks) {
  const std::vector<double> strains{0.1, 0.3, 0.5};
  for (const double side : {1.0, -1.0}) {
    const Deforming way = side > 0.0 ? Deforming::tension : Deforming::compression;
    const LabTest test = side > 0.0 ? LabTest::tension : LabTest::compression;
    const auto P = answer(neo_hooke(), test_of(test, way, Measured::nominal, strains));
    const auto cauchy = answer(neo_hooke(), test_of(test, way, Measured::cauchy, strains));
    const auto piola = answer(neo_hooke(), test_of(test, way, Measured::second_piola, strains));
    for (std::size_t i = 0; i < strains.size(); ++i) {
      const double stretch = 1.0 + side * strains[i];
      EXPECT_NEAR(cauchy[i], P[i] * stretch, 1e-6 * std::abs(P[i]));
      EXPECT_NEAR(piola[i], P[i] / stretch, 1e-12 * std::abs(P[i]));
    }
  }
  const auto cauchy =
      answer(neo_hooke(), test_of(LabTest::simple_shear, Deforming::simple_shear, Measured::cauchy, strains));
  const auto piola =
      answer(neo_hooke(), test_of(LabTest::simple_shear, Deforming::simple_shear, Measured::second_piola, strains));
  for (std::size_t i = 0; i < strains.size(); ++i) {
    const double g = strains[i];
    EXPECT_NEAR(cauchy[i], kMu * g, 1e-9 * kMu);
    EXPECT_NEAR(piola[i], kMu * g + g * kMu * g * g / 3.0, 1e-6 * kMu);
  }
}

// In simple shear the branches are linear: at a constant rate τ = μ γ̇ (t − Σ g (t − τ_k (1 − e^{−t/τ_k}))), and after it the
// hold decays branch by branch.
TEST(Laboratory, AHoldRelaxesByItsBranches) {
  constexpr double kRate = 0.005,
                   kRise = 4.0;  // small: what is carried from the second stress to the first is of third order
  Curve curve = test_of(LabTest::relaxation, Deforming::simple_shear, Measured::nominal, {});
  for (int i = 0; i <= 400; ++i) {
    const double t = i <= 200 ? 0.025 * i : 5.0 + 0.5 * (i - 200);
    curve.time.push_back(t);
    curve.displacement.push_back(kRate * std::min(t, kRise));
  }
  curve.force.assign(curve.size(), 0.0);
  const std::vector<double> stress = answer(relaxing(), curve);
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double t = curve.time[i];
    double exact = kMu * curve.displacement[i];
    for (const auto& [g, tau] : {std::pair{0.4, 2.0}, {0.3, 30.0}}) {
      const double rise = std::min(t, kRise), q = kRate * (rise - tau * -std::expm1(-rise / tau));
      const double end = kRate * kRise;
      exact -= kMu * g * (t <= kRise ? q : end - (end - q) * std::exp(-(t - kRise) / tau));
    }
    EXPECT_NEAR(stress[i], exact, 2e-4 * kMu * kRate * kRise) << t;  // the ramp's corner is a cubic's
  }
}

// Creep answers relaxation: the stress of a ramp and hold, given as the load, gives the ramp and hold. Between rows the load is
// a straight line, which is what is left: 2e-5 with rows 0.1 s apart, of second order in them.
TEST(Laboratory, CreepIsTheInverseOfRelaxation) {
  Curve held = test_of(LabTest::relaxation, Deforming::tension, Measured::nominal, {});
  for (int i = 0; i <= 2000; ++i) {
    held.time.push_back(0.02 * i);
    held.displacement.push_back(0.2 * std::min(1.0, held.time.back() / 10.0));
  }
  held.force.assign(held.size(), 0.0);
  Curve loaded = held;
  loaded.measurement.test = LabTest::creep;
  loaded.measurement.measured = Measured::strain;
  loaded.displacement = answer(relaxing(), held);
  const std::vector<double> strain = answer(relaxing(), loaded);
  for (std::size_t i = 0; i < held.size(); ++i) EXPECT_NEAR(strain[i], held.displacement[i], 1e-6) << held.time[i];
}

// A cylinder's force and a point's stress are one number.
TEST(Laboratory, ASpecimenIsItsPointTimesItsSize) {
  constexpr double kArea = 3e-4, kHeight = 0.012;
  for (const Form& form : kForms) {
    Curve point = test_of(test_named(form.name), form.deforming, Measured::nominal, {0.0, 0.1, 0.2});
    Curve body = point;
    body.measurement.point = false, body.measurement.unit = "N";
    for (double& d : body.displacement) d *= kHeight;
    const SpecimenModel model({body}, {kArea, kHeight}, [&](std::span<const double>) { return mooney(); });
    const std::vector<double> stress = answer(mooney(), point), force = model.predict(0, {}).force;
    for (std::size_t i = 0; i < stress.size(); ++i) EXPECT_NEAR(force[i], stress[i] * kArea, 1e-12);
  }
}

// Rivlin's torque of an incompressible cylinder: T = π μ R⁴ φ / (2 H) for Mooney's law, at any angle [Rivlin1949].
TEST(Laboratory, TorqueIsRivlins) {
  constexpr double kRadius = 0.01, kHeight = 0.02;
  Curve curve = test_of(LabTest::torsion, Deforming::torsion, Measured::torque, {0.0, 0.2, 0.5, 1.0});
  const SpecimenModel model({curve},
                            {.area = std::numbers::pi * kRadius * kRadius, .height = kHeight, .radius = kRadius},
                            [](std::span<const double>) { return mooney(); });
  const std::vector<double> torque = model.predict(0, {}).force;
  ASSERT_EQ(torque.size(), curve.size());
  for (std::size_t i = 0; i < curve.size(); ++i)
    EXPECT_NEAR(torque[i], 0.5 * std::numbers::pi * kMu * std::pow(kRadius, 4) * curve.displacement[i] / kHeight,
                1e-6 * 1e-3);
}

// G′ = μ (1 − Σ g) + μ Σ g ω²τ²/(1 + ω²τ²), G″ = μ Σ g ωτ/(1 + ω²τ²).
TEST(Laboratory, ModuliOfAnOscillationAreMaxwells) {
  const std::vector<double> frequencies{0.001, 0.01, 0.1, 1.0, 10.0};
  for (const Measured measured : {Measured::storage, Measured::loss}) {
    const std::vector<double> found =
        answer(relaxing(), test_of(LabTest::oscillation, Deforming::simple_shear, measured, frequencies));
    for (std::size_t i = 0; i < frequencies.size(); ++i) {
      double exact = measured == Measured::storage ? kMu * 0.3 : 0.0;
      for (const auto& [g, tau] : {std::pair{0.4, 2.0}, {0.3, 30.0}}) {
        const double x = 2.0 * std::numbers::pi * frequencies[i] * tau;
        exact += kMu * g * (measured == Measured::storage ? x * x : x) / (1.0 + x * x);
      }
      EXPECT_NEAR(found[i], exact, 1e-8 * kMu);
    }
  }
}

// A cycle remembers those before it: the stress of the last of three is that of the whole run, of a tissue with branches in a press, in
// shear and in creep.
TEST(Laboratory, ACycleRemembersThoseBefore) {
  for (const auto& [test, deforming, measured, most] :
       {std::tuple(LabTest::cyclic, Deforming::compression, Measured::nominal, 0.1),
        std::tuple(LabTest::cyclic, Deforming::simple_shear, Measured::nominal, 0.2),
        std::tuple(LabTest::creep, Deforming::tension, Measured::strain, 100.0)}) {
    Curve whole = test_of(test, deforming, measured, {});
    for (int i = 0; i <= 120; ++i) {
      whole.time.push_back(0.25 * i);
      whole.displacement.push_back(0.5 * most * (1.0 - std::cos(2.0 * std::numbers::pi * i / 40.0)));
    }
    whole.force.assign(whole.size(), 0.0);
    Curve last = whole;
    for (std::vector<double>* rows : {&last.time, &last.displacement, &last.force})
      rows->erase(rows->begin(), rows->begin() + 80);
    last.past_time.assign(whole.time.begin(), whole.time.begin() + 80);
    last.past_displacement.assign(whole.displacement.begin(), whole.displacement.begin() + 80);
    Curve forgotten = last;
    forgotten.past_time.clear(), forgotten.past_displacement.clear();
    const std::vector<double> all = answer(relaxing(), whole), third = answer(relaxing(), last),
                              alone = answer(relaxing(), forgotten);
    double largest = 0.0, off = 0.0;
    for (std::size_t i = 0; i < third.size(); ++i) {
      largest = std::max(largest, std::abs(all[80 + i]));
      off = std::max(off, std::abs(alone[i] - all[80 + i]));
      EXPECT_NEAR(third[i], all[80 + i], 1e-9 * std::abs(all[100])) << i;
    }
    EXPECT_GT(off, 0.02 * largest) << "without its past it is another";
  }
}

// A tissue with a past under a test whose file has no times.
TEST(Laboratory, APastNeedsTimes) {
  Curve curve = test_of(LabTest::tension, Deforming::tension, Measured::nominal, {0.0, 0.1});
  curve.measurement.timed = false;
  const SpecimenModel model({curve}, {1.0, 1.0}, [](std::span<const double>) { return relaxing(); });
  EXPECT_THAT(model.predict(0, {}).failure, HasSubstr("give columns.time or speed_mm_s"));
}

}  // namespace
}  // namespace glisson::fit::laboratory_test
