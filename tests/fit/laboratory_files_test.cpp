// Files of a laboratory: the same test written with other columns is the same curve, and what cannot be is said.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fit/data/load_curves.h"
#include "fit/laws/fit_curves.h"
#include "fit/spec/fit_spec.h"
#include "laboratory.h"
#include "phantom.h"

namespace glisson::fit::laboratory_files_test {
namespace {

using namespace laboratory;
using phantom::Folder;
using testing::AllOf;
using testing::HasSubstr;

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
  Folder folder_;
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
  EXPECT_THAT(fault("test = \"torsion\"\n", twisted), HasSubstr("torsion needs [specimen] kind = \"cylinder\""));
  EXPECT_THAT(fault("test = \"creep\"\nmode = \"torsion\"\n", twisted, cylinder),
              HasSubstr("driven by its angle; give test = \"torsion\""));
  EXPECT_THAT(fault("test = \"stretching\"\n", good), HasSubstr("\"tension\""));
}

// Tests of one fit are of one tissue: a thousandfold in one of three, each of which alone could be a tissue's, is named with its file.
TEST_F(Written, AUnitThatOnlyTheOtherTestsBetrayIsNamed) {
  folder_.write("p.csv", table({"stretch", "stress (kPa)"},
                               {kStretches, mapped(kStretches, [](double x) { return 2.0 * (x - 1.0); })}));
  folder_.write("s.csv", table({"gamma", "stress (Pa)"}, {{0, 0.05, 0.1, 0.15, 0.2}, {0, 30, 60, 90, 120}}));
  folder_.write("t.csv", table({"gamma", "stress (kPa)"}, {{0, 0.05, 0.1, 0.15, 0.2}, {0, 30, 60, 90, 120}}));
  const auto read = [&](const std::string& more) -> std::string {
    std::string text = "[specimen]\nkind = \"point\"\n[[data]]\nfiles = [\"p.csv\"]\ntest = \"tension\"\n";
    for (const char* file : {"s.csv", "t.csv"})
      text += std::string("[[data]]\nfiles = [\"") + file + "\"]\ntest = \"simple_shear\"\n";
    try {
      read_curves(parse_fit(text + more, (folder_.path() / "fit.toml").string()), point_size(), folder_.path());
    } catch (const SceneError& error) {
      return error.what();
    }
    return "no fault";
  };
  EXPECT_THAT(read(""), AllOf(HasSubstr("t.csv:1:1: \"t\" shows a modulus of 1.8e+06 Pa"), HasSubstr("Check the units"),
                              HasSubstr("unlikely = true")));
  EXPECT_EQ(read("unlikely = true\n"), "no fault");
}

// Before a description is checked, as a fuzzer reads it.
TEST_F(Written, ATorsionHasNoColumnsOfAPoint) {
  DataSpec spec;
  spec.test = LabTest::torsion;
  spec.files = {folder_.write("t.csv", "angle (rad),torque (N m)\n0,0\n1,1\n2,2\n3,3\n4,4\n")};
  try {
    load_curves(spec, point_size(), folder_.path());
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_THAT(error.what(), HasSubstr("test = \"torsion\" needs the specimen's size"));
  }
}

TEST(Laboratory, AScenesToolMakesNoTension) {
  const std::string text = "scene = \"s.toml\"\n[[data]]\nfiles = [\"t.csv\"]\ntest = \"tension\"\n";
  try {
    parse_fit(text, "fit.toml");
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("fit.toml:4:8: data.0.test"), HasSubstr("needs a [specimen]")));
  }
}

}  // namespace
}  // namespace glisson::fit::laboratory_files_test
