// build_mesh_test.cpp — vertices and tets are picked where the scene says, and a miss is explained.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

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

/// The mesh of a box with some vertex sets.
TetMesh picked(const BoxOptions& box, std::map<std::string, Selection> sets,
               const std::vector<RegionSpec>& regions = {}) {
  Variant variant;
  variant.mesh = box, variant.sets = std::move(sets), variant.regions = regions;
  return build_mesh(variant, {});
}

Selection in(const Selection::Box& box) { return {.where = box, .origin = {}}; }

constexpr double kFar = 1.0;  // beyond every body here [m]

// A box whose bounds are decimals of whole millimetres holds the vertices on these bounds, although many of their computed coordinates
// are another number: bars of up to 64 cells whose layers lie on whole millimetres, a box up to each layer and one from it on.
TEST(BuildMesh, BoundsHoldTheVerticesOnThem) {
  int decimals = 0, off = 0;
  for (const int length : {30, 40, 60, 64, 77, 90}) {
    for (const int first : {0, -20, 7, -33}) {
      for (int cells = 2; cells <= length; ++cells) {
        if (length % cells != 0 || cells > 64) continue;
        const auto n = static_cast<std::size_t>(cells);
        const BoxOptions bar{
            .cells = {cells, 1, 1}, .size = {length / 1000.0, 0.01, 0.01}, .origin = {first / 1000.0, 0, 0}};
        std::map<std::string, Selection> sets;
        for (std::size_t i = 0; i <= n; ++i) {
          const double bound = (first + length / cells * static_cast<int>(i)) / 1000.0;  // as a decimal is read
          sets["to " + std::to_string(i)] = in({{-kFar, -kFar, -kFar}, {bound, kFar, kFar}});
          sets["from " + std::to_string(i)] = in({{bound, -kFar, -kFar}, {kFar, kFar, kFar}});
        }
        const TetMesh mesh = picked(bar, sets);
        for (std::size_t i = 0; i <= n; ++i) {
          ++decimals,
              off += mesh.vertices[i].x != std::get<Selection::Box>(sets["from " + std::to_string(i)].where).min.x;
          ASSERT_EQ(mesh.vertex_sets.at("to " + std::to_string(i)).size(), 4 * (i + 1)) << length << ' ' << first;
          ASSERT_EQ(mesh.vertex_sets.at("from " + std::to_string(i)).size(), 4 * (n + 1 - i)) << length << ' ' << first;
        }
      }
    }
  }
  EXPECT_GE(decimals, 1000);
  EXPECT_GE(off, decimals / 10) << "or the coordinates carry no rounding, and this proves nothing";
}

// A pad of 16 mm in the middle of a block of cells of 4 mm is its 5 × 5 vertices, wherever the block lies.
TEST(BuildMesh, APadHasTheVerticesOnItsEdge) {
  for (const double corner : {-0.02, 0.0, 0.013, -0.2}) {
    const double low = static_cast<double>(std::lround(1000 * corner) + 12) / 1000.0,
                 high = static_cast<double>(std::lround(1000 * corner) + 28) / 1000.0;
    const TetMesh mesh = picked({.cells = {10, 10, 5}, .size = {0.04, 0.04, 0.02}, .origin = {corner, corner, 0}},
                                {{"pad", in({{low, low, 0.02}, {high, high, 0.02}})}});
    EXPECT_EQ(mesh.vertex_sets.at("pad").size(), 25u) << corner;
  }
}

// A ball whose surface passes through vertices holds them: against whole numbers, i² + j² + k² ≤ r² in millimetres.
TEST(BuildMesh, ABallHoldsTheVerticesOnItsSurface) {
  for (const int r : {3, 5, 6, 7, 9}) {
    const TetMesh mesh =
        picked({.cells = {20, 20, 20}, .size = {0.02, 0.02, 0.02}, .origin = {-0.003, -0.003, -0.003}},
               {{"ball", {.where = Selection::Sphere{{0.007, 0.007, 0.007}, r / 1000.0}, .origin = {}}}});
    std::size_t inside = 0;
    for (int i = -10; i <= 10; ++i) {
      for (int j = -10; j <= 10; ++j) {
        for (int k = -10; k <= 10; ++k) inside += i * i + j * j + k * k <= r * r;
      }
    }
    EXPECT_EQ(mesh.vertex_sets.at("ball").size(), inside) << r;
  }
}

