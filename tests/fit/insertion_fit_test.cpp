// A fit of [insertion] finds the inner membranes that a needle's curve was made with, says what it cannot tell, and names what it
// cannot use; on the published curve of bovine liver the shipped scene stays within its bar.
#include "fit/insertion/measured_insertion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "../support/scene_runs.h"
#include "fit/insertion/baseline.h"
#include "fit/insertion/insertion_run.h"
#include "fit/run_fit.h"
#include "fit/spec/fit_spec.h"
#include "glisson/fit.h"
#include "phantom.h"

namespace glisson::fit::insertion_fit_test {
namespace {

using phantom::Folder;
using ::testing::HasSubstr;

const std::string kScene = R"([mesh]
kind = "cylinder"
radius_m = 0.02
height_m = 0.03
radial_cells = 3
axial_cells = 6
grading = 2
[tissue]
youngs_modulus_Pa = 5000
poisson_ratio = 0.45
[motion]
damping_rate_per_s = 20
[[fixed]]
set = "bottom"
axes = "z"
[[fixed]]
set = "wall"
axes = "xy"
[[instrument]]
kind = "needle"
name = "needle"
tip_m = [0, 0, 0.0305]
zone_mm = 4
rupture.force_N = 0.4
tip.cutting_N = 0.1
friction = { static_in_N_m = 12, dynamic_in_N_m = 10 }
motion = { kind = "press", depth_mm = 22, velocity_mm_s = 10 }
[output]
sample_rate_hz = 1000
frames = 0
)";
const std::string kFit = R"(scene = "scene.toml"
[insertion]
start_mm = 3
drop_N = 0.1
piece_mm = 20
runs = 8
[[data]]
files = ["curve.csv"]
columns.displacement = { name = "position_mm", unit = "mm" }
columns.force = { name = "force_N", unit = "N" }
)";
const TipProfile kTruth{
    0.1, {{.depth = 4e-3, .puncture = 0.5, .cutting = {}}, {.depth = 8e-3, .puncture = 0.7, .cutting = 0.15}}};

InsertionSpec from_three() {
  InsertionSpec spec;
  spec.start = 3e-3;
  return spec;
}

std::string curve_text(const InsertionRun& run) {
  std::ostringstream text;
  text << "position_mm,force_N\n";
  for (std::size_t i = 0; i < run.curve.position.size(); i += 2)
    text << 1e3 * run.curve.position[i] << "," << run.curve.force[i] << "\n";
  return text.str();
}

// Depths within 0.2 mm, a step of the grid, and forces within 3 %, from a curve that the scene itself made; a scene reads
// the text that comes out.
TEST(InsertionFit, FindsTheMembranesOfItsOwnCurve) {
  const Folder folder;
  const std::filesystem::path scene = folder.write("scene.toml", kScene);
  const std::atomic<bool> never{false};
  const InsertionScene insertion(load_scene(scene).variants.front(), from_three(), {});
  folder.write("curve.csv", curve_text(insertion.run(kTruth, never).value()));
  const FitResult result = run_fit(folder.write("fit.toml", kFit));
  EXPECT_LT(result.rms_fit, 0.02);
  const auto value = [&](const std::string& name) {
    for (const ParameterResult& p : result.parameters) {
      if (p.parameter.name == name) return p.value;
    }
    return std::nan("");
  };
  EXPECT_NEAR(value("membrane 1, depth"), 4.0, 0.2);
  EXPECT_NEAR(value("membrane 1, force"), 0.5, 0.03 * 0.5);
  EXPECT_NEAR(value("membrane 2, depth"), 8.0, 0.2);
  EXPECT_NEAR(value("membrane 2, force"), 0.7, 0.03 * 0.7);
  EXPECT_NEAR(value("cutting force from membrane 2"), 0.15, 0.01);
  EXPECT_EQ(result.result_file, "membranes.toml");
  std::string text = kScene;
  const std::string own = "tip.cutting_N = 0.1\n";
  text.replace(text.find(own), own.size(), result.tissue);
  const Scene with = parse_scene(text, "s.toml", {});
  const auto& needle = std::get<NeedleOptions>(with.variants.front().instruments.front().what);
  EXPECT_NEAR(needle.membranes.at(0).depth, 4e-3, 2e-4);
}

