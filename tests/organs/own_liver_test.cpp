// own_liver_test.cpp — the scenes for a user's own organ run unedited on any: the shared liver as it is, mirrored, in millimetres, coarser,
// and turned at random, and the shapes' liver, which needs no file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <random>

#include "glisson/instruments/needle.h"
#include "glisson/io.h"
#include "glisson/liver.h"
#include "glisson/surface_region.h"
#include "support/folder.h"
#include "support/places.h"
#include "support/scene_runs.h"

namespace glisson {
namespace own_liver_test {

/// Middle of the volume of tets at some places.
Vec3d middle_of(const TetMesh& mesh) {
  Vec3d sum{};
  double weight = 0.0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const double volume = six_rest_volume(mesh, t);
    for (const std::uint32_t v : mesh.tets[t]) sum += mesh.vertices[v] * (0.25 * volume);
    weight += volume;
  }
  return sum * (1.0 / weight);
}

/// Keeps where the needle and the body are at the end.
class LastPose final : public RunObserver {
 public:
  void on_built(const BuiltVariant& built) override { built_ = &built; }
  void on_frame(const Simulation& simulation) override {
    rest = now = simulation.mesh();
    now.vertices = simulation.positions();
    tip = built_->instruments.front()->pose().position;
    along = unit(built_->instruments.front()->direction());
  }
  void on_event(const RunEvent& event) override { events.push_back(event.what.event); }

  /// How far the straight needle is from a point [m].
  double distance(const Vec3d& point) const {
    constexpr double kLength = 0.2;
    const double back = std::clamp(dot(tip - point, along), 0.0, kLength);
    return norm(tip - along * back - point);
  }

  TetMesh rest, now;
  Vec3d tip, along;
  std::vector<std::string> events;

 private:
  const BuiltVariant* built_ = nullptr;
};

TetMesh moved(TetMesh mesh, const std::function<Vec3d(const Vec3d&)>& where) {
  for (Vec3d& x : mesh.vertices) x = where(x);
  orient_and_inspect(mesh);
  return mesh;
}

TetMesh turned(const TetMesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const Vec3d x = unit(Vec3d{normal(random), normal(random), normal(random)});
  const Vec3d y = unit(cross(x, Vec3d{normal(random), normal(random), normal(random)})), z = cross(x, y);
  return moved(mesh, [&](const Vec3d& p) { return Vec3d{dot(x, p), dot(y, p), dot(z, p)}; });
}

/// The same organ with edges some 1.5 times as long.
TetMesh coarser(const TetMesh& mesh) {
  return mesh_regions({surface_region("liver", mesh.vertices, boundary_triangles(mesh))}, {.edge = 0.016}).mesh;
}

class OwnLiver : public test::InFolder {
 protected:
  void SetUp() override {
    const std::filesystem::path file = test::shipped("../shared/data/meshes/liver.vtu");
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "the liver mesh is not here: " << file;
    liver_ = read_mesh(file).mesh;
  }

  /// Writes a mesh, and runs both scenes on it as a user does: the path is all that is given.
  void run(const TetMesh& mesh, const std::string& name) {
    SCOPED_TRACE(name);
    const std::filesystem::path file = folder_ / (name + ".vtu");
    write_vtu(file, mesh);
    const MeshLoader load = [](const MeshFile& source) { return read_mesh(source.path, source.scale).mesh; };
    press(test::shipped_scene("organs/own_liver.toml", {{"mesh.path", file.string()}}), load);
    LastPose last;
    const std::atomic<bool> stop{false};
    const Scene needle = test::shipped_scene("organs/own_liver_needle.toml", {{"mesh.path", file.string()}});
    const RunSummary summary = run_variant(needle.variants.front(), load, last, stop);
    EXPECT_EQ(summary.end, RunSummary::End::finished) << summary.trouble;
    EXPECT_THAT(summary.never_met, ::testing::IsEmpty());
    EXPECT_THAT(last.events, ::testing::IsSupersetOf({"contact", "puncture"}));
    const double at_rest = last.distance(middle_of(last.rest)), now = last.distance(middle_of(last.now));
    std::printf("%-12s needle to the middle at rest %.2f mm, as it lies now %.2f mm; %.2f N, %zu tets inverted\n",
                name.c_str(), 1e3 * at_rest, 1e3 * now, summary.peak_force_N, summary.inverted_tets_most);
    EXPECT_LT(at_rest, 0.005);
    EXPECT_LT(now, 0.005);
  }

 private:
  static void press(const Scene& scene, const MeshLoader& load) {
    const test::RunRecord run = test::run_recorded(scene.variants.front(), load);
    EXPECT_EQ(run.summary.end, RunSummary::End::finished) << run.summary.trouble;
    EXPECT_NEAR(run.depth.back(), 0.010, 2e-5) << "pressed by 10 mm";
    EXPECT_GT(run.force.back(), 0.05) << "the organ resists [N]";
  }

 protected:
  TetMesh liver_;
};

// As it is, mirrored and in millimetres: the needle comes within 5 mm of the middle of the body.
TEST_F(OwnLiver, RunsAsItIs) { run(liver_, "as it is"); }

TEST_F(OwnLiver, RunsMirroredInMillimetres) {  // long
  run(moved(liver_, [](const Vec3d& p) { return Vec3d{-1e3 * p.x, 1e3 * p.y, 1e3 * p.z}; }), "mirrored, mm");
}

TEST_F(OwnLiver, RunsCoarser) { run(coarser(liver_), "coarser"); }  // long

// The organ that a user without a file has is that of shapes.
TEST_F(OwnLiver, RunsOfShapes) { run(liver_mesh({.edge = 0.015}).mesh, "of shapes"); }  // long

// Turned at random, coarser or not.
class OwnLiverTurned : public OwnLiver, public ::testing::WithParamInterface<unsigned> {};
TEST_P(OwnLiverTurned, Runs) {
  const TetMesh mesh = turned(GetParam() % 2 == 0 ? coarser(liver_) : liver_, GetParam());
  run(mesh, "turned " + std::to_string(GetParam()));
}
INSTANTIATE_TEST_SUITE_P(First, OwnLiverTurned, ::testing::Values(1U, 2U));  // long
INSTANTIATE_TEST_SUITE_P(All, OwnLiverTurned, ::testing::Range(3U, 13U));    // verify

}  // namespace own_liver_test
}  // namespace glisson
