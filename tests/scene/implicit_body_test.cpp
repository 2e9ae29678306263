// A body of shapes in a scene: every key arrives where it belongs, regions become those of the mesh, and slips are explained.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "glisson/scene/convergence_variant.h"
#include "scene/scene_text.h"

namespace glisson {
namespace {

using test::complaint;
using test::parse;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kShapes = R"([mesh]
kind = "implicit"
edge_mm = 4
max_tets = 100000

[[mesh.shape]]
name = "organ"
kind = "ellipsoid"
semi_axes_mm = [25, 20, 20]
exponent_z = 3

[[mesh.shape]]
name = "vessel"
kind = "tube"
points = [{ at_mm = [-40, 0, 0], radius_mm = 6 }, { at_mm = [40, 0, 0], radius_mm = 4 }]

[[mesh.shape]]
name = "inside"
kind = "intersection"
of = ["vessel", "organ"]

[[mesh.shape]]
name = "tilted"
kind = "placed"
of = "organ"
angle_deg = 20

[[mesh.region]]
name = "vessel"
shape = "inside"

[[mesh.region]]
name = "tilted"

[[region]]
name = "vessel"
tissue.youngs_modulus_Pa = 9000

[motion]
duration_s = 0.1
)";

/// The scene with `from` replaced by `to`.
std::string changed(const std::string& from, const std::string& to) {
  std::string text = kShapes;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// Lengths come in millimetres, references by name, and the order of regions stays.
TEST(ImplicitScene, IsRead) {
  const auto body = std::get<ImplicitBody>(parse(kShapes).variants.at(0).mesh);
  EXPECT_DOUBLE_EQ(body.edge, 0.004);
  EXPECT_EQ(body.max_tets, 100000u);
  ASSERT_EQ(body.shapes.size(), 4u);
  EXPECT_EQ(std::get<EllipsoidShape>(body.shapes[0].what).semi_axes, (Vec3d{0.025, 0.02, 0.02}));
  EXPECT_EQ(std::get<EllipsoidShape>(body.shapes[0].what).exponent_z, 3.0);
  EXPECT_EQ(std::get<TubeShape>(body.shapes[1].what).points.at(1).at, (Vec3d{0.04, 0, 0}));
  EXPECT_THAT(std::get<IntersectionShape>(body.shapes[2].what).of, ElementsAre("vessel", "organ"));
  EXPECT_EQ(std::get<PlacedShape>(body.shapes[3].what).angle_deg, 20.0);
  EXPECT_EQ(body.regions.at(0).shape, "inside");
}

// The mesh has the regions under their names, each with its tissue.
TEST(ImplicitScene, GivesRegionsTheirTissue) {
  const Variant variant = parse(kShapes).variants.at(0);
  const TetMesh mesh = build_mesh(variant, {});
  EXPECT_EQ(mesh.region_names.at(1), "vessel");
  EXPECT_EQ(mesh.region_names.at(2), "tilted");
  const auto tissues = region_tissues(variant, mesh);
  EXPECT_EQ(tissues.at(1).youngs_modulus, 9000.0);
  EXPECT_EQ(tissues.at(2).youngs_modulus, variant.tissue.youngs_modulus);
  EXPECT_THROW(build_mesh(variant, {}, [](double) { return false; }), MeshingStopped);
}

// Twice as fine means half the edge: a study of convergence meshes the same shapes again.
TEST(ImplicitScene, IsRefinedByItsEdge) {
  const RefinedVariant fine = refined_variant(parse(kShapes).variants.at(0), 1, {});
  EXPECT_FALSE(fine.split);
  EXPECT_DOUBLE_EQ(std::get<ImplicitBody>(fine.variant.mesh).edge, 0.002);
}

// An element of the lists is changed by its name.
TEST(ImplicitScene, IsOverridden) {
  const Scene scene = parse(kShapes, {{"mesh.shape.vessel.points",
                                       "[{ at_mm = [0, 0, 0], radius_mm = 1 }, { at_mm = [1, 0, 0], radius_mm = 1 }]"},
                                      {"mesh.edge_mm", "5"}});
  const auto body = std::get<ImplicitBody>(scene.variants.at(0).mesh);
  EXPECT_DOUBLE_EQ(body.edge, 0.005);
  EXPECT_DOUBLE_EQ(std::get<TubeShape>(body.shapes[1].what).points.at(0).radius, 0.001);
}

/// The scene with sizes.
std::string sized(const std::string& from = "", const std::string& to = "") {
  std::string text = changed("max_tets = 100000\n", "max_tets = 100000\ngrowth = 0.5\n") + R"(
[[mesh.size]]
near = "vessel"
edge_mm = 2.5
within_mm = 1

[[mesh.size]]
surface = "tilted"
edge_mm = 2
per_radius = 3

[[mesh.size]]
path = [{ at_mm = [-40, 0, 0] }, { at_mm = [40, 0, 0] }]
edge_mm = 2.5
)";
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// Sizes arrive with their places, and a study of convergence halves them, too.
TEST(ImplicitScene, HasSizes) {
  const Variant variant = parse(sized()).variants.at(0);
  const auto body = std::get<ImplicitBody>(variant.mesh);
  EXPECT_EQ(body.growth, 0.5);
  ASSERT_EQ(body.sizes.size(), 3u);
  EXPECT_EQ(body.sizes[0].near, "vessel");
  EXPECT_DOUBLE_EQ(body.sizes[0].edge, 0.0025);
  EXPECT_DOUBLE_EQ(body.sizes[0].within, 0.001);
  EXPECT_EQ(body.sizes[1].surface, "tilted");
  EXPECT_EQ(body.sizes[1].per_radius, 3.0);
  EXPECT_EQ(body.sizes[2].path.at(1).at, (Vec3d{0.04, 0, 0}));
  const RefinedVariant fine = refined_variant(variant, 1, {});
  EXPECT_DOUBLE_EQ(std::get<ImplicitBody>(fine.variant.mesh).sizes[0].edge, 0.00125);
  EXPECT_GT(build_mesh(variant, {}).tets.size(), 2 * build_mesh(parse(kShapes).variants.at(0), {}).tets.size());
}

// Slips of sizes are told with the place, the value and the way out.
TEST(ImplicitScene, ExplainsSlipsOfSizes) {
  EXPECT_THAT(complaint(sized("near = \"vessel\"", "near = \"vesel\"")),
              HasSubstr("mesh.size.0.near: \"vesel\" is no region of the mesh; did you mean \"vessel\"?"));
  EXPECT_THAT(complaint(sized("edge_mm = 2.5", "edge_mm = 0.01")),
              HasSubstr("mesh.size.0.edge_mm: 0.01 mm is out of range; allowed: 0.0156 or more, a 256th of the edge of "
                        "the mesh, 4 mm"));
  EXPECT_THAT(complaint(sized("surface = \"tilted\"", "surface = \"tilted\"\nnear = \"vessel\"")),
              HasSubstr("names more than one place"));
  EXPECT_THAT(complaint(sized("near = \"vessel\"\n", "")), HasSubstr("names no place"));
  EXPECT_THAT(complaint(sized("growth = 0.5", "growth = 5")), HasSubstr("0.05 to 1"));
}

// Slips are told with the place, the value and the way out.
TEST(ImplicitScene, ExplainsSlips) {
  EXPECT_THAT(complaint(changed("of = [\"vessel\"", "of = [\"vesel\"")),
              HasSubstr("s.toml:20:6: mesh.shape.2.of: there is no shape \"vesel\" before; did you mean \"vessel\"?"));
  EXPECT_THAT(complaint(changed("shape = \"inside\"", "shape = \"outside\"")),
              HasSubstr("mesh.region.0.shape: there is no shape"));
  EXPECT_THAT(complaint(changed("name = \"vessel\"\nkind", "name = \"organ\"\nkind")),
              HasSubstr("name of an earlier shape"));
  EXPECT_THAT(complaint(changed("edge_mm = 4", "edge_mm = 0")),
              HasSubstr("mesh.edge_mm: 0 mm is out of range; allowed: > 0"));
  EXPECT_THAT(complaint("[mesh]\nkind = \"implicit\"\n"), HasSubstr("mesh: has no [[mesh.shape]]; give one or more"));
  EXPECT_THAT(complaint(changed("[25, 20, 20]", "[25, 20, -20]")), HasSubstr("semi_axes_mm"));
}

// What only the mesher finds out names region, value and the way out, and the scene.
TEST(ImplicitScene, ExplainsWhatCannotBeMeshed) {
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      build_mesh(parse(text).variants.at(0), {});
    } catch (const SceneError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_THAT(refusal(changed("edge_mm = 4", "edge_mm = 90")), HasSubstr("smaller edge"));
  EXPECT_THAT(refusal(changed("max_tets = 100000", "max_tets = 100")),
              HasSubstr("at most 100 are allowed: give an edge of"));
}

// The liver's options and its vertex sets are known to a scene.
TEST(LiverScene, HasItsOptionsAndSets) {
  const std::string text =
      "[mesh]\nkind = \"liver\"\nedge_mm = 16\ntumour_radius_mm = 0\n[motion]\nduration_s = 1\n[[fixed]]\nset = "
      "\"bare_area\"\n";
  const Variant variant = parse(text).variants.at(0);
  EXPECT_DOUBLE_EQ(std::get<LiverOptions>(variant.mesh).edge, 0.016);
  const TetMesh mesh = build_mesh(variant, {});
  EXPECT_FALSE(mesh.vertex_sets.at("bare_area").empty());
  EXPECT_EQ(mesh.region_names.rbegin()->second, "parenchyma");
  EXPECT_THAT(complaint(text + "[[fixed]]\nset = \"bare_are\"\n"), HasSubstr("bare_area"));
  const std::string size = "[[mesh.size]]\nnear = \"parenchyma\"\nedge_mm = 8\n";
  EXPECT_EQ(std::get<LiverOptions>(parse(text + size).variants.at(0).mesh).sizes.at(0).near, "parenchyma");
  EXPECT_THAT(complaint(text + "[[mesh.size]]\nnear = \"tumor\"\nedge_mm = 8\n"),
              HasSubstr("\"tumor\" is no region of the mesh; did you mean \"tumour\"?"));
}

// The gallbladder is a key, a region and a set; without the key a scene that names it is told so.
TEST(LiverScene, HasAGallbladderAndLigamentsToHold) {
  const std::string head = "[mesh]\nkind = \"liver\"\nedge_mm = 16\n",
                    rest = "[motion]\nduration_s = 1\n[[fixed]]\nset = \"left_triangular_ligament\"\n";
  const Variant variant =
      parse(head + "gallbladder = true\n" + rest + "[[load]]\nset = \"gallbladder\"\nspring_N_m = [1, 1, 1]\n")
          .variants.at(0);
  EXPECT_TRUE(std::get<LiverOptions>(variant.mesh).gallbladder);
  EXPECT_FALSE(build_mesh(variant, {}).vertex_sets.at("gallbladder").empty());
  EXPECT_THAT(complaint(head + rest + "[[load]]\nset = \"gallbladder\"\nspring_N_m = [1, 1, 1]\n"),
              HasSubstr("gallbladder"));
  EXPECT_THAT(complaint(head + rest + "[[mesh.size]]\nnear = \"gallbladder\"\nedge_mm = 8\n"),
              HasSubstr("is no region of the mesh"));
}

}  // namespace
}  // namespace glisson