// Two regions that share a face have each tet once: centroids of a cube's six tets lie at 1/4, 1/2 and 3/4 of its height, two each, and
// those on a face at 1/2 belong all to the later region, none to both and none to neither.
TEST(BuildMesh, RegionsThatShareAFaceShareNoTet) {
  for (const int origin : {0, -20, -33}) {  // [mm]
    for (int layer = 0; layer < 10; ++layer) {
      const double face = (origin + 4 * layer + 2) / 1000.0, bottom = origin / 1000.0;
      const RegionSpec lower{.name = "lower",
                             .where = Selection::Box{{-kFar, -kFar, bottom}, {kFar, kFar, face}},
                             .tissue = {},
                             .origin = {}},
          upper{.name = "upper",
                .where = Selection::Box{{-kFar, -kFar, face}, {kFar, kFar, kFar}},
                .tissue = {},
                .origin = {}};
      const TetMesh mesh =
          picked({.cells = {3, 3, 10}, .size = {0.012, 0.012, 0.04}, .origin = {0.0, 0.0, bottom}}, {}, {lower, upper});
      EXPECT_EQ(std::count(mesh.regions.begin(), mesh.regions.end(), 0), 0) << layer;
      EXPECT_EQ(std::count(mesh.regions.begin(), mesh.regions.end(), 1), 9 * (6 * layer + 2)) << layer;
      EXPECT_EQ(std::count(mesh.regions.begin(), mesh.regions.end(), 2), 9 * (6 * (9 - layer) + 4)) << layer;
    }
  }
}

/// The small scene's body from a file with vertices that belong to no tet, above and beside it.
TetMesh with_loose_vertices(const MeshFile&) {
  TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
  mesh.vertices.push_back({0.01, 0.01, 0.05});
  mesh.vertices.push_back({0.0051, 0.0, 0.02});
  mesh.vertex_sets["dust"] = {27, 28};
  return mesh;
}

// The side of a body is where its tets end, and what is nearest is a vertex of them: vertices in no tet are not the body.
TEST(BuildMesh, LooseVerticesAreNoPlaceOfTheBody) {
  const std::string file = "[[variant]]\nname = \"f\"\nmesh = { kind = \"file\", path = \"liver.vtu\" }\n";
  const TetMesh mesh = mesh_of("[sets.n]\nnearest_m = { point = [0.0051, 0, 0.02] }\n" + file, with_loose_vertices);
  EXPECT_THAT(places(mesh, "n"), ElementsAre(Vec3d{0.01, 0.0, 0.02}));
  std::vector<std::uint32_t> upper = mesh.vertex_sets.at("z_max");
  upper.insert(upper.end(), {27, 28});
  EXPECT_EQ(mesh.vertex_sets.at("top"), upper) << "the whole side of the body, not the highest vertex alone";
  EXPECT_THAT(refusal(file + "fixed.0.set = \"dust\"\n", with_loose_vertices),
              HasSubstr("none of the 2 vertices of the set \"dust\" belongs to a tet"));
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
  // 8 corners of a cell are equally near to its middle, whatever rounding says of it: the first 5 of them.
  for (const double corner : {0.0, -0.05, -0.0488}) {
    const double middle = static_cast<double>(std::lround(1e5 * corner + 500)) / 1e5;
    const TetMesh moved = picked({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}, .origin = {corner, corner, corner}},
                                 {{"n", {.where = Selection::Nearest{{middle, middle, middle}, 5}, .origin = {}}}});
    EXPECT_THAT(moved.vertex_sets.at("n"), ElementsAre(0, 1, 3, 4, 9)) << corner;
  }
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
  EXPECT_THAT(refusal(kFromFile + "[[variant.region]]\nname = \"bile\"\n",
                      [](const MeshFile& file) {
                        TetMesh mesh = two_regions(file);
                        mesh.region_names[8] = "bile";
                        return mesh;
                      }),
              HasSubstr("no tet of the mesh is in its region \"bile\"; there are tets in 4, 7 (vessel)"));
  EXPECT_THAT(refusal(kFromFile, [](const MeshFile&) { return TetMesh{}; }), HasSubstr("0 vertices and 0 tets"));
  EXPECT_THAT(refusal(kFromFile), HasSubstr("s.toml: variant f: no reader for mesh files was given"));
}

}  // namespace
}  // namespace glisson
