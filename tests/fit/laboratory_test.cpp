// Tests of a laboratory: a material point under each of them against closed forms, the same test written with other columns,
// several tests in one fit, and what is said of tests that cannot be.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "fit/data/load_curves.h"
#include "fit/fit_curves.h"
#include "fit/forward/specimen_model.h"
#include "fit/run_fit.h"
#include "fit/search/least_squares.h"
#include "fit/uncertainty/covariance.h"
#include "phantom.h"
#include "small_models.h"

namespace glisson::fit::laboratory_test {
namespace {

using phantom::Folder;
using testing::AllOf;
using testing::HasSubstr;

constexpr double kMu = 1000.0, kC01 = 250.0, kBulk = 1e10;  // κ = 1e7 μ: 1e-7 of a stress is left of the volume

Tissue neo_hooke() {
  Tissue tissue;
  tissue.hyperelastic = NeoHookean{kMu, kBulk};
  return tissue;
}

Tissue mooney() {
  Tissue tissue;
  tissue.hyperelastic = MooneyRivlin{0.5 * kMu - kC01, kC01, kBulk};
  return tissue;
}

/// A test of a point: `driven` is a strain, of a shear its amount, of a creep a stress.
Curve test_of(LabTest test, Deforming deforming, Measured measured, std::vector<double> driven) {
  Curve c;
  c.name = std::string(word_of(test));
  c.measurement = {.test = test, .deforming = deforming, .measured = measured, .point = true, .unit = "Pa"};
  for (std::size_t i = 0; i < driven.size(); ++i) c.time.push_back(static_cast<double>(i));
  c.displacement = std::move(driven);
  c.force.assign(c.size(), 0.0);
  return c;
}

std::vector<double> answer(const Tissue& tissue, const Curve& curve) {
  const SpecimenModel model({curve}, {1.0, 1.0}, [&](std::span<const double>) { return tissue; });
  const Prediction p = model.predict(0, {});
  EXPECT_EQ(p.failure, "");
  EXPECT_EQ(p.force.size(), curve.size());
  return p.force;
}

struct Form {
  const char* name;
  Deforming deforming;
  double side;  ///< 1: extends
  /// Nominal stress of Mooney and Rivlin, W = c10 (I₁ − 3) + c01 (I₂ − 3), at a stretch or amount of shear [Rivlin1949].
  double (*stress)(double x, double c10, double c01);
};

double tension(double x, double c10, double c01) { return 2.0 * (x - 1.0 / (x * x)) * (c10 + c01 / x); }
double equibiaxial(double x, double c10, double c01) { return 2.0 * (x - std::pow(x, -5)) * (c10 + c01 * x * x); }
double planar(double x, double c10, double c01) { return 2.0 * (x - std::pow(x, -3)) * (c10 + c01); }
double shear(double x, double c10, double c01) { return 2.0 * (c10 + c01) * x; }

const std::vector<Form> kForms{{"tension", Deforming::tension, 1.0, tension},
                               {"compression", Deforming::compression, -1.0, tension},
                               {"equibiaxial", Deforming::equibiaxial, 1.0, equibiaxial},
                               {"planar", Deforming::planar, 1.0, planar},
                               {"simple_shear", Deforming::simple_shear, 1.0, shear}};

LabTest test_named(const std::string& name) {
  for (const Word<LabTest>& w : kWords<LabTest>) {
    if (w.word == name) return w.value;
  }
  return LabTest::compression;
}

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

// A body that keeps its volume: σ = P λ, S = P/λ along the axis; in simple shear σ_xz = P_xz = τ, S_xz = τ − γ P_zz with
// P_zz = σ_zz = −p, and p = μ in neo-Hooke's law at σ_zz = 0 … here F is all held: σ_zz = −μ γ²/3 by the deviator alone.
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

Tissue relaxing() {
  Tissue tissue = neo_hooke();
  tissue.hyperelastic = NeoHookean{kMu, 1e7};
  tissue.maxwell = {{0.4, 2.0}, {0.3, 30.0}};
  return tissue;
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

// Creep answers relaxation: the stress of a ramp and hold, given as the load, gives the ramp and hold.
TEST(Laboratory, CreepIsTheInverseOfRelaxation) {
  Curve held = test_of(LabTest::relaxation, Deforming::tension, Measured::nominal, {});
  for (int i = 0; i <= 400; ++i) {
    held.time.push_back(0.1 * i);
    held.displacement.push_back(0.2 * std::min(1.0, held.time.back() / 10.0));
  }
  held.force.assign(held.size(), 0.0);
  Curve loaded = held;
  loaded.measurement.test = LabTest::creep;
  loaded.measurement.measured = Measured::strain;
  loaded.displacement = answer(relaxing(), held);
  const std::vector<double> strain = answer(relaxing(), loaded);
  for (std::size_t i = 0; i < held.size(); ++i) EXPECT_NEAR(strain[i], held.displacement[i], 2e-5) << held.time[i];
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

std::string table(const std::vector<std::string>& names, const std::vector<std::vector<double>>& columns) {
  std::ostringstream out;
  out.precision(12);
  for (std::size_t c = 0; c < names.size(); ++c) out << (c ? "," : "") << names[c];
  out << '\n';
  for (std::size_t i = 0; i < columns[0].size(); ++i) {
    for (std::size_t c = 0; c < columns.size(); ++c) out << (c ? "," : "") << columns[c][i];
    out << '\n';
  }
  return out.str();
}

SpecimenSize point_size() { return {.area = 1.0, .height = 1.0, .radius = {}, .point = true}; }

class Written : public testing::Test {
 protected:
  /// The curve of a [[data]] with the file `t.csv`.
  Curve load(const std::string& keys, const std::string& text, const std::string& specimen = "kind = \"point\"") {
    folder_.write("t.csv", text);
    const FitSpec spec = parse_fit("[specimen]\n" + specimen + "\n[[data]]\nfiles = [\"t.csv\"]\n" + keys,
                                   (folder_.path() / "fit.toml").string());
    SpecimenSize size = point_size();
    if (specimen != "kind = \"point\"") size = {.area = 1e-4, .height = 0.01, .radius = 0.005};
    return load_curves(spec.data.front(), size, folder_.path()).front().curve;
  }
  std::string fault(const std::string& keys, const std::string& text,
                    const std::string& specimen = "kind = \"point\"") {
    try {
      load(keys, text, specimen);
    } catch (const SceneError& error) {
      return error.what();
    }
    return "no fault";
  }
  Folder folder_{"laboratory"};
};

const std::vector<double> kStretches{1.0, 1.02, 1.05, 1.1, 1.15, 1.2, 1.3};

std::vector<double> mapped(const std::vector<double>& x, double (*f)(double)) {
  std::vector<double> y;
  for (const double v : x) y.push_back(f(v));
  return y;
}

// Stretch, engineering, logarithmic and Green's strain of one test are one curve.
TEST_F(Written, StrainsOfEveryKindAreTheSame) {
  const std::vector<double> kilopascals = mapped(kStretches, [](double x) { return 2.0 * (x - 1.0); });
  const std::vector<std::pair<std::string, double (*)(double)>> kinds{
      {"stretch", [](double x) { return x; }},
      {"strain", [](double x) { return x - 1.0; }},
      {"true_strain", [](double x) { return std::log(x); }},
      {"green_strain", [](double x) { return 0.5 * (x * x - 1.0); }}};
  for (const auto& [name, f] : kinds) {
    const Curve c =
        load("test = \"tension\"\ncolumns." + name + " = { name = \"x\" }\ncolumns.stress = { name = \"P\" }\n",
             table({"x", "P (kPa)"}, {mapped(kStretches, f), kilopascals}));
    ASSERT_EQ(c.size(), kStretches.size());
    EXPECT_FALSE(c.measurement.timed);
    EXPECT_EQ(c.measurement.deforming, Deforming::tension);
    for (std::size_t i = 0; i < c.size(); ++i) {
      EXPECT_NEAR(c.displacement[i], kStretches[i] - 1.0, 1e-11) << name;
      EXPECT_NEAR(c.force[i], 1e3 * kilopascals[i], 1e-8);
    }
  }
}

// Pressed: the strain is negative or not, the stress is, and the curve is positive; the account says what was turned.
TEST_F(Written, CompressionIsPositiveHoweverItIsWritten) {
  const std::vector<double> stretches = mapped(kStretches, [](double x) { return 2.0 - x; });
  const std::vector<double> negative = mapped(stretches, [](double x) { return 2.0 * (x - 1.0); });
  const Curve by_stretch =
      load("test = \"compression\"\ncolumns.stretch.name = \"x\"\ncolumns.cauchy_stress.name = \"s\"\n",
           table({"x", "s (kPa)"}, {stretches, negative}));
  const Curve by_log =
      load("test = \"compression\"\ncolumns.true_strain.name = \"x\"\ncolumns.cauchy_stress.name = \"s\"\n",
           table({"x", "s (kPa)"}, {mapped(stretches, [](double x) { return -std::log(x); }), negative}));
  EXPECT_EQ(by_stretch.measurement.measured, Measured::cauchy);
  for (std::size_t i = 0; i < by_stretch.size(); ++i) {
    EXPECT_NEAR(by_stretch.displacement[i], 1.0 - stretches[i], 1e-11);
    EXPECT_NEAR(by_log.displacement[i], 1.0 - stretches[i], 1e-11);
    EXPECT_NEAR(by_stretch.force[i], -1e3 * negative[i], 1e-8);
  }
}

// A hold is tension or compression as its stretch goes, and needs the time.
TEST_F(Written, AHoldTakesItsDirectionFromTheStretch) {
  const std::vector<double> time{0, 1, 2, 3, 10, 100}, up{1, 1.1, 1.2, 1.2, 1.2, 1.2}, stress{0, 1, 2, 1.5, 1.2, 1};
  const std::string keys = "test = \"relaxation\"\ncolumns.stretch.name = \"x\"\ncolumns.stress.name = \"P\"\n";
  const Curve pulled = load(keys, table({"time_s", "x", "P_kPa"}, {time, up, stress}));
  EXPECT_EQ(pulled.measurement.deforming, Deforming::tension);
  EXPECT_TRUE(pulled.measurement.timed);
  const Curve pressed =
      load(keys, table({"time_s", "x", "P_kPa"}, {time, mapped(up, [](double x) { return 2.0 - x; }), stress}));
  EXPECT_EQ(pressed.measurement.deforming, Deforming::compression);
  EXPECT_NEAR(pressed.displacement.back(), 0.2, 1e-12);
  EXPECT_THAT(fault(keys, table({"x", "P_kPa"}, {up, stress})), HasSubstr("columns.time: is not given"));
}

// Tests of other lengths lie side by side: rows that are empty in the columns of one are no rows of it.
TEST_F(Written, TestsLieSideBySide) {
  const std::string text =
      "a,b (kPa),g,t (kPa)\n1,0,0,0\n1.1,1,0.1,0.2\n1.2,2,0.2,0.4\n1.3,3,0.3,0.6\n1.4,4,0.4,0.8\n"
      ",,0.5,1\n,,0.6,1.2\n";
  const Curve a = load("test = \"tension\"\ncolumns.stretch.name = \"a\"\ncolumns.stress.name = \"b\"\n", text);
  const Curve g = load("test = \"simple_shear\"\ncolumns.shear.name = \"g\"\ncolumns.stress.name = \"t\"\n", text);
  EXPECT_EQ(a.size(), 5u);
  EXPECT_EQ(g.size(), 7u);
  EXPECT_NEAR(g.force.back(), 1200.0, 1e-9);
}

TEST_F(Written, WhatCannotBeIsSaid) {
  const std::vector<double> kilopascals = mapped(kStretches, [](double x) { return 2.0 * (x - 1.0); });
  const std::string good = table({"stretch", "stress (kPa)"}, {kStretches, kilopascals});
  EXPECT_EQ(fault("test = \"tension\"\n", good), "no fault");  // customary names are found
  EXPECT_THAT(
      fault("test = \"compression\"\n", good),
      AllOf(HasSubstr("t.csv:1:1: \"stretch\" goes to 1.3, which is tension"), HasSubstr("give test = \"tension\"")));
  EXPECT_THAT(fault("test = \"tension\"\ncolumns.shear.name = \"stretch\"\n", good),
              AllOf(HasSubstr("columns.shear: does not belong to test = \"tension\""), HasSubstr("columns.stretch")));
  EXPECT_THAT(
      fault("test = \"tension\"\ncolumns.force.name = \"stress\"\n", good),
      AllOf(HasSubstr("columns.force: needs the specimen's size, and a point has none"), HasSubstr("columns.stress")));
  EXPECT_THAT(
      fault("test = \"tension\"\ncolumns.strain.name = \"stretch\"\ncolumns.stretch.name = \"stretch\"\n", good),
      HasSubstr("contradicts `strain`"));
  EXPECT_THAT(
      fault("test = \"tension\"\n", table({"stretch", "stress (kPa)"}, {{1, 0.5, 0, -0.5, -1}, {0, 1, 2, 3, 4}})),
      AllOf(HasSubstr("t.csv:4:1: \"stretch\" is 0; a stretch is above 0")));
  EXPECT_THAT(fault("test = \"tension\"\n", table({"stretch", "stress"}, {kStretches, kilopascals})),
              HasSubstr("says no unit; give `unit` as one of kPa, Pa, MPa"));
  EXPECT_THAT(fault("test = \"tension\"\n", table({"stretch", "stress (MPa)"},
                                                  {kStretches, mapped(kilopascals, [](double x) { return 1e3 * x; })})),
              HasSubstr("soft tissues have 10 to 2e+07 Pa"));
  EXPECT_THAT(fault("test = \"tension\"\nmode = \"planar\"\n", good),
              HasSubstr("mode: belongs to relaxation, creep and cyclic"));
  EXPECT_THAT(fault("test = \"oscillation\"\ncolumns.storage_modulus.name = \"G\"\n",
                    table({"frequency (Hz)", "G (Pa)"}, {{1, 2, 3, 4, 5}, {100, 110, -120, 130, 140}})),
              HasSubstr("t.csv:4:1: \"G (Pa)\" is -120 Pa; a modulus of an oscillation is not below 0"));
  const std::string cylinder = "kind = \"cylinder\"\ndiameter_mm = 10\nheight_mm = 10";
  const std::string twisted =
      table({"angle (rad)", "torque (mN m)"}, {{0, 10, 20, 30, 40}, {0, 0.01, 0.02, 0.03, 0.04}});
  EXPECT_THAT(fault("test = \"torsion\"\n", twisted, cylinder),
              AllOf(HasSubstr("a shear of 20 at the surface"),
                    HasSubstr("columns.angle = { name = \"angle (rad)\", unit = \"deg\" }")));
  EXPECT_THAT(fault("test = \"torsion\"\n", twisted), HasSubstr("torsion asks for [specimen] kind = \"cylinder\""));
  EXPECT_THAT(fault("test = \"stretching\"\n", good), HasSubstr("\"tension\""));
}

// A tissue with a past under a test whose file has no times.
TEST(Laboratory, APastNeedsTimes) {
  Curve curve = test_of(LabTest::tension, Deforming::tension, Measured::nominal, {0.0, 0.1});
  curve.measurement.timed = false;
  const SpecimenModel model({curve}, {1.0, 1.0}, [](std::span<const double>) { return relaxing(); });
  EXPECT_THAT(model.predict(0, {}).failure, HasSubstr("give columns.time or speed_mm_s"));
}

TEST(Laboratory, AScenesToolMakesNoTension) {
  const std::string text = "scene = \"s.toml\"\n[[data]]\nfiles = [\"t.csv\"]\ntest = \"tension\"\n";
  try {
    parse_fit(text, "fit.toml");
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("fit.toml:4:8: data.0.test"), HasSubstr("asks for a [specimen]")));
  }
}

// One Ogden term fitted to the three tests together, each weighed by its largest stress: the optimum of least squares with an
// incompressible law has R² 0.926, 0.997 and 0.977 at α = −18.7.
TEST(Laboratory, CortexIsFittedInThreeTestsTogether) {
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

// Quasi-linear branches: the least squares of one Ogden term and two branches leave R² 0.73, 0.41 and 0.90 of three depths.
// Along the same ramp, 1 % of height a second to a stretch of 0.9, the specimens carry 0.163, 0.300 and 0.255 kPa.
TEST(Laboratory, ThreeDepthsOfMuscleShareNoQuasiLinearLaw) {
  FitSpec spec = load_fit(test::shipped("scenes/fit/muscle_hold.toml"));
  spec.proof.bootstrap = 0, spec.proof.profiles = false, spec.search.starts = 2;
  const FitResult r = run_fit(spec, {});
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

// Two terms of Ogden, α ≤ 60, reach 0.985 in each; and by name the law of one term comes before all others of one number or two.
TEST(Laboratory, CortexPrefersOgden) {
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
TEST_F(Written, ASweepAndACreepGiveTheBranch) {
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
  folder_.write("sweep.csv", table({"frequency (Hz)", "storage (Pa)", "loss (Pa)"}, {hertz, storage, loss}));
  folder_.write("creep.csv", table({"time (s)", "stress (Pa)", "shear_strain"}, {time, stress, strain}));
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
  const FitResult r = run_fit_text(text, (folder_.path() / "fit.toml").string());
  EXPECT_NEAR(r.parameters[0].value, 1000.0, 2.0);
  EXPECT_NEAR(r.parameters[1].value, 0.5, 0.002);
  EXPECT_NEAR(r.parameters[2].value, 3.0, 0.02);
  ASSERT_EQ(r.tests.size(), 3u);
  EXPECT_EQ(r.unit, "") << "moduli and strains have no unit in common";
  for (const TestResult& t : r.tests) EXPECT_GT(t.r2, 0.9999) << t.name;
}

// Of all laws of at most two terms one is above 0.95 in each of cortex's tests.
TEST(Laboratory, AFewTermsAreFoundForCortex) {
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
  EXPECT_GE(best, 0.95);
}

// 200 sets of the three tests by one tissue, 2 % of the largest stress as correlated noise: 95 % intervals hold the truth.
TEST(Laboratory, IntervalsOfTwinsHoldTheTruth) {
  const std::vector<Parameter> parameters{{"mu", "Pa", 10.0, 1e5, Scale::logarithmic, 1e3}, {"alpha", "", -60.0, -1.0}};
  const std::vector<double> truth{1400.0, -15.0};
  std::vector<double> strains;
  for (int i = 0; i < 40; ++i) strains.push_back(0.1 * i / 39.0);
  const TissueAt tissue = [](std::span<const double> v) {
    Tissue t;
    t.hyperelastic = Ogden{{v[0]}, {v[1]}, 1e6};
    return t;
  };
  std::vector<Curve> plans;
  for (const Form& form : kForms) {
    if (form.deforming == Deforming::equibiaxial || form.deforming == Deforming::planar) continue;
    plans.push_back(test_of(test_named(form.name), form.deforming, Measured::nominal, strains));
    plans.back().group = form.name;
  }
  const SpecimenModel model(plans, {1.0, 1.0}, tissue);
  constexpr int kSeeds = 200;
  double held[2] = {0.0, 0.0};
  for (int seed = 0; seed < kSeeds; ++seed) {
    testing_models::Noise noise(static_cast<std::uint64_t>(seed));
    std::vector<Curve> curves = plans;
    for (std::size_t c = 0; c < curves.size(); ++c) {
      const std::vector<double> exact = model.predict(c, truth).force, e = noise.correlated(curves[c].size(), 0.6);
      double most = 0.0;
      for (const double f : exact) most = std::max(most, std::abs(f));
      for (std::size_t i = 0; i < exact.size(); ++i) curves[c].force[i] = exact[i] + 0.02 * most * e[i];
    }
    const Problem problem(parameters, curves, {0, 1, 2}, spreads_of(curves, Weighing::automatic), model);
    const Optimum best = descend(problem, problem.to_scaled(std::vector{800.0, -8.0}));
    const Covariance c = covariance(problem, best.scaled);
    EXPECT_NE(c.noise.kind, NoiseKind::by_curve) << "three different tests are no three specimens";
    for (std::size_t p = 0; p < 2; ++p) held[p] += c.interval[p].holds(truth[p]) ? 1.0 / kSeeds : 0.0;
  }
  std::printf("mu %.3f alpha %.3f\n", held[0], held[1]);
  for (const double share : held) {
    EXPECT_GE(share, 0.90);
    EXPECT_LE(share, 0.99);
  }
}

// Four specimens for each of three tests, whose stiffness differs by 10 % from one to the next: 95 % intervals are of the mean of
// specimens.
TEST(Laboratory, IntervalsOfSeveralSpecimensAreOfTheirMean) {
  const std::vector<Parameter> parameters{{"mu", "Pa", 10.0, 1e5, Scale::logarithmic, 1e3}, {"alpha", "", -60.0, -1.0}};
  const std::vector<double> truth{1400.0, -15.0};
  std::vector<double> strains;
  for (int i = 0; i < 30; ++i) strains.push_back(0.1 * i / 29.0);
  const TissueAt tissue = [](std::span<const double> v) {
    Tissue t;
    t.hyperelastic = Ogden{{v[0]}, {v[1]}, 1e6};
    return t;
  };
  std::vector<Curve> plans;
  for (const Form& form : kForms) {
    if (form.deforming == Deforming::equibiaxial || form.deforming == Deforming::planar) continue;
    plans.push_back(test_of(test_named(form.name), form.deforming, Measured::nominal, strains));
    plans.back().group = form.name;
  }
  const SpecimenModel model(plans, {1.0, 1.0}, tissue);
  constexpr int kSeeds = 200, kSpecimens = 4;
  double held[2] = {0.0, 0.0}, width = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    testing_models::Noise noise(static_cast<std::uint64_t>(1000 + seed));
    std::vector<Curve> curves;
    std::vector<std::size_t> indices;
    for (std::size_t c = 0; c < plans.size(); ++c) {
      const std::vector<double> exact = model.predict(c, truth).force;
      for (int k = 0; k < kSpecimens; ++k) {
        const double own = 1.0 + 0.1 * noise();
        const std::vector<double> e = noise.correlated(exact.size(), 0.6);
        curves.push_back(plans[c]);
        indices.push_back(c);
        for (std::size_t i = 0; i < exact.size(); ++i)
          curves.back().force[i] = own * exact[i] + 0.01 * std::abs(exact.back()) * e[i];
      }
    }
    const Problem problem(parameters, curves, indices, spreads_of(curves, Weighing::automatic), model);
    const Optimum best = descend(problem, problem.to_scaled(std::vector{800.0, -8.0}));
    const Covariance c = covariance(problem, best.scaled);
    EXPECT_EQ(c.noise.kind, NoiseKind::by_curve);
    for (std::size_t p = 0; p < 2; ++p) held[p] += c.interval[p].holds(truth[p]) ? 1.0 / kSeeds : 0.0;
    width += (c.interval[0].high - c.interval[0].low) / truth[0] / kSeeds;
  }
  std::printf("mu %.3f alpha %.3f, mean width of mu %.3f\n", held[0], held[1], width);
  for (const double share : held) {
    EXPECT_GE(share, 0.90);
    EXPECT_LE(share, 0.98);
  }
}

}  // namespace
}  // namespace glisson::fit::laboratory_test
