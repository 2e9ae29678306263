// friction_fit_test.cpp — fits of specimens between plates with friction: files to verdict, and the silicone phantoms to
// 65 % strain, where a homogeneous specimen no longer does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "fit/forward/barrel_model.h"
#include "fit/run_fit.h"
#include "phantom.h"

namespace glisson::fit::friction_fit_test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kSpecimen = R"(
[specimen]
kind = "cylinder"
diameter_mm = 50
height_mm = 30
)";
constexpr const char* kTissue = R"(
[tissue]
hyperelastic = { kind = "neo_hookean", mu_Pa = 1000, bulk_modulus_Pa = 1e6 }
[search]
starts = 6
[proof]
profiles = false
bootstrap = 0
next = false
[[parameter]]
key = "tissue.hyperelastic.mu_Pa"
low = 100
high = 1e4
)";
constexpr const char* kFriction = R"(
[[parameter]]
key = "specimen.friction"
low = 0
high = 0.5
scale = "linear"
)";

std::string data(const std::string& file) { return "[[data]]\nfiles = [\"" + file + "\"]\n"; }

/// μ and the grip that a fit of made.csv finds.
FitResult fit_of(const std::string& key, double high, lab::Grip grip) {
  Curve curve;
  curve.name = "made";
  for (int i = 0; i < 60; ++i) {
    curve.time.push_back(i);
    curve.displacement.push_back(3e-4 * i);
  }
  curve.force.assign(curve.size(), 0.0);
  Tissue tissue;
  tissue.hyperelastic = NeoHookean{2000, 1e6};
  const BarrelModel model({curve}, {0.025, 0.03, lab::Faces::friction, grip},
                          [&](std::span<const double>) { return tissue; });
  const Prediction made = model.predict(0, {});
  EXPECT_EQ(made.failure, "");
  std::string rows = "Time (s),Compression (mm),Load (N)\n";
  for (std::size_t i = 0; i < curve.size(); ++i) {
    char row[96];
    std::snprintf(row, sizeof row, "%.1f,%.6f,%.9f\n", curve.time[i], 1e3 * curve.displacement[i], made.force[i]);
    rows += row;
  }
  const phantom::Folder folder;
  folder.write("made.csv", rows);
  FitRun run;
  run.data_folder = folder.path();
  const std::string parameter =
      "[[parameter]]\nkey = \"" + key + "\"\nlow = 0\nhigh = " + std::to_string(high) + "\nscale = \"linear\"\n";
  return run_fit(
      parse_fit(std::string(kSpecimen) + "faces = \"friction\"\n" + kTissue + parameter + data("made.csv"), "F"), run);
}

// Curves made with friction 0.15, and with adhesion of 300 Pa, and μ = 2000 Pa give them back, each within 1 %: the shape of
// the curve tells them apart.
TEST(FrictionFit, FindsGripAndModulus) {  // long
  const FitResult rubs = fit_of("specimen.friction", 0.5, {.friction = 0.15});
  ASSERT_EQ(rubs.parameters.size(), 2u);
  EXPECT_NEAR(rubs.parameters[0].value, 2000.0, 20.0);
  EXPECT_NEAR(rubs.parameters[1].value, 0.15, 0.0015);
  EXPECT_THAT(rubs.forward, HasSubstr("a cylinder that bulges"));
  EXPECT_THAT(rubs.tissue, HasSubstr("#   specimen.friction = "));  // no key of the tissue
  const FitResult clings = fit_of("specimen.adhesion_Pa", 2000, {.adhesion = 300});
  ASSERT_EQ(clings.parameters.size(), 2u);
  EXPECT_NEAR(clings.parameters[0].value, 2000.0, 20.0);
  EXPECT_NEAR(clings.parameters[1].value, 300.0, 3.0);
}

