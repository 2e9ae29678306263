// baseline_test.cpp — a curve's zero: a baseline with a slope is told from tissue, contact on it is placed where it is or refused, and all
// curves of a test are decided together.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "fit/data/contact.h"
#include "fit/data/load_curves.h"
#include "fit/run_fit.h"
#include "laboratory.h"
#include "phantom.h"

namespace glisson::fit::baseline_test {
namespace {

using laboratory::table;
using ::testing::HasSubstr;

constexpr double kWay = 1.4e-3;  // [m]

/// Rows of a press over `kWay`: a force of peak 1 from the touch on, noise, and a slope as part of the peak.
struct Press {
  std::vector<double> x, f;
};
Press pressed(
    double touch, double slope, double noise, unsigned seed, std::size_t rows = 700,
    const std::function<double(double)>& force = [](double u) { return std::pow(u, 1.5); }) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, noise);
  Press p;
  for (std::size_t i = 0; i < rows; ++i) {
    const double x = kWay * static_cast<double>(i) / static_cast<double>(rows - 1);
    p.x.push_back(x);
    p.f.push_back(force(std::max(0.0, x - touch) / (kWay - touch)) + slope * x / kWay + normal(random));
  }
  return p;
}

// Ten tables of a ball, F ∝ u^1.5, on baselines that go by -20 to 20 % of the peak over the way: contact is within 0.03 mm of where it
// is, or refused; with 0.3 % of noise it is not refused more than once. The slope is within four of its standard deviations, and as many
// of what a ball's blunt start bends it by: a hundredth of the peak.
TEST(Baseline, ContactIsFoundOnASlope) {
  int placed = 0;
  for (int k = 0; k < 10; ++k) {
    const double slope = -0.2 + 0.4 * k / 9.0, touch = (0.4 + 0.07 * k) * 1e-3;
    const Press p = pressed(touch, slope, 0.003, static_cast<unsigned>(k));
    const auto contact = find_contact(p.x, p.f, 4.0);
    if (!contact || !contact->doubt.empty()) continue;
    ++placed;
    std::printf("slope %+.3f: %+.4f mm\n", slope, 1e3 * (contact->at - touch));
    EXPECT_NEAR(contact->at, touch, 0.03e-3) << slope;
    EXPECT_GE(contact->at, p.x.front());
    EXPECT_GE(contact->before, 10U);
    EXPECT_NEAR(contact->slope * kWay, slope, 4.0 * contact->slope_deviation * kWay + 0.01) << slope;
    EXPECT_NEAR(contact->rest_force, slope * contact->at / kWay, 0.005) << slope;
  }
  EXPECT_GE(placed, 9);
}

// What is refused or found does not depend on luck: of 60 tables of other noise, 0.1 and 0.3 %, none is placed wrong by more than
// 0.03 mm, and at most a fifth is refused.
TEST(Baseline, ContactIsFoundOrRefusedOverManySeeds) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  int refused = 0;
  double worst = 0.0;
  for (unsigned k = 0; k < 60; ++k) {
    const double touch = (0.3 + 0.8 * part(random)) * 1e-3, slope = -0.2 + 0.4 * part(random);
    const Press p = pressed(touch, slope, k % 2 == 0 ? 0.001 : 0.003, 100 + k);
    const auto contact = find_contact(p.x, p.f, 4.0);
    if (!contact || !contact->doubt.empty()) {
      ++refused;
      continue;
    }
    worst = std::max(worst, std::abs(contact->at - touch));
    EXPECT_NEAR(contact->at, touch, 0.03e-3) << slope << " at " << touch;
  }
  std::printf("%d of 60 refused, worst %.4f mm\n", refused, 1e3 * worst);
  EXPECT_LE(refused, 12);
}

// A tissue in contact from the first row on has a straight toe that looks like a slope; nothing is taken off its force, and it is carried
// back to zero as before. Silicone in compression: σ = a ε + b ε⁴, a tenth of the peak by the straight part.
TEST(Baseline, AStraightToeIsTissue) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Press p = pressed(0.0, 0.0, 1e-4, seed, 700, [](double u) { return 0.12 * u + 0.88 * std::pow(u, 4); });
    const auto contact = find_contact(p.x, p.f, 4.0);
    ASSERT_TRUE(contact);
    EXPECT_EQ(contact->doubt, "");
    EXPECT_FALSE(contact->sloped);
    EXPECT_EQ(contact->rest_force, 0.0);
    EXPECT_NEAR(contact->at, 0.0, 0.01 * kWay);
  }
}

