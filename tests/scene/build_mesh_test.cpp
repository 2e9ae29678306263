// build_mesh_test.cpp — vertices and tets are picked where the scene says, and a miss is explained.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/scene_text.h"

namespace glisson {
namespace {

using test::kSmallScene;
using test::parse;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TetMesh mesh_of(const std::string& more, const MeshLoader& load = {}) {
  return build_mesh(parse(kSmallScene + more).variants.at(0), load);
}

std::string refusal(const std::string& more, const MeshLoader& load = {}) {
  try {
    mesh_of(more, load);
  } catch (const SceneError& error) {
    return error.what();
  }
  return {};
}

std::vector<Vec3d> places(const TetMesh& mesh, const std::string& set) {
  std::vector<Vec3d> result;
  for (const std::uint32_t i : mesh.vertex_sets.at(set)) result.push_back(mesh.vertices[i]);
  return result;
}

// One side of a 2 × 2 × 2 box is its 3 × 3 grid of vertices, and equals the generator's own set.
TEST(BuildMesh, PicksASide) {
  const TetMesh mesh = mesh_of("");
  EXPECT_EQ(mesh.vertex_sets.at("top"), mesh.vertex_sets.at("z_max"));
  EXPECT_EQ(mesh.vertex_sets.at("top").size(), 9u);
  const TetMesh deeper = mesh_of("[sets.low]\nside = { axis = \"x\", end = \"lower\", depth_m = 0.01 }\n");
  EXPECT_EQ(deeper.vertex_sets.at("low").size(), 18u) << "two layers: a nominal depth of one cell includes the next";
}

// Boxes and balls include their boundary; what lies outside is not picked.
TEST(BuildMesh, PicksABoxAndABall) {
  const TetMesh mesh = mesh_of(
      "[sets.b]\nbox_m = { min = [0, 0, 0], max = [0.01, 0.01, 0.005] }\n"
      "[sets.s]\nsphere_m = { center = [0.01, 0.01, 0.01], radius = 0.0101 }\n"
      "[sets.skin]\nsphere_m = { center = [0.01, 0.01, 0.01], radius = 0.0101 }\nsurface_only = true\n");
  EXPECT_EQ(mesh.vertex_sets.at("b").size(), 4u);
  EXPECT_EQ(mesh.vertex_sets.at("s").size(), 7u) << "the centre and its six neighbours";
  EXPECT_EQ(mesh.vertex_sets.at("skin").size(), 6u) << "the centre is inside";
}

// The three vertices nearest to the middle of a triangle are its corners; equal distances go to the lower number.
TEST(BuildMesh, PicksTheNearest) {
  const TetMesh mesh = mesh_of(
      "[sets.n]\nnearest_m = { point = [0.0067, 0.0067, 0.02], count = 3 }\n"
      "[sets.one]\nnearest_m = { point = [0.005, 0, 0] }\n");
  const std::vector<Vec3d> corners = places(mesh, "n");
  ASSERT_EQ(corners.size(), 3u);
  for (const Vec3d& x : corners) EXPECT_NEAR(x.z, 0.02, 1e-12);
  const Vec3d sum = corners[0] + corners[1] + corners[2];
  EXPECT_NEAR(sum.x, 0.02, 1e-12);
  EXPECT_NEAR(sum.y, 0.02, 1e-12);
  EXPECT_THAT(mesh.vertex_sets.at("one"), ElementsAre(0));
}

// Vertex numbers are taken sorted and once each.
TEST(BuildMesh, PicksByNumber) {
  EXPECT_THAT(mesh_of("[sets.v]\nvertices = [5, 2, 5]\n").vertex_sets.at("v"), ElementsAre(2, 5));
}

// A set of the scene takes the place of the mesh's own.
TEST(BuildMesh, ReplacesASetOfTheMesh) {
  EXPECT_THAT(mesh_of("[sets.x_min]\nvertices = [0]\n").vertex_sets.at("x_min"), ElementsAre(0));
}

// A selection that picks nothing says what was asked, where, and where the mesh is.
TEST(BuildMesh, ExplainsAnEmptySelection) {
  EXPECT_EQ(refusal("[sets.far]\nbox_m = { min = [1, 1, 1], max = [2, 2, 2] }\n"),
            "s.toml:16:1: sets.far: no vertex lies in the box from [1, 1, 1] to [2, 2, 2] m; the mesh spans x 0 to "
            "0.02 m, y 0 "
            "to 0.02 m, z 0 to 0.02 m");
  EXPECT_THAT(refusal("[sets.in]\nsphere_m = { center = [0.01, 0.01, 0.01], radius = 0.001 }\nsurface_only = true\n"),
              HasSubstr("no vertex of the surface lies in the ball of 0.001 m about [0.01, 0.01, 0.01]"));
  EXPECT_THAT(refusal("[sets.many]\nnearest_m = { point = [0, 0, 0], count = 28 }\n"),
              HasSubstr("28 vertices asked for, there are 27"));
  EXPECT_THAT(refusal("[sets.v]\nvertices = [27]\n"), HasSubstr("vertex 27 does not exist; allowed: 0 to 26"));
  EXPECT_THAT(refusal("[sets.v]\nvertices = [13]\nsurface_only = true\n"),
              HasSubstr("vertex 13 is not on the surface"));
}

// A region is the tets whose centroid lies in it, with a number and a name of its own; later ones win.
TEST(BuildMesh, MarksRegions) {
  const std::string lower =
      "[[region]]\nname = \"lower\"\nbox_m = { min = [0, 0, 0], max = [1, 1, 0.01] }\ntissue.density_kg_m3 = 2000\n";
  const std::string corner =
      "[[region]]\nname = \"corner\"\nbox_m = { min = [0, 0, 0], max = [0.01, 0.01, 0.01] }\ntissue.density_kg_m3 = "
      "3000\n";
  const Variant v = parse(kSmallScene + lower + corner).variants.at(0);
  const TetMesh mesh = build_mesh(v, {});
  ASSERT_EQ(mesh.regions.size(), 48u);
  EXPECT_EQ(std::count(mesh.regions.begin(), mesh.regions.end(), 0), 24);
  EXPECT_EQ(std::count(mesh.regions.begin(), mesh.regions.end(), 1), 18);
  EXPECT_EQ(std::count(mesh.regions.begin(), mesh.regions.end(), 2), 6);
  EXPECT_EQ(mesh.region_names.at(1), "lower");
  const std::map<int, Tissue> tissues = region_tissues(v, mesh);
  ASSERT_EQ(tissues.size(), 3u);
  EXPECT_EQ(tissues.at(0).density, 1000.0);
  EXPECT_EQ(tissues.at(1).density, 2000.0);
  EXPECT_EQ(tissues.at(2).density, 3000.0);
}

/// A loader that gives a box with two regions, one of them named.
TetMesh two_regions(const MeshFile&) {
  TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
  mesh.regions.assign(mesh.tets.size(), 4);
  for (std::size_t t = 0; t < 6; ++t) mesh.regions[t] = 7;
  mesh.region_names[7] = "vessel";
  mesh.vertex_sets.erase("z_min");
  mesh.vertex_sets["base"] = {0, 1, 2};
  return mesh;
}

const std::string kFromFile =
    "[[variant]]\nname = \"f\"\nmesh = { kind = \"file\", path = \"liver.vtu\" }\nfixed.0.set = \"base\"\n";

// Regions of a mesh file get a tissue by their name or number, and the loader sees the file and its scale.
TEST(BuildMesh, GivesRegionsOfAFileTheirTissue) {
  const Variant v = parse(kSmallScene + kFromFile +
                          "[[variant.region]]\nname = \"vessel\"\ntissue.density_kg_m3 = 1200\n"
                          "[[variant.region]]\nname = \"4\"\ntissue.density_kg_m3 = 1300\n")
                        .variants.at(0);
  MeshFile asked;
  const TetMesh mesh = build_mesh(v, [&](const MeshFile& file) {
    asked = file;
    return two_regions(file);
  });
  EXPECT_EQ(asked.path, "/scenes/liver.vtu");
  EXPECT_EQ(region_tissues(v, mesh).at(7).density, 1200.0);
  EXPECT_EQ(region_tissues(v, mesh).at(4).density, 1300.0);
}

// What only the mesh can show to be wrong is still said with the line of the scene, and with what there is.
TEST(BuildMesh, ExplainsWhatAFileDoesNotHave) {
  EXPECT_EQ(refusal("[[variant]]\nname = \"f\"\nmesh = { kind = \"file\", path = \"liver.vtu\" }\n", two_regions),
            "s.toml:9:1: fixed.0: no vertex set \"z_min\"; did you mean \"x_min\"? the sets are: base, top, x_max, "
            "x_min, y_max, "
            "y_min, z_max");
  EXPECT_EQ(refusal(kFromFile + "[[variant.region]]\nname = \"tumour\"\n", two_regions),
            "s.toml:20:1: region.0: the mesh has no region \"tumour\"; it has: 4, 7 (vessel). Give `box_m` or "
            "`sphere_m` to make one");
  EXPECT_THAT(
      refusal(kFromFile + "[[variant.region]]\nname = \"vessel\"\nsphere_m = { center = [0, 0, 0], radius = 1 }\n",
              two_regions),
      HasSubstr("the mesh has a region \"vessel\" already"));
  EXPECT_THAT(refusal("[[region]]\nname = \"r\"\nsphere_m = { center = [1, 1, 1], radius = 0.1 }\n"),
              HasSubstr("no tet has its centroid in the region \"r\"; the mesh spans x 0 to 0.02 m"));
  EXPECT_THAT(refusal(kFromFile, [](const MeshFile&) { return TetMesh{}; }), HasSubstr("0 vertices and 0 tets"));
  EXPECT_THAT(refusal(kFromFile), HasSubstr("s.toml: variant f: no reader for mesh files was given"));
}

}  // namespace
}  // namespace glisson