std::string fault(const std::string& text) {
  try {
    parse_fit(text, "F");
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

// What says friction twice, or not at all, is told when the file is read.
TEST(FrictionFit, RefusesWhatContradictsItself) {
  const std::string rubs = std::string(kSpecimen) + "faces = \"friction\"\n";
  EXPECT_EQ(fault(rubs + "friction = 0.1\n" + kTissue + data("a.csv")), "");
  EXPECT_EQ(fault(rubs + "adhesion_Pa = 100\n" + kTissue + data("a.csv")), "");
  EXPECT_EQ(fault(rubs + kTissue + kFriction + data("a.csv")), "");
  EXPECT_THAT(fault(rubs + kTissue + data("a.csv")), HasSubstr("needs `friction` or `adhesion_Pa`"));
  EXPECT_THAT(fault(kSpecimen + std::string(kTissue) + kFriction + data("a.csv")), HasSubstr("faces = \"friction\""));
  EXPECT_THAT(fault(rubs + "friction = -1\n" + kTissue + data("a.csv")), HasSubstr("friction: -1"));
  EXPECT_THAT(fault(rubs + "friction = 0.1\n" + kTissue + "[forward]\nkind = \"uniaxial\"\n" + data("a.csv")),
              HasSubstr("applies to smooth faces"));
}

double at(const Curve& c, double displacement) {
  std::size_t i = 1;
  while (i + 1 < c.size() && c.displacement[i] < displacement) ++i;
  const double share = (displacement - c.displacement[i - 1]) / (c.displacement[i] - c.displacement[i - 1]);
  return c.force[i - 1] + share * (c.force[i] - c.force[i - 1]);
}

/// The held-out error of a fit, and the best that the repetitions allow: that of the mean of the fitted curves, as far as
/// all of them reach [N].
struct HeldOut {
  double error = 0.0, best = 0.0;
};
HeldOut held_out(const FitResult& result) {
  HeldOut squares;
  double reach = 1.0, fitted = 0.0, count = 0.0;
  for (const CurveResult& c : result.curves) {
    if (!c.curve.held_out) reach = std::min(reach, c.curve.displacement.back()), ++fitted;
  }
  for (const CurveResult& test : result.curves) {
    for (std::size_t i = 0; test.curve.held_out && i < test.curve.size(); ++i) {
      if (test.curve.displacement[i] > reach) continue;
      double mean = 0.0;
      for (const CurveResult& c : result.curves) {
        if (!c.curve.held_out) mean += at(c.curve, test.curve.displacement[i]) / fitted;
      }
      squares.best += std::pow(test.curve.force[i] - mean, 2);
      squares.error += std::pow(test.curve.force[i] - test.fitted[i], 2), ++count;
    }
  }
  return {std::sqrt(squares.error / count), std::sqrt(squares.best / count)};
}

/// The shipped fit with friction, or with smooth faces in its place, of a mix and with two of its five curves held out.
HeldOut fit_phantoms(lab::Faces faces, const std::string& mix, int first, int second) {
  FitSpec spec = load_fit(test::shipped("scenes/fit/phantom_friction.toml"));
  spec.specimen->faces = faces;
  if (faces == lab::Faces::smooth) spec.parameters.pop_back();
  for (DataSpec& d : spec.data) d.files.clear();
  for (int i = 1; i <= 5; ++i)
    spec.data[i == first || i == second ? 1 : 0].files.push_back("EF10_" + mix + "_A" + std::to_string(i) + ".csv");
  spec.proof.profiles = spec.proof.next = false;
  spec.proof.bootstrap = 0;
  FitRun run;
  run.data_folder = phantom::kPhantoms;
  return held_out(run_fit(spec, run));
}

// To 65 % strain, held-out curves are met within 1.3 times the best that the repetitions allow.
TEST(FrictionFit, MeetsHeldOutPhantomsTo65Percent) {  // long
  if (!phantom::have_phantoms()) GTEST_SKIP() << phantom::kPhantoms << " is not there";
  for (const char* mix : {"100T", "75T"}) {
    const HeldOut h = fit_phantoms(lab::Faces::friction, mix, 4, 5);
    EXPECT_LT(h.error, 1.3 * h.best) << mix;
  }
}

// The same over all ten splits of both mixes, together and one by one. In one split of EF10 75T the curves held out by chance
// lie within 0.02 kPa of the mean of the others, where the law's own misfit shows: 0.06 kPa of a stress of 40.
TEST(FrictionFitLong, MeetsEveryHeldOutPairOfPhantomsTo65Percent) {  // verify
  if (!phantom::have_phantoms()) GTEST_SKIP() << phantom::kPhantoms << " is not there";
  const double kPa = 1e3 * std::numbers::pi * 0.025 * 0.025;  // in newtons
  for (const char* mix : {"100T", "75T"}) {
    double errors = 0.0, bests = 0.0, smooth_errors = 0.0;
    for (int a = 1; a <= 5; ++a) {
      for (int b = a + 1; b <= 5; ++b) {
        const HeldOut h = fit_phantoms(lab::Faces::friction, mix, a, b),
                      smooth = fit_phantoms(lab::Faces::smooth, mix, a, b);
        std::printf("%s, A%d and A%d held out: best %.3f kPa, times it: smooth %.2f, clinging %.2f\n", mix, a, b,
                    h.best / kPa, smooth.error / smooth.best, h.error / h.best);
        errors += h.error * h.error, bests += h.best * h.best, smooth_errors += smooth.error * smooth.error;
        if (h.best < 0.02 * kPa)
          EXPECT_LT(std::sqrt(h.error * h.error - h.best * h.best), 0.07 * kPa) << mix << a << b;
        else
          EXPECT_LT(h.error, 1.3 * h.best) << mix << a << b;
      }
    }
    std::printf("%s, all: smooth %.2f, clinging %.2f\n", mix, std::sqrt(smooth_errors / bests),
                std::sqrt(errors / bests));
    EXPECT_LT(errors, 1.3 * 1.3 * bests) << mix;
    EXPECT_LT(errors, smooth_errors) << mix;
  }
}

}  // namespace
}  // namespace glisson::fit::friction_fit_test