// Where the force falls and then rises so slowly that no bend shows, or leads back to far before the file, the place of contact is refused
// with a reason; a threshold does not turn rows that rise into a rest.
TEST(Baseline, WhatRowsDoNotTellIsRefused) {
  const Press blunt = pressed(0.5e-3, 0.1, 0.01, 5, 150, [](double u) { return u * u; });
  const auto contact = find_contact(blunt.x, blunt.f, 4.0);
  ASSERT_TRUE(contact);
  EXPECT_THAT(contact->doubt, HasSubstr("baseline"));
  const Press toe = pressed(0.0, 0.0, 1e-4, 3, 700, [](double u) { return 0.12 * u + 0.88 * std::pow(u, 4); });
  for (const double threshold : {4.0, 20.0, 60.0}) {
    const auto found = find_contact(toe.x, toe.f, threshold);
    if (!found || !found->doubt.empty()) continue;
    EXPECT_EQ(found->rest_force, 0.0) << threshold;
  }
}

std::string as_file(const Press& p, double newtons) {
  std::vector<double> time, depth, force;
  for (std::size_t i = 0; i < p.x.size(); ++i)
    time.push_back(20.0 * p.x[i] * 1e3), depth.push_back(1e3 * p.x[i]), force.push_back(1e3 * newtons * p.f[i]);
  return table({"time (s)", "indentation (mm)", "force (mN)"}, {time, depth, force});
}

DataSpec ball(std::vector<std::filesystem::path> files, ContactKind kind = ContactKind::detect) {
  DataSpec spec;
  spec.files = std::move(files);
  spec.test = LabTest::indentation;
  spec.indenter = Indenter{.shape = IndenterShape::sphere, .radius = 3e-3};
  spec.contact.kind = kind;
  return spec;
}

// A pull-off larger than the push turns no sign: the sign is that of the loading. Adhesion is not in the model of an indenter, so that the
// way out is refused, and the way in alone is placed as without it.
TEST(Baseline, APullOffTurnsNoSign) {
  const Press in = pressed(1e-3, 0.0, 0.003, 1);
  std::string rows = "indentation (mm),force (mN)\n";
  const auto add = [&](double x, double f) { rows += std::to_string(1e3 * x) + "," + std::to_string(2.3 * f) + "\n"; };
  for (std::size_t i = 0; i < in.x.size(); ++i) add(in.x[i], in.f[i]);
  for (std::size_t i = in.x.size() - 1; i-- > 0;) {
    const double u = in.x[i] - 0.8e-3;
    add(in.x[i], u > 0.0 && u < 0.3e-3 ? -1.4 * std::sin(std::numbers::pi * u / 0.3e-3) : in.f[i]);
  }
  const phantom::Folder folder;
  folder.write("sticky.csv", rows);
  DataSpec spec = ball({"sticky.csv"});
  spec.speed = 0.05e-3;
  EXPECT_THAT(phantom::complaint(spec, {}, folder.path()),
              testing::AllOf(HasSubstr("adhesion is not in the model"), HasSubstr("part = \"loading\"")));
  spec.cycle.part = CyclePart::loading;
  const PreparedCurve curve = load_curves(spec, {}, folder.path()).front();
  EXPECT_TRUE(curve.account.turned.empty());
  EXPECT_NEAR(curve.account.contact, 1e-3, 0.03e-3);
  EXPECT_GT(curve.curve.force.back(), 0.9 * 2.3e-3);
}

// The slope goes off the whole force, and the account says both; given the place, the line through the rows before it does.
TEST(Baseline, IsTakenOffAndTold) {
  const phantom::Folder folder;
  folder.write("tilted.csv", as_file(pressed(1e-3, 0.1, 0.003, 2), 2.3e-3));
  for (const ContactKind kind : {ContactKind::detect, ContactKind::given}) {
    DataSpec spec = ball({"tilted.csv"}, kind);
    spec.contact.at = 1e-3;
    const PreparedCurve c = load_curves(spec, {}, folder.path()).front();
    EXPECT_TRUE(c.account.sloped);
    // the peak is 2.3 mN above the baseline: 0.3 % of noise over √7 rows a point, and the slope's own error over 0.4 mm
    EXPECT_NEAR(c.curve.force.back(),
                2.3e-3 * std::pow((c.curve.displacement.back() + c.account.contact - 1e-3) / 0.4e-3, 1.5),
                0.01 * 2.3e-3);
    EXPECT_THAT(c.account.text(), HasSubstr("with the baseline's slope of "));
  }
}

