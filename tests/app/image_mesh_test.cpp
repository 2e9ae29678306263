// image_mesh_test.cpp — glisson mesh of an image: regions are the labels, the JSON compares them with the voxels.
#include <cmath>

#include "app/program.h"
#include "glisson/io.h"
#include "image/label_image.h"

namespace glisson::test {
namespace {

using ImageMeshCommand = ProgramTest;
using ::testing::HasSubstr;

std::string organ_with_lump() {
  return meta_image({26, 24, 22}, 3.0, [](int i, int j, int k) {
    if (std::hypot(i - 12.5, j - 11.5, k - 10.5) > 9.0) return 0;
    return std::hypot(i - 12.5, j - 11.5, k - 10.5) < 4.5 ? 64 : 5;
  });
}

// The file has the labels as regions, in metres; the JSON has for each its label, volumes, pieces and distance, and the angles of the mesh.
TEST_F(ImageMeshCommand, WritesMeshAndFigures) {
  const Outcome outcome = run({"mesh", write("a.mha", organ_with_lump()), "--labels", "organ=5,64", "--implant",
                               "clip=ball:18,34.5,31.5,9mm", "--out", (folder_ / "b.vtu").string(), "--json",
                               (folder_ / "b.json").string()});
  ASSERT_THAT(outcome, Exits(0)) << outcome.err;
  const TetMesh mesh = read_mesh(folder_ / "b.vtu").mesh;
  EXPECT_EQ(mesh.region_names, (std::map<int, std::string>{{5, "organ"}, {64, "label_64"}, {65, "clip"}}));
  EXPECT_LT(box_of(mesh).second.x, 0.1);
  const nlohmann::json figures = read_json(folder_ / "b.json");
  EXPECT_EQ(figures.at("tets"), mesh.tets.size());
  EXPECT_GE(figures.at("min_dihedral_deg").get<double>(), 10.0);
  EXPECT_LE(figures.at("max_dihedral_deg").get<double>(), 165.0);
  EXPECT_GE(figures.at("relative_stable_step").get<double>(), 0.3);
  ASSERT_EQ(figures.at("regions").size(), 3u);
  for (const nlohmann::json& region : figures.at("regions")) {
    const double image_ml = region.at("image_volume_ml").get<double>();
    EXPECT_NEAR(region.at("volume_ml").get<double>() / image_ml, 1.0, image_ml < 5.0 ? 0.05 : 0.03) << region;
    EXPECT_LE(region.at("distance_p95_mm").get<double>(), 1.5) << region;
    EXPECT_EQ(region.at("pieces"), region.at("image_pieces")) << region;
    EXPECT_EQ(region.at("label"), region.at("number"));
  }
}

// What cannot be done is said with the way out: no labels, options of images elsewhere, options of scenes with images, words that are wrong.
TEST_F(ImageMeshCommand, ExplainsWhatItRefuses) {
  const std::string image = write("a.mha", organ_with_lump()), out = (folder_ / "b.vtu").string();
  const auto said = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--out", out});
    const Outcome outcome = run(arguments);
    EXPECT_THAT(outcome, Exits(2));
    return outcome.err;
  };
  EXPECT_THAT(said({"mesh", image}), HasSubstr("an image needs --labels"));
  EXPECT_THAT(said({"mesh", image, "--labels", "7"}), HasSubstr("no voxel has the label 7; there are: 5, 64"));
  EXPECT_THAT(said({"mesh", image, "--labels", "5", "--scale", "2"}), HasSubstr("are not for images"));
  EXPECT_THAT(said({"mesh", image, "--labels", "5", "--near", "label_5"}), HasSubstr("write REGION=E"));
  EXPECT_THAT(said({"mesh", image, "--labels", "5", "--edge-mm", "-1"}), HasSubstr("allowed: > 0"));
  EXPECT_THAT(said({"mesh", write("s.toml", small_scene()), "--labels", "5"}), HasSubstr("--labels is for images"));
}

}  // namespace
}  // namespace glisson::test
