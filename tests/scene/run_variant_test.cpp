// run_variant_test.cpp — a scene runs to its end, and what it shows on the way is of the instants it promises.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scene/scene_text.h"

namespace glisson::run_variant_test {
namespace {

using test::kSmallScene;
using test::parse;
using ::testing::HasSubstr;

/// Keeps everything a run shows.
struct Recorder : RunObserver {
  int starts = 0, ends = 0;
  std::vector<Sample> samples;
  std::vector<double> frames;
  std::vector<double> progress;
  std::function<void(const Simulation&)> at_frame;

  void on_start(const Variant&, const Simulation& s) override {
    ++starts;
    EXPECT_EQ(s.steps(), 0u);
  }
  void on_sample(const Sample& s) override { samples.push_back(s); }
  void on_frame(const Simulation& s) override {
    frames.push_back(s.time());
    if (at_frame) at_frame(s);
  }
  void on_progress(double fraction) override { progress.push_back(fraction); }
  void on_end(const RunSummary&) override { ++ends; }
};

const std::atomic<bool> kGoOn{false};

RunSummary run(const std::string& more, Recorder& seen, const std::atomic<bool>& stop = kGoOn) {
  return run_variant(parse(kSmallScene + more).variants.at(0), {}, seen, stop);
}

// The press of 1 mm at 10 mm/s lasts 0.1 s, ends there to half a step, and its summary adds up.
TEST(RunVariant, EndsWithTheMotion) {
  Recorder seen;
  const RunSummary s = run("", seen);
  EXPECT_EQ(s.end, RunSummary::End::finished);
  EXPECT_NEAR(s.time_s, 0.1, 0.5 * s.step_s);
  EXPECT_EQ(s.vertices, 27u);
  EXPECT_EQ(s.tets, 48u);
  EXPECT_EQ(s.steps, static_cast<std::uint64_t>(std::round(0.1 / s.step_s)));
  EXPECT_NEAR(s.step_s / s.stable_step_s, 0.9, 1e-9) << "step auto";
  EXPECT_GT(s.ns_per_tet_step, 0.0);
  EXPECT_GE(s.wall_s, s.ns_per_tet_step * 1e-9 * 48 * static_cast<double>(s.steps) * 0.999)
      << "stepping is part of the run";
  EXPECT_LT(std::abs(s.energies.imbalance()), 1e-9 * s.energies.work_tools);
  EXPECT_EQ(s.first_inversion_s, -1.0);
  EXPECT_NE(s.state_hash, 0u);
  EXPECT_EQ(seen.starts, 1);
  EXPECT_EQ(seen.ends, 1);
}

// Samples lie within half a step of the multiples of 1/rate, and the last is of the last step.
TEST(RunVariant, SamplesAtTheChosenRate) {
  Recorder seen;
  const RunSummary s = run("[motion]\nstep_s = 1.7e-4\n[output]\nsample_rate_hz = 200\n", seen);
  ASSERT_EQ(seen.samples.size(), 21u) << "0, 5, … 95 ms and the end";
  for (std::size_t i = 0; i + 1 < seen.samples.size(); ++i) {
    EXPECT_NEAR(seen.samples[i].time, 0.005 * static_cast<double>(i), 0.5 * s.step_s * (1 + 1e-9)) << i;
  }
  EXPECT_NEAR(seen.samples.back().time, s.time_s - s.step_s, 1e-12);
}

/// Times of the samples that a run has to take: of the first step whose forces are at most half of that step before one is due.
std::vector<double> sample_times(const Variant& variant, std::uint64_t steps) {
  BuiltVariant built = build_variant(variant, {});
  Simulation& simulation = built.simulation;
  const double rate = variant.output.sample_rate;
  std::vector<double> times;
  double last = 0.0;
  for (std::uint64_t k = 0, due = 0; k < steps; ++k) {
    EXPECT_TRUE(simulation.step().made());
    last = simulation.force_time();
    const double middle = last + 0.5 * simulation.step_size();
    if (!(static_cast<double>(due) / rate < middle)) continue;
    times.push_back(last);
    due = std::max(due + 1, static_cast<std::uint64_t>(std::ceil(middle * rate)));
  }
  if (times.back() != last) times.push_back(last);
  return times;
}

// Where steps become shorter and longer, as under a needle that goes in and out: steps say which is sampled, not the clock.
TEST(RunVariant, SamplesTheNearestStepWhateverItsLength) {
  for (int rate = 300; rate < 700; rate += 4) {
    const std::string text =
        "[mesh]\nkind = \"cylinder\"\nradius_m = 0.02\nheight_m = 0.03\nradial_cells = 3\naxial_cells = 4\n"
        "[tissue]\nhyperelastic = { kind = \"ogden\", mu_Pa = [1724], alpha = [4], bulk_modulus_Pa = 16667 }\n"
        "[[fixed]]\nset = \"bottom\"\n[[instrument]]\nkind = \"needle\"\ndiameter_mm = 1.27\ntip_m = [0, 0, 0.0301]\n"
        "rupture.force_N = 0.2\nmotion = { kind = \"press\", depth_mm = 8, velocity_mm_s = 200, returns = true }\n"
        "[output]\nsample_rate_hz = " +
        std::to_string(rate) + "\n";
    const Variant variant = parse(text).variants.at(0);
    Recorder seen;
    const RunSummary summary = run_variant(variant, {}, seen, kGoOn);
    std::vector<double> times;
    for (const Sample& s : seen.samples) times.push_back(s.time);
    EXPECT_EQ(times, sample_times(variant, summary.steps)) << rate << " Hz";
  }
}

// A rate above that of the steps gives every step once.
TEST(RunVariant, NeverSamplesAStepTwice) {
  Recorder seen;
  const RunSummary s = run("[output]\nsample_rate_hz = 1e7\n", seen);
  ASSERT_EQ(seen.samples.size(), s.steps);
  for (std::size_t i = 1; i < seen.samples.size(); ++i) EXPECT_GT(seen.samples[i].time, seen.samples[i - 1].time);
}

constexpr std::size_t kElastic = 5;  // of a tool's columns: elastic_N

// Depth, force and energies of a sample are of one instant: the elastic force of an elastic press starts at zero with
// the depth, and the tool's force along its direction pushes.
TEST(RunVariant, SamplesOneInstant) {
  Recorder seen;
  const RunSummary s = run("[output]\nsample_rate_hz = 1000\n", seen);
  const Sample& first = seen.samples.front();
  EXPECT_EQ(first.time, 0.0);
  EXPECT_EQ(first.instruments.at(0).depth, 0.0);
  EXPECT_EQ(first.instruments.at(0).values.at(kElastic), 0.0);
  double peak = 0.0;
  for (const Sample& x : seen.samples) {
    EXPECT_NEAR(x.instruments.at(0).depth, 0.01 * x.time, 1e-15);
    peak = std::max(peak, std::abs(x.instruments[0].force.z));
  }
  EXPECT_GT(seen.samples.back().instruments[0].values.at(kElastic), 0.0) << "downwards, into the tissue";
  EXPECT_GT(seen.samples.back().supports.at(0).elastic.z, 0.0) << "the support pushes back";
  EXPECT_EQ(s.peak_force_N, peak);
  EXPECT_GT(peak, 0.0);
}

// Frames are evenly spaced to half a step, from rest to the end, as many as asked for.
TEST(RunVariant, TakesFramesEvenly) {
  for (const int count : {0, 1, 2, 11}) {
    Recorder seen;
    const RunSummary s = run("[output]\nframes = " + std::to_string(count) + "\n", seen);
    ASSERT_EQ(seen.frames.size(), static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      const double wanted = count == 1 ? s.time_s : 0.1 * i / (count - 1);
      EXPECT_NEAR(seen.frames[static_cast<std::size_t>(i)], wanted, 0.51 * s.step_s) << i << " of " << count;
    }
  }
}

// More frames than steps: each state once.
TEST(RunVariant, TakesNoFrameTwice) {
  Recorder seen;
  const RunSummary s = run("[motion]\nmax_steps = 5\n[output]\nframes = 100\n", seen);
  EXPECT_EQ(s.steps, 5u);
  EXPECT_EQ(seen.frames.size(), 6u) << "rest and five steps";
}

// max_steps ends a run after exactly that many steps, with or without a duration.
TEST(RunVariant, StopsAfterMaxSteps) {
  Recorder seen;
  EXPECT_EQ(run("[motion]\nmax_steps = 100\nduration_s = 1000\n", seen).steps, 100u);
  EXPECT_EQ(seen.frames.size(), 60u);
  const Variant v = parse("[mesh]\nkind = \"box\"\ncells = [1, 1, 2]\n[motion]\nmax_steps = 3\n").variants.at(0);
  EXPECT_TRUE(std::isinf(run_duration(v)));
  Recorder alone;
  const RunSummary s = run_variant(v, {}, alone, kGoOn);
  EXPECT_EQ(s.steps, 3u);
  EXPECT_EQ(s.end, RunSummary::End::finished);
}

// A duration beyond the motion holds the tool where it is; one before it cuts the press short.
TEST(RunVariant, LastsAsLongAsAsked) {
  Recorder longer, shorter;
  EXPECT_NEAR(run("[motion]\nduration_s = 0.15\n", longer).time_s, 0.15, 1e-3);
  EXPECT_EQ(longer.samples.back().instruments.at(0).depth, 0.001);
  EXPECT_NEAR(run("[motion]\nduration_s = 0.05\n", shorter).time_s, 0.05, 1e-3);
}

// A run that is told to stop before it begins makes no step; one told on the way ends there with what it has.
TEST(RunVariant, StopsWhenTold) {
  Recorder none, some;
  const std::atomic<bool> at_once{true};
  const RunSummary nothing = run("", none, at_once);
  EXPECT_EQ(nothing.end, RunSummary::End::interrupted);
  EXPECT_EQ(nothing.steps, 0u);
  EXPECT_TRUE(none.samples.empty());
  EXPECT_EQ(none.ends, 1);

  std::atomic<bool> stop{false};
  some.at_frame = [&](const Simulation& s) { stop = s.time() > 0.05; };
  const RunSummary half = run("", some, stop);
  EXPECT_EQ(half.end, RunSummary::End::interrupted);
  EXPECT_GT(half.time_s, 0.05);
  EXPECT_LT(half.time_s, 0.06);
  EXPECT_NEAR(some.samples.back().time, half.time_s - half.step_s, 1e-12) << "the last step is kept";
}

// Watching changes nothing: runs that are sampled and framed differently end in the same bytes.
TEST(RunVariant, IsNotChangedByWatching) {
  Recorder a, b;
  const RunSummary rare = run("[output]\nsample_rate_hz = 1\nframes = 0\n", a);
  const RunSummary dense = run("[output]\nsample_rate_hz = 1e6\nframes = 1000\n", b);
  EXPECT_EQ(rare.state_hash, dense.state_hash);
  EXPECT_EQ(rare.steps, dense.steps);
}

// Pressed through its own support a body turns inside out: the run goes on and counts, or stops there, as the scene says.
TEST(RunVariant, GoesOnOrStopsAtInversion) {
  const std::vector<Override> through{{"tool.0.depth_mm", "40"}, {"tool.0.velocity_mm_s", "100"}};
  Recorder seen, stopped;
  const Variant v = parse(kSmallScene, through).variants.at(0);
  const RunSummary all = run_variant(v, {}, seen, kGoOn);
  EXPECT_NE(all.end, RunSummary::End::stopped_inverted);
  EXPECT_GT(all.inverted_tets_most, 0u);
  EXPECT_GT(all.first_inversion_s, 0.0);
  Variant careful = v;
  careful.on_inversion = OnInversion::stop;
  const RunSummary s = run_variant(careful, {}, stopped, kGoOn);
  EXPECT_EQ(s.end, RunSummary::End::stopped_inverted);
  EXPECT_EQ(s.first_inversion_s, all.first_inversion_s);
  EXPECT_NEAR(s.time_s, s.first_inversion_s + s.step_s, 1e-9) << "the step that met it was made, and no other";
}

// A given step that the stiffening tissue outgrows ends the run as unstable, and keeps what was sampled.
TEST(RunVariant, StopsWhenTheTissueOutgrowsTheStep) {
  Recorder at_rest, seen;
  const double h = run("[motion]\nmax_steps = 1\n", at_rest).stable_step_s;
  const RunSummary s = run(
      "[tissue.law]\nkind = \"linear\"\nslope_Pa = 1e6\n[motion]\nstep_s = " + std::to_string(0.95 * h) + "\n", seen);
  EXPECT_EQ(s.end, RunSummary::End::stopped_unstable);
  EXPECT_GT(s.steps, 0u);
  EXPECT_LT(s.time_s, 0.1);
  EXPECT_FALSE(seen.samples.empty());
  for (const Sample& x : seen.samples) EXPECT_TRUE(std::isfinite(x.instruments.at(0).force.z)) << x.time;
}

// A load ramps up and the body comes to carry it: in the end the support pushes back with the load.
TEST(RunVariant, AppliesLoads) {
  Recorder seen;
  const Variant v =
      parse(
          "[mesh]\nkind = \"box\"\ncells = [2, 2, 2]\nsize_m = [0.02, 0.02, 0.02]\n[[fixed]]\nset = \"z_min\"\n"
          "[[load]]\nset = \"z_max\"\nforce_N = [0, 0, -0.01]\nramp_s = 0.2\n"
          "[motion]\nduration_s = 1\ndamping_rate_per_s = 60\n")
          .variants.at(0);
  const RunSummary s = run_variant(v, {}, seen, kGoOn);
  EXPECT_EQ(s.peak_force_N, 0.0) << "no tool";
  EXPECT_NEAR(seen.samples.front().supports.at(0).total().z, 0.0, 1e-12);
  const Sample& half =
      *std::find_if(seen.samples.begin(), seen.samples.end(), [](const Sample& x) { return x.time >= 0.1; });
  // Half of the load, less what the slow start has not yet passed on; a sudden load would show all of it by now.
  EXPECT_NEAR(half.supports.at(0).total().z, 0.005, 0.002);
  EXPECT_NEAR(seen.samples.back().supports.at(0).total().z, 0.01, 1e-6) << "statics, oscillations decayed by e^-24";
}

/// What a scene is told when it is built.
std::string refusal(const std::string& more) {
  Recorder seen;
  try {
    run(more, seen);
  } catch (const SceneError& error) {
    EXPECT_EQ(seen.starts, 0) << "refused before the run starts";
    return error.what();
  }
  return {};
}

// What only the built body can refuse names the scene's line: a step above h*, a vertex held twice.
TEST(RunVariant, RefusesBeforeTheFirstStep) {
  EXPECT_THAT(refusal("[motion]\nstep_s = 1\n"), HasSubstr("s.toml: step = 1 s is above the stable step"));
  EXPECT_THAT(refusal("[[variant]]\nname = \"coarse\"\nmotion.step_s = 1\n"),
              HasSubstr("s.toml: variant coarse: step = 1 s"));
  EXPECT_THAT(refusal("[[fixed]]\nset = \"x_min\"\n"),
              HasSubstr("s.toml:12:1: tool.0: component x of vertex 18 belongs to [[tool]] \"press\" and to [[fixed]] "
                        "\"x_min\", at rest"));
}

// With `sideways = "free"` only the pressed component is driven: the tissue slides under the tool.
TEST(RunVariant, CanPressWithoutFriction) {
  Recorder stuck, sliding;
  double moved = -1.0;
  sliding.at_frame = [&](const Simulation& s) {
    moved = std::abs(s.displacement()[s.mesh().vertex_sets.at("top").front()].x);
  };
  const RunSummary a = run("", stuck);
  const RunSummary b = run("sideways = \"free\"\n", sliding);
  EXPECT_GT(moved, 1e-6);
  EXPECT_LT(b.peak_force_N, a.peak_force_N) << "confinement stiffens";
}

}  // namespace
}  // namespace glisson::run_variant_test
