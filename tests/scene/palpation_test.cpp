// A palpation meets the body where geometry says, and refuses points that do not meet it.
#include "scene/build/palpation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "glisson/region_mesh.h"
#include "scene/scene_text.h"

namespace glisson {
namespace palpation_test {

constexpr double kRadius = 0.05, kFinger = 0.008;

TetMesh ball_mesh(double edge) {
  const Vec3d reach{0.055, 0.055, 0.055};
  return mesh_regions({{"ball", [](const Vec3d& p) { return norm(p) - kRadius; }, {-reach, reach}}}, {.edge = edge})
      .mesh;
}

Pose above(double aside) {
  InstrumentSpec spec;
  spec.tip = {aside, 0.0, 0.08};
  return start_pose(spec);
}

// Ball on ball: centres meet at the sum of the radii, so the tip goes down to √((R + r)² − a²) − r. Facets lie up to
// edge²/(8 R) below the ball, 0.08 mm; vertices above it as much.
TEST(Palpation, TouchesABallWhereGeometrySays) {
  const TetMesh mesh = ball_mesh(0.006);
  for (const double aside : {0.0, 0.01, 0.025, 0.04}) {
    const auto touch = scene::first_touch(Ball{kFinger}, above(aside), {0, 0, -1}, mesh);
    ASSERT_TRUE(touch) << aside;
    const double sum = kRadius + kFinger, height = std::sqrt(sum * sum - aside * aside) - kFinger;
    EXPECT_NEAR(0.08 - *touch, height, 1.5e-4 * sum / (height + kFinger)) << aside;
  }
  EXPECT_FALSE(scene::first_touch(Ball{kFinger}, above(0.06), {0, 0, -1}, mesh)) << "58 mm is the farthest";
}

// A flat punch over a flat surface: the distance, wherever vertices lie, also between them.
TEST(Palpation, TouchesAPlaneAtItsDistance) {
  const TetMesh mesh = box_mesh({.cells = {12, 12, 3}, .size = {0.2, 0.2, 0.05}, .origin = {-0.1, -0.1, 0.0}});
  for (const double aside : {0.0, 0.013, 0.031}) {
    EXPECT_NEAR(*scene::first_touch(FlatPunch{0.004}, above(aside), {0, 0, -1}, mesh), 0.03, 1e-6);
    EXPECT_NEAR(*scene::first_touch(Ball{0.02}, above(aside), {0, 0, -1}, mesh), 0.03, 1e-4)
        << "(67 mm / 10)² / (8 · 20 mm)";
  }
}

std::string refusal(const std::string& instrument) {
  const Scene scene = test::parse(
      "[mesh]\nkind = \"box\"\nsize_m = [0.04, 0.04, 0.04]\ncells = [2, 2, 2]\n[[fixed]]\nset = "
      "\"z_min\"\n[[instrument]]\n" +
      instrument);
  try {
    build_variant(scene.variants.at(0), {});
  } catch (const SceneError& error) {
    return error.what();
  }
  return {};
}

// What cannot be felt is named with the place and the way out.
TEST(Palpation, RefusesPointsThatMissTheBody) {
  const std::string grid = "motion = { kind = \"palpation\", columns = 2, rows = 1, spacing_mm = 30 }\n";
  EXPECT_EQ(refusal("kind = \"ball\"\ntip_m = [0.02, 0.02, 0.05]\n" + grid), "");
  const std::string misses = refusal("kind = \"ball\"\ntip_m = [0.05, 0.02, 0.05]\n" + grid);
  EXPECT_NE(misses.find("(0.065, 0.02, 0.05) m misses the body"), std::string::npos) << misses;
  EXPECT_NE(misses.find("spacing_mm"), std::string::npos) << misses;
  const std::string inside = refusal("kind = \"ball\"\ntip_m = [0.02, 0.02, 0.03]\n" + grid);
  EXPECT_NE(inside.find("inside the body at the start"), std::string::npos) << inside;
  const std::string blade = refusal("kind = \"blade\"\ntip_m = [0.02, 0.02, 0.05]\n" + grid);
  EXPECT_NE(blade.find("presses in contact"), std::string::npos) << blade;
}

}  // namespace palpation_test
}  // namespace glisson
