// Long steps of a run: they end at corners of motions, at frames and at the run's end, and samples lie on the line between their ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scene/scene_text.h"

namespace glisson::long_steps_test {
namespace {

struct Seen : RunObserver {
  std::vector<Sample> samples;
  std::vector<double> frames;
  std::vector<RunEvent> events;
  void on_sample(const Sample& s) override { samples.push_back(s); }
  void on_frame(const Simulation& s) override { frames.push_back(s.time()); }
  void on_event(const RunEvent& e) override { events.push_back(e); }
};

RunSummary run(const Variant& variant, Seen& seen) {
  const std::atomic<bool> stop{false};
  return run_variant(variant, {}, seen, stop);
}

Variant quick(const std::string& integrator, const std::string& more = "") {
  return test::parse(R"([mesh]
kind = "box"
cells = [4, 4, 4]
size_m = [0.02, 0.02, 0.02]
[tissue]
youngs_modulus_Pa = 3000
poisson_ratio = 0.3
[[fixed]]
set = "z_min"
[[tool]]
set = "z_max"
velocity_mm_s = 100
depth_mm = 3
returns = true
[motion]
integrator = ")" + integrator +
                     "\"\n" + more)
      .variants.at(0);
}

double peak_of(const Seen& seen) {
  double most = 0.0;
  for (const Sample& s : seen.samples) most = std::max(most, std::abs(s.instruments[0].force.z));
  return most;
}

// A press of 3 mm and back within 60 ms: its peak is k d = 0.1997 N at 30 ms, whatever the step may grow to, and the force is a
// straight line on either side, since the body is linear and in equilibrium; the run ends at its end, with frames at their times.
TEST(LongSteps, HaveThePeakOfAQuickPress) {
  Seen seen;
  const RunSummary s = run(quick("quasi_static", "[output]\nframes = 4\n"), seen);
  EXPECT_NEAR(s.peak_force_N, 0.1997, 2e-4);
  EXPECT_NEAR(peak_of(seen), 0.1997, 2e-4);
  EXPECT_EQ(s.time_s, 0.06);
  ASSERT_EQ(seen.samples.size(), 31u) << "500 a second";
  for (std::size_t i = 0; i < seen.samples.size(); ++i) {
    const double time = 0.002 * static_cast<double>(i), depth = 0.1 * std::min(time, 0.06 - time);
    EXPECT_NEAR(seen.samples[i].time, time, 1e-12);
    EXPECT_NEAR(seen.samples[i].instruments[0].depth, depth, 1e-12);
    EXPECT_NEAR(-seen.samples[i].instruments[0].force.z, 0.1997 * depth / 0.003, 2e-4) << time;
    EXPECT_NEAR(seen.samples[i].supports[0].total().z, -seen.samples[i].instruments[0].force.z, 1e-7);
  }
  ASSERT_EQ(seen.frames.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(seen.frames[i], 0.02 * static_cast<double>(i), 1e-12);
}

// The same under `implicit`, whose inertia adds less than a tenth here.
TEST(LongSteps, OfTheImplicitIntegratorHaveThePeakToo) {
  Seen seen;
  const RunSummary s = run(quick("implicit", "[motion.implicit]\nlargest_step_s = 0.05\n[output]\nframes = 0\n"), seen);
  EXPECT_NEAR(s.peak_force_N, 0.1997, 0.02);
  EXPECT_EQ(s.time_s, 0.06);
}

// A twist to 60° that takes 0.54 of the largest step more than whole steps ends at 60°.
TEST(LongSteps, EndATwistAtItsAngle) {
  const std::string text = R"([mesh]
kind = "box"
cells = [2, 2, 4]
size_m = [0.01, 0.01, 0.02]
[tissue]
kinematics = "corotational"
[motion]
integrator = "quasi_static"
[[fixed]]
set = "z_min"
[[tool]]
set = "z_max"
[tool.rotation]
axis = [0, 0, 1]
center_m = [0.005, 0.005, 0]
angle_deg = 60
rate_deg_s = 180
[output]
frames = 0
)";
  for (const char* largest : {"0.3", "0.05", "0.21"}) {
    Seen seen;
    const RunSummary s =
        run(test::parse(text + "[motion.implicit]\nlargest_step_s = " + largest + "\n").variants.at(0), seen);
    EXPECT_NEAR(s.time_s, 1.0 / 3.0, 1e-12);
    const auto columns = build_variant(test::parse(text).variants.at(0), {}).instruments[0]->columns();
    const auto angle =
        std::ranges::find(columns, std::string_view("angle_deg"), &InstrumentColumn::name) - columns.begin();
    EXPECT_NEAR(seen.samples.back().instruments[0].values.at(static_cast<std::size_t>(angle)), 60.0, 1e-9) << largest;
  }
}

// Loads with a course of times: the largest force is that of the largest factor, which no sum of steps from 0 comes to.
TEST(LongSteps, HaveTheLargestLoad) {
  const std::string text = R"([mesh]
kind = "box"
cells = [2, 2, 2]
size_m = [0.02, 0.02, 0.02]
[motion]
integrator = "quasi_static"
duration_s = 0.2
[[fixed]]
set = "z_min"
[[load]]
set = "z_max"
force_N = [0, 0, 0.1]
times_s = [0, 0.073, 0.2]
factors = [0, 1, 0]
[output]
frames = 0
sample_rate_hz = 1000
)";
  Seen seen;
  run(test::parse(text).variants.at(0), seen);
  double most = 0.0;
  for (const Sample& s : seen.samples) most = std::max(most, -s.supports[0].total().z);
  EXPECT_NEAR(most, 0.1, 1e-7);
}

}  // namespace
}  // namespace glisson::long_steps_test