// All files of a test stand on one decision, fitted or held out: beside a file with a slope one that begins in contact is refused.
TEST(Baseline, OneDecisionForAllTablesOfATest) {
  const phantom::Folder folder;
  folder.write("tilted.csv", as_file(pressed(1e-3, 0.1, 0.003, 2), 2.3e-3));
  folder.write("flat.csv", as_file(pressed(0.9e-3, 0.0, 0.003, 3), 2.3e-3));
  folder.write("in_contact.csv",
               as_file(pressed(0.0, 0.0, 0.0003, 4, 700, [](double u) { return 0.6 * u + 0.4 * u * u; }), 2.3e-3));
  DataSpec fitted = ball({"tilted.csv"}), held_out = ball({"flat.csv"});
  held_out.held_out = true;
  EXPECT_TRUE(of_one_test(fitted, held_out));
  EXPECT_FALSE(load_curves(held_out, {}, folder.path()).front().account.sloped);
  const auto together = TestFiles(std::vector{fitted, held_out}, {}, folder.path()).curves();
  ASSERT_EQ(together.size(), 2U);
  EXPECT_TRUE(together[0].front().account.sloped && together[1].front().account.sloped);
  EXPECT_NEAR(together[1].front().account.contact, 0.9e-3, 0.03e-3);
  held_out.files = {"in_contact.csv"};
  EXPECT_EQ(load_curves(held_out, {}, folder.path()).front().account.contact_how, "extrapolated");
  try {
    TestFiles(std::vector{fitted, held_out}, {}, folder.path()).curves();
    ADD_FAILURE() << "not refused";
  } catch (const SceneError& error) {
    EXPECT_THAT(error.what(), HasSubstr("other curves of this test have a baseline with a slope"));
    EXPECT_THAT(error.what(), HasSubstr("at_mm"));
  }
  held_out.indenter->radius = 2e-3;
  EXPECT_FALSE(of_one_test(fitted, held_out));
}

const char* const kFit = R"([specimen]
kind = "layer"
[tissue]
hyperelastic = { kind = "neo_hookean", mu_Pa = 2000, bulk_modulus_Pa = 1e6 }
[[parameter]]
key = "tissue.hyperelastic.mu_Pa"
low = 50
high = 1e5
[[data]]
files = ["t.csv"]
test = "indentation"
indenter = { kind = "sphere", radius_mm = 3 }
contact = { kind = "detect" }
[search]
starts = 1
[proof]
profiles = false
bootstrap = 0
next = false
)";

ParameterResult modulus_of(const Press& p) {
  const phantom::Folder folder;
  folder.write("t.csv", as_file(p, 2.3e-3));
  folder.write("fit.toml", kFit);
  return run_fit(load_fit(folder.path() / "fit.toml"), {}).parameters.front();
}

// A slope changes nothing of the modulus: with the same noise it is that of the flat file, within its interval and what the touch's own
// standard deviation makes of it in both files, 1.5 δ/d of F ∝ d^1.5. Without the slope it was 12 times too small.
TEST(Baseline, TheModulusIsThatOfTheFlatFile) {  // long
  const Press level = pressed(1e-3, 0.0, 0.003, 6);
  const ParameterResult flat = modulus_of(level);
  ASSERT_TRUE(flat.ci95());
  const double touch = find_contact(level.x, level.f, 4.0)->deviation,
               half = 0.5 * (flat.ci95()->high - flat.ci95()->low) + 1.5 * std::sqrt(2.0) * touch / 0.4e-3 * flat.value;
  for (const double slope : {-0.2, 0.1}) {
    const ParameterResult tilted = modulus_of(pressed(1e-3, slope, 0.003, 6));
    std::printf("slope %+.2f: %.4g Pa, flat %.4g [%.4g, %.4g], with the touch ± %.2g\n", slope, tilted.value,
                flat.value, flat.ci95()->low, flat.ci95()->high, half);
    EXPECT_NEAR(tilted.value, flat.value, half);
  }
}

// Five tests of a phantom split into a fitted and a held-out table, contact "auto": one decision, and the error that it leaves is that
// of all five as one table.
TEST(Baseline, AutoDecidesForFittedAndHeldOutTogether) {
  if (!phantom::have_phantoms()) GTEST_SKIP() << "the phantom files are not beside the sources";
  FitSpec spec = load_fit(test::shipped("scenes/fit/phantom_ef10_100t.toml"));
  spec.search.starts = 2;
  spec.proof = {.profiles = false, .bootstrap = 0, .next = false, .displacement = {}};
  FitRun options;
  options.data_folder = phantom::kPhantoms;
  const FitResult detected = run_fit(spec, options);
  for (DataSpec& d : spec.data) d.contact.kind = ContactKind::automatic;
  for (int held = 1; held <= 5; ++held) {
    for (DataSpec& d : spec.data) d.files.clear();
    for (int i = 1; i <= 5; ++i)
      spec.data[i == held ? 1 : 0].files.emplace_back("EF10_100T_A" + std::to_string(i) + ".csv");
    const FitResult result = run_fit(spec, options);
    for (const std::string& account : result.accounts) EXPECT_THAT(account, HasSubstr("contact extrapolated ("));
    std::printf("A%d held out: %.3g N\n", held, *result.rms_heldout);
  }
  EXPECT_TRUE(detected.rms_heldout);
}

}  // namespace
}  // namespace glisson::fit::baseline_test