// A search that is stopped keeps the nearest run so far and says that it is not complete; before the second run there is nothing to keep.
TEST(InsertionFit, KeepsWhatIsKnownWhenItIsStopped) {
  const Folder folder;
  const std::filesystem::path scene = folder.write("scene.toml", kScene);
  const std::atomic<bool> never{false};
  const InsertionScene insertion(load_scene(scene).variants.front(), from_three(), {});
  folder.write("curve.csv", curve_text(insertion.run(kTruth, never).value()));
  std::atomic<bool> stop{true};
  FitRun options;
  options.stop = &stop;
  const std::filesystem::path fit = folder.write("fit.toml", kFit);
  EXPECT_THROW(run_fit(fit, options), std::runtime_error);
  const auto stopped_after = [&](std::size_t runs) {
    stop = false;
    options.progress = [&stop, runs](const FitProgress& p) { stop = p.done == runs; };
    return run_fit(fit, options);
  };
  EXPECT_THROW(stopped_after(1), std::runtime_error);  // without membranes
  const FitResult two = stopped_after(2), four = stopped_after(4);
  EXPECT_FALSE(two.complete);
  EXPECT_FALSE(two.parameters.empty());
  EXPECT_LT(four.rms_fit, 0.5 * two.rms_fit);
}

// A drop is a fall by the stated force within the stated way; it begins at the highest point, in whatever order the points come.
TEST(InsertionFit, FindsDropsByTheStatedRule) {
  const Folder folder;
  const auto file =
      folder.write("curve.csv",
                   "position_mm,force_N\n0,0\n9,1\n10,1.5\n10,1.0\n10,0.4\n10.2,0.3\n9.9,1.4\n12,0.9\n12.1,0.8\n"
                   "15,1.2\n15.3,0.9\n16,1.3\n17,0.9\n18,1.0\n");
  DataSpec data;
  data.columns.displacement = {.given = true, .name = "position_mm", .number = {}, .unit = "mm", .origin = {}};
  data.columns.force = {.given = true, .name = "force_N", .number = {}, .unit = "N", .origin = {}};
  const MeasuredInsertion measured = read_insertion(file, data, {});
  ASSERT_EQ(measured.drops.size(), 2U);  // 0.1 N at 12 mm is too little, 0.4 N from 16 to 17 mm too slow
  EXPECT_DOUBLE_EQ(measured.drops[0].position, 0.01);
  EXPECT_DOUBLE_EQ(measured.drops[0].force, 1.5);
  EXPECT_DOUBLE_EQ(measured.drops[0].least, 0.3);
  EXPECT_DOUBLE_EQ(measured.drops[1].position, 0.015);
  for (const double x : measured.grid({}, 1.0)) {
    EXPECT_GT(std::abs(x - 0.01), 3e-4);
    EXPECT_GT(std::abs(x - 0.015), 3e-4);
  }
  EXPECT_EQ(measured.grid({}, 1.0).size(), 91U - 2U * 3U);  // 0 to 18 mm every 0.2 mm, three of them near each drop
}

// Each baseline leaves nothing of points of its own kind, and something of the other's.
TEST(InsertionFit, BaselinesAreLeastSquares) {
  std::vector<double> x, grows, bends;
  for (int i = 0; i < 20; ++i) {
    x.push_back(9.65 + 0.5 * i);
    grows.push_back(-0.1 + 0.02 * std::exp(0.4 * 0.5 * i));
    bends.push_back(0.1 + 0.03 * i + 0.002 * i * i);
  }
  EXPECT_LT(baseline_of(x, grows).exponential, 2e-3 * 0.8);  // rates are tried in steps of 2 %
  EXPECT_GT(baseline_of(x, grows).parabola, 0.01);
  EXPECT_LT(baseline_of(x, bends).parabola, 1e-12);
}

// What a fit of membranes cannot use is named.
TEST(InsertionFit, MistakesAreNamed) {
  const auto complaint = [](const std::string& text) -> std::string {
    try {
      parse_fit(text, "f.toml");
    } catch (const SceneError& e) {
      return e.what();
    }
    return "nothing";
  };
  EXPECT_THAT(complaint(kFit + "[[parameter]]\nkey = \"tissue.youngs_modulus_Pa\"\nlow = 1\nhigh = 2\n"),
              HasSubstr("[insertion] fits membranes alone"));
  EXPECT_THAT(complaint(kFit + "[[data]]\nfiles = [\"b.csv\"]\n"), HasSubstr("[insertion] needs one curve"));
  const Folder folder;
  folder.write("scene.toml", kScene);
  folder.write("curve.csv", "position_mm,force_N\n0,0\n1,1\n2,2\n3,3\n4,4\n");
  try {
    run_fit(folder.write("fit.toml", kFit));
    FAIL();
  } catch (const SceneError& e) {
    EXPECT_THAT(e.what(), HasSubstr("the force nowhere falls by drop_N = 0.1 N within 0.5 mm"));
  }
}

}  // namespace
}  // namespace glisson::fit::insertion_fit_test
