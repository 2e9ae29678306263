// image_scene_test.cpp — a body of labels in a scene: its keys, regions and sets arrive, it runs, and slips are explained.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "glisson/scene/convergence_variant.h"
#include "image/label_image.h"
#include "scene/scene_text.h"
#include "support/folder.h"

namespace glisson {
namespace {

using ::testing::HasSubstr;

class ImageScene : public test::InFolder {
 protected:
  /// A box of label 1 with a ball of label 2 in it, on a slab of label 9 that is not meshed; the image cuts it at the last k. 2 mm voxels.
  void write_image() {
    write("labels.mha", test::meta_image({30, 26, 20}, 2.0, [](int i, int j, int k) {
            if (k < 4) return k >= 2 ? 9 : 0;
            if (std::hypot(i - 14.5, j - 12.5, k - 11.5) < 5.0) return 2;
            return i >= 4 && i < 26 && j >= 4 && j < 22 ? 1 : 0;
          }));
  }
  Scene parsed(const std::string& text) { return parse_scene(text, "image.toml", folder_, {}); }
  std::string complaint(const std::string& text) {
    try {
      parsed(text);
    } catch (const SceneError& error) {
      return error.what();
    }
    return "was read";
  }
};

const std::string kMesh = R"([mesh]
kind = "image"
path = "labels.mha"
labels = ["organ=1", "lump=2"]
beside = ["table=9"]
beside_mm = 3
edge_mm = 5
)";
const std::string kRest = R"(
[tissue]
youngs_modulus_Pa = 5000
[[region]]
name = "lump"
[region.tissue]
youngs_modulus_Pa = 20000
[[fixed]]
set = "table"
[[tool]]
set = "image_border"
direction = [0, 0, -1]
depth_mm = 1
velocity_mm_s = 20
[motion]
duration_s = 0.01
)";

// Every key arrives in SI, the path beside the scene.
TEST_F(ImageScene, KeysArrive) {
  write_image();
  const Scene scene = parsed(kMesh + R"(implants = ["tumour=ball:30,26,30,6mm"]
voxel_mm = 1.5
keep_pieces = 3
smallest_piece_ml = 0.2
largest_hole_ml = 0.3
smoothing = 4
edges_across = 1.5
refine = false
max_tets = 70000
growth = 0.2
size_image = "sizes.mha"
[[mesh.size]]
near = "lump"
edge_mm = 3
)" + kRest);
  const auto& b = std::get<ImageBody>(scene.variants.at(0).mesh);
  EXPECT_EQ(b.path, folder_ / "labels.mha");
  EXPECT_THAT(b.labels, testing::ElementsAre("organ=1", "lump=2"));
  EXPECT_THAT(b.beside, testing::ElementsAre("table=9"));
  EXPECT_THAT(b.implants, testing::ElementsAre("tumour=ball:30,26,30,6mm"));
  EXPECT_DOUBLE_EQ(b.beside_within, 0.003);
  EXPECT_DOUBLE_EQ(b.voxel, 0.0015);
  EXPECT_EQ(b.keep_pieces, 3);
  EXPECT_DOUBLE_EQ(b.smallest_piece_ml, 0.2);
  EXPECT_DOUBLE_EQ(b.largest_hole_ml, 0.3);
  EXPECT_EQ(b.smoothing, 4);
  EXPECT_DOUBLE_EQ(b.edges_across, 1.5);
  EXPECT_FALSE(b.refine);
  EXPECT_DOUBLE_EQ(b.edge, 0.005);
  EXPECT_EQ(b.max_tets, 70000u);
  EXPECT_EQ(b.growth, 0.2);
  EXPECT_EQ(b.size_image, folder_ / "sizes.mha");
  ASSERT_EQ(b.sizes.size(), 1u);
  EXPECT_EQ(b.sizes[0].near, "lump");
}

// The body is built with regions by name and the sets of surfaces, border and neighbours, and runs: the pressed border gives a force, which the
// support beside the table carries.
TEST_F(ImageScene, BuildsAndRuns) {
  write_image();
  const Scene scene = parsed(kMesh + kRest);
  const Variant& variant = scene.variants.at(0);
  const TetMesh mesh = build_mesh(variant, {});
  EXPECT_EQ(mesh.region_names, (std::map<int, std::string>{{1, "organ"}, {2, "lump"}}));
  const double top = 0.002 * 19.5, bottom = 0.002 * 3.5;
  for (const std::uint32_t v : mesh.vertex_set("image_border")) ASSERT_NEAR(mesh.vertices[v].z, top, 1e-4);
  for (const std::uint32_t v : mesh.vertex_set("table")) ASSERT_LT(mesh.vertices[v].z, bottom + 0.0045);
  EXPECT_GT(mesh.vertex_set("image_border").size(), 20u);
  EXPECT_GT(mesh.vertex_set("table").size(), 20u);
  EXPECT_TRUE(mesh.vertex_set("lump_surface").empty());  // it lies within
  const std::map<int, Tissue> tissues = region_tissues(variant, mesh);
  EXPECT_EQ(tissues.at(2).youngs_modulus, 20000.0);
  RunObserver quiet;
  const std::atomic<bool> stop{false};
  const RunSummary summary = run_variant(variant, {}, quiet, stop);
  EXPECT_EQ(summary.end, RunSummary::End::finished);
  EXPECT_GT(summary.peak_force_N, 0.01);
}

// Refined, its edges are half as long.
TEST_F(ImageScene, IsRefinedByItsEdge) {
  write_image();
  const RefinedVariant fine = refined_variant(parsed(kMesh + kRest).variants.at(0), 1, {});
  EXPECT_DOUBLE_EQ(std::get<ImageBody>(fine.variant.mesh).edge, 0.0025);
}

// A file that is not there, a label without a name, a set that is none, and a label beside that is meshed are messages with their place.
TEST_F(ImageScene, SlipsAreExplained) {
  EXPECT_THAT(complaint(kMesh + kRest),
              testing::AllOf(HasSubstr("image.toml:3:"), HasSubstr("mesh.path"), HasSubstr("no such file")));
  write_image();
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = kMesh + kRest;
    text.replace(text.find(from), from.size(), to);
    return complaint(text);
  };
  EXPECT_THAT(with("\"lump=2\"", "\"liver\""),
              testing::AllOf(HasSubstr("image.toml:4:"), HasSubstr("gives its labels no names")));
  EXPECT_THAT(with("set = \"table\"", "set = \"tabel\""), testing::AllOf(HasSubstr("tabel"), HasSubstr("table")));
  EXPECT_THAT(with("table=9", "table=1"), HasSubstr("label 1 is in the region \"organ\", which is meshed"));
}

}  // namespace
}  // namespace glisson
