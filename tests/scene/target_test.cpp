// The distance of a tip to a place of the body, and its parts along and across: exact in a linear field, and for a tool on its
// way through air to tissue at rest the way that is left.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "glisson/simulation/probe.h"
#include "scene/scene_text.h"
#include "support/bodies.h"

namespace glisson {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

double value(Probes& probes, const Simulation& simulation, const std::string& column) {
  const auto at = std::find(probes.columns().begin(), probes.columns().end(), column) - probes.columns().begin();
  return probes.read(simulation).at(static_cast<std::size_t>(at));
}

// u = H x takes a material point x to x + H x, and the middle of a region or a face c to c + H c: from a tip at p that points along
// d the distance, (x − p)·d and what is left across are known to rounding. The tip is asked anew with every reading.
TEST(Target, DistancesAreExactInALinearField) {
  std::mt19937 random(7);
  const TetMesh mesh = test::jittered_box({3, 3, 3}, 0.01, 0.25, random);
  Simulation simulation(mesh, {{0, Tissue{}}}, test::in_double());
  const Mat3d H{{{{0.01, 0.004, -0.002}, {0.004, -0.02, 0.003}, {-0.002, 0.003, 0.015}}}};
  std::vector<Vec3d> u, v(mesh.vertices.size());
  for (const Vec3d& x : mesh.vertices) u.push_back(H * x);
  simulation.set_state(u, v);
  ProbeTip tip{{0.004, 0.02, 0.05}, unit(Vec3d{0.2, -0.1, -1.0})};
  const auto of_tip = [&tip] { return tip; };
  const Vec3d point{0.011, 0.0142, 0.0207};
  Probes probes(simulation, {{"p", ProbePoint{point}, of_tip},
                             {"r", ProbeRegion{"0"}, of_tip},
                             {"f", ProbeSet{"z_max"}, of_tip},
                             {"plain", ProbePoint{point}}});
  const std::vector<std::pair<std::string, Vec3d>> places{
      {"p", point}, {"r", {0.015, 0.015, 0.015}}, {"f", {0.015, 0.015, 0.03}}};
  for (int turn = 0; turn < 2; ++turn) {
    for (const auto& [name, rest] : places) {
      const Vec3d way = rest + H * rest - tip.position;
      const double along = dot(way, tip.direction);
      EXPECT_NEAR(value(probes, simulation, name + "_tip_distance_m"), norm(way), 1e-15) << name;
      EXPECT_NEAR(value(probes, simulation, name + "_tip_along_m"), along, 1e-15) << name;
      EXPECT_NEAR(value(probes, simulation, name + "_tip_across_m"), std::sqrt(dot(way, way) - along * along), 1e-12)
          << name;
    }
    tip.position = {0.02, 0.01, 0.0};  // beyond the places: they lie behind
  }
  EXPECT_LT(value(probes, simulation, "p_tip_along_m"), 0.0);
  EXPECT_EQ(std::count_if(probes.columns().begin(), probes.columns().end(),
                          [](const std::string& c) { return c.find("_tip_") != std::string::npos; }),
            9);
  EXPECT_THROW(Probes(simulation, {{"cut", ProbePlane{{0.0, 0.0, 0.01}}, of_tip}}), std::invalid_argument);
}

std::string scene_with(const std::string& probe) {
  return R"([mesh]
kind = "box"
cells = [2, 2, 2]
size_m = [0.02, 0.02, 0.02]
[[fixed]]
set = "z_min"
[[instrument]]
name = "ball"
kind = "ball"
radius_mm = 1
tip_m = [0.013, 0.01, 0.04]
direction = [0, 0, -1]
motion = { kind = "press", velocity_mm_s = 100, depth_mm = 10 }
[output]
sample_rate_hz = 100
frames = 0
[[probe]]
name = "tumour"
)" + probe;
}

class Samples final : public RunObserver {
 public:
  void on_built(const BuiltVariant& built) override { columns_ = built.probes.columns(); }
  void on_sample(const Sample& s) override { rows.push_back(s); }
  double at(std::size_t row, const std::string& column) const {
    const auto found = std::find(columns_.begin(), columns_.end(), column);
    return rows[row].probes.at(static_cast<std::size_t>(found - columns_.begin()));
  }
  std::vector<Sample> rows;

 private:
  std::vector<std::string> columns_;
};

// A ball 20 mm above the tissue comes 10 mm nearer and never touches: along is what is left of the way to the point, across
// stays, in every sample, and the region's middle is the box's.
TEST(Target, FollowsAToolThroughAir) {
  for (const bool region : {false, true}) {
    const Scene scene = test::parse(
        scene_with(region ? "region = \"0\"\ntip = \"ball\"\n" : "point_m = [0.01, 0.01, 0.01]\ntip = \"ball\"\n"));
    Samples samples;
    const std::atomic<bool> stop{false};
    run_variant(scene.variants.front(), {}, samples, stop);
    ASSERT_GT(samples.rows.size(), 5u);
    for (std::size_t i = 0; i < samples.rows.size(); ++i) {
      const double depth = samples.rows[i].instruments.front().depth;
      const double along = samples.at(i, "tumour_tip_along_m"), across = samples.at(i, "tumour_tip_across_m");
      EXPECT_NEAR(along, 0.03 - depth, 1e-9);
      EXPECT_NEAR(across, 0.003, 1e-9);
      EXPECT_NEAR(samples.at(i, "tumour_tip_distance_m"), std::hypot(along, across), 1e-12);
    }
    EXPECT_LT(samples.at(samples.rows.size() - 1, "tumour_tip_along_m"), 0.021) << "within a step of its end";
  }
}

TEST(Target, NamesWhatItCannotMeasure) {
  const auto fault = [](const std::string& probe) -> std::string {
    try {
      build_variant(test::parse(scene_with(probe)).variants.front(), {});
    } catch (const SceneError& error) {
      return error.what();
    }
    return "no fault";
  };
  EXPECT_EQ(fault("point_m = [0.01, 0.01, 0.01]\ntip = \"ball\"\n"), "no fault");
  EXPECT_THAT(
      fault("point_m = [0.01, 0.01, 0.01]\ntip = \"bal\"\n"),
      AllOf(HasSubstr("probe"), HasSubstr("tip = \"bal\" is no [[instrument]]; there are: ball; did you mean")));
  EXPECT_THAT(fault("plane_m = { point = [0, 0, 0.01] }\ntip = \"ball\"\n"),
              HasSubstr("tip: a plane is no place that a tip can be at a distance from"));
}

}  // namespace
}  // namespace glisson
