// A real organ mesh made elsewhere: base held, gravity, a press by a few surface vertices, at the automatic step.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "glisson/io.h"
#include "support/places.h"
#include "support/scene_runs.h"

namespace glisson {
namespace {

TEST(Liver, IsPressedAtTheAutomaticStep) {
  const std::filesystem::path file = test::shipped("../shared/data/meshes/liver.vtu");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the liver mesh is not here: " << file;
  const Scene scene = test::shipped_scene("organs/own_liver.toml", {{"mesh.path", file.string()}});
  const MeshLoader load = [](const MeshFile& source) { return read_mesh(source.path, source.scale).mesh; };
  const test::RunRecord run = test::run_recorded(scene.variants.front(), load);

  EXPECT_EQ(run.summary.end, RunSummary::End::finished);
  EXPECT_EQ(run.summary.vertices, 1523U);
  EXPECT_EQ(run.summary.tets, 7828U);
  EXPECT_NEAR(run.depth.back(), 0.010, 2e-5) << "pressed by 10 mm";
  EXPECT_GT(run.force.back(), 0.05) << "the liver resists [N]";
  const Energies& e = run.summary.energies;
  EXPECT_LE(std::abs(e.imbalance()), 1e-8 * (std::abs(e.work_tools) + std::abs(e.work_loads)))
      << "energies balance [J]";
  EXPECT_LT(run.summary.step_s, run.summary.stable_step_s);
}

}  // namespace
}  // namespace glisson
