// The liver that comes with the project, pressed, pierced, cut and felt: no file is needed, and what happens is what its scenes say.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "support/places.h"
#include "support/scene_runs.h"

namespace glisson {
namespace {

/// Of one probe, with every sample.
class ProbedRecorder final : public RunObserver {
 public:
  explicit ProbedRecorder(std::string column) : name_(std::move(column)) {}
  void on_built(const BuiltVariant& built) override {
    const auto& columns = built.probes.columns();
    at_ = static_cast<std::size_t>(std::find(columns.begin(), columns.end(), name_) - columns.begin());
    ASSERT_LT(at_, columns.size()) << name_;
  }
  void on_sample(const Sample& s) override {
    value.push_back(s.probes[at_]);
    time.push_back(s.time);
    if (s.instruments.empty()) return;
    depth.push_back(s.instruments.front().depth);
    force.push_back(s.instruments.front().force.y);
  }
  void on_event(const RunEvent& event) override { events.push_back(event.what.event); }

  std::vector<double> value, time, depth, force;  ///< force along y, the direction of both scenes
  std::vector<std::string> events;

 private:
  std::string name_;
  std::size_t at_ = 0;
};

// Lying on its back the liver settles by some millimetres; a fingertip 15 mm deep meets some newtons; energies balance.
TEST(ShapesLiver, IsPressed) {
  const Scene scene = test::shipped_scene("organs/liver.toml", {{"mesh.edge_mm", "13"}});
  ProbedRecorder run("tumour_displacement_y_m");
  const std::atomic<bool> stop{false};
  const RunSummary summary = run_variant(scene.variants.front(), {}, run, stop);
  EXPECT_EQ(summary.end, RunSummary::End::finished);
  EXPECT_NEAR(run.depth.back(), 0.025, 1e-4);
  const auto before =
      static_cast<std::size_t>(std::lower_bound(run.time.begin(), run.time.end(), 0.95) - run.time.begin());
  EXPECT_GT(run.value.at(before), 0.002) << "sagged by its weight [m]";
  EXPECT_LT(run.value.at(before), 0.010);
  EXPECT_EQ(run.force.at(before), 0.0) << "the finger does not touch yet";
  EXPECT_GT(run.force.back(), 0.5) << "15 mm deep [N]";
  EXPECT_LT(run.force.back(), 5.0);
  EXPECT_GT(run.value.back(), run.value.at(before)) << "the tumour goes with it";
  const Energies& e = summary.energies;
  EXPECT_LE(std::abs(e.imbalance()), 1e-6 * (std::abs(e.work_tools) + std::abs(e.work_loads)));
}

// The needle punctures the surface and then the tumour, which it pushes away before it by more than 2 mm and which comes
// back by a part of that once it is pierced.
TEST(ShapesLiver, MovesItsTumourAwayFromTheNeedle) {  // long
  const Scene scene = test::shipped_scene("organs/liver_needle.toml", {{"mesh.edge_mm", "10"}});
  ProbedRecorder recorder("target_displacement_y_m");
  const std::atomic<bool> stop{false};
  const RunSummary summary = run_variant(scene.variants.front(), {}, recorder, stop);
  EXPECT_EQ(summary.end, RunSummary::End::finished);
  const auto most = std::max_element(recorder.value.begin() + static_cast<std::ptrdiff_t>(recorder.value.size() / 2),
                                     recorder.value.end());
  EXPECT_GT(*most, 0.002);
  for (const char* event : {"puncture", "inner puncture"}) {
    EXPECT_EQ(std::count(recorder.events.begin(), recorder.events.end(), event), 1) << event;
  }
}

// The blade meets toughness times the length of its edge, and the retractors open what it has cut.
TEST(ShapesLiver, IsOpenedByABlade) {
  const Scene scene = test::shipped_scene("organs/liver_cut.toml", {{"mesh.edge_mm", "13"}});
  ProbedRecorder run("left_side_displacement_x_m");
  const std::atomic<bool> stop{false};
  const RunSummary summary = run_variant(scene.variants.front(), {}, run, stop);
  EXPECT_EQ(summary.end, RunSummary::End::finished);
  const auto cut = static_cast<std::size_t>(std::lower_bound(run.time.begin(), run.time.end(), 0.5) - run.time.begin());
  EXPECT_GT(run.value.back(), run.value.at(cut) + 0.004) << "beyond what the pull alone does [m]";
  EXPECT_NEAR(*std::max_element(run.force.begin(), run.force.end()), 20.0 * 0.064, 0.02) << "[N]";
}

// With gallbladder and supports it sags toward where it lies, on its front as far as on its back: without a capsule all is linear. The
// capsule takes a part of the sag.
TEST(ShapesLiver, SagsAsItsPostureHasIt) {
  const Scene scene =
      test::shipped_scene("organs/liver_postures.toml", {{"mesh.edge_mm", "17"}, {"output.frames", "0"}});
  const auto right_lobe = [&](const char* posture, const char* axis, std::optional<Vec3d> gravity = {}) {
    const auto found =
        std::find_if(scene.variants.begin(), scene.variants.end(), [&](const Variant& v) { return v.name == posture; });
    EXPECT_NE(found, scene.variants.end()) << posture;
    Variant variant = *found;
    if (gravity) variant.simulation.gravity = *gravity;
    ProbedRecorder run(std::string("right_lobe_displacement_") + axis + "_m");
    const std::atomic<bool> stop{false};
    EXPECT_EQ(run_variant(variant, {}, run, stop).end, RunSummary::End::finished);
    return run.value.back();
  };
  const double bare = right_lobe("supine_without_capsule", "y"), supine = right_lobe("supine", "y");
  EXPECT_GT(supine, 0.003) << "[m]";
  EXPECT_GT(bare, 1.05 * supine);
  EXPECT_NEAR(right_lobe("supine_without_capsule", "y", Vec3d{0, -9.81, 0}), -bare, 1e-4 * bare);
  EXPECT_GT(right_lobe("supine_without_capsule", "x", Vec3d{9.81, 0, 0}), 0.003) << "on the left side";
}

// Above the tumour the finger meets more force than beside it, and more than in sound tissue.
TEST(ShapesLiver, LetsItsTumourBeFelt) {
  const Scene scene = test::shipped_scene("organs/palpation.toml", {{"mesh.edge_mm", "12"},
                                                                    {"instrument.0.motion.columns", "2"},
                                                                    {"instrument.0.motion.rows", "1"},
                                                                    {"instrument.0.motion.spacing_mm", "28"},
                                                                    {"instrument.0.tip_m", "[-0.049, -0.09, 0.008]"},
                                                                    {"output.frames", "0"}});
  ASSERT_EQ(scene.variants.size(), 2u);
  std::array<double, 2> beside{}, above{};  // largest forces of the first press, 28 mm aside, and of the second
  for (std::size_t v = 0; v < 2; ++v) {
    Variant variant = scene.variants[v];
    variant.probes.push_back({.options = {.name = "tumour", .where = ProbeRegion{"tumour"}}, .tip = "", .origin = ""});
    ProbedRecorder run("tumour_displacement_y_m");
    const std::atomic<bool> stop{false};
    EXPECT_EQ(run_variant(variant, {}, run, stop).end, RunSummary::End::finished);
    for (std::size_t i = 0; i < run.force.size(); ++i) {
      double& most = run.time[i] < 0.5 * run.time.back() ? beside[v] : above[v];
      most = std::max(most, run.force[i]);
    }
  }
  EXPECT_GT(above[1], 1.25 * above[0]) << "[N]";
  EXPECT_GT(above[1], 1.2 * beside[1]) << "[N]";
  EXPECT_LT(beside[1], 1.15 * beside[0]) << "[N]";
}

}  // namespace
}  // namespace glisson
