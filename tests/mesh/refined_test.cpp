// A mesh split in eight is the same body: volume, surface, regions and sets are kept, faces match, and shapes get hardly worse
// however often it is done.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "glisson/mesh_refinement.h"
#include "support/bodies.h"

namespace glisson {
namespace {

double surface_area(const TetMesh& mesh) {
  double area = 0.0;
  for (const Triangle& t : boundary_triangles(mesh)) {
    const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    area += 0.5 * norm(cross(b - a, c - a));
  }
  return area;
}

double worst_shape(const TetMesh& mesh) {
  double worst = 1.0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) worst = std::min(worst, regular_mean_ratio(mesh, t));
  return worst;
}

// Faces inside belong to two tets and those of the surface to one, four times as many as before, of the same area; no tet is
// inverted and the volume of each is an eighth of its parent's.
TEST(Refined, IsTheSameBody) {
  std::mt19937 random(11);
  const TetMesh mesh = test::jittered_box({3, 2, 2}, 0.01, 0.3, random);
  const TetMesh fine = refined(mesh);
  ASSERT_NO_THROW(require_valid(fine));
  const MeshReport before = inspect(mesh), after = inspect(fine);
  EXPECT_EQ(after.tets, 8 * before.tets);
  EXPECT_EQ(after.boundary_triangles, 4 * before.boundary_triangles);
  EXPECT_EQ(after.non_manifold_faces, 0u);
  EXPECT_EQ(after.pieces, 1u);
  EXPECT_TRUE(after.unused_vertices.empty());
  EXPECT_NEAR(surface_area(fine), surface_area(mesh), 1e-12 * surface_area(mesh));
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (std::size_t k = 0; k < 8; ++k) {
      EXPECT_NEAR(six_rest_volume(fine, 8 * t + k), six_rest_volume(mesh, t) / 8.0, 1e-12 * six_rest_volume(mesh, t));
    }
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) EXPECT_EQ(fine.vertices[v], mesh.vertices[v]);
}

// A field that is linear over the body stays so, to rounding.
TEST(Refined, KeepsLinearFields) {
  std::mt19937 random(11);
  const TetMesh mesh = test::jittered_box({3, 2, 2}, 0.01, 0.3, random);
  const auto linear = [](const TetMesh& m) {
    std::vector<Vec3d> field;
    for (const Vec3d& x : m.vertices) field.push_back({x.x + 2.0 * x.y, 3.0 * x.z, 0.01 - x.x});
    return field;
  };
  const std::vector<Vec3d> fine = refined(mesh, linear(mesh)), exact = linear(refined(mesh));
  ASSERT_EQ(fine.size(), exact.size());
  for (std::size_t v = 0; v < fine.size(); ++v) EXPECT_LE(norm(fine[v] - exact[v]), 1e-16);
  EXPECT_THROW(refined(mesh, exact), std::invalid_argument);
}

// Along the best diagonal the shapes of the children settle: after the first split none is worse by more than a third,
// whatever the tet, four times over.
TEST(Refined, KeepsShapes) {
  std::mt19937 random(5);
  std::normal_distribution<double> x(0.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    TetMesh mesh{{{x(random), x(random), x(random)},
                  {x(random), x(random), x(random)},
                  {x(random), x(random), x(random)},
                  {x(random), x(random), x(random)}},
                 {{0, 1, 2, 3}},
                 {},
                 {},
                 {}};
    if (six_rest_volume(mesh, 0) < 0.0) std::swap(mesh.tets[0][2], mesh.tets[0][3]);
    if (regular_mean_ratio(mesh, 0) < 0.05) continue;  // a sliver to start with
    TetMesh fine = refined(mesh);
    const double first = worst_shape(fine);
    EXPECT_GE(first, 0.3 * regular_mean_ratio(mesh, 0));
    for (int k = 0; k < 3; ++k) {
      fine = refined(fine);
      EXPECT_GE(worst_shape(fine), 0.66 * first) << "tet " << i << ", split " << k + 2;
    }
  }
}

// The box of cubes split in six becomes the box of twice as many cubes: the same vertices, shapes and sets.
TEST(Refined, BoxIsThatOfTwiceTheCells) {
  const BoxOptions options{.cells = {2, 3, 1}, .size = {0.02, 0.03, 0.01}};
  BoxOptions twice = options;
  for (int& n : twice.cells) n *= 2;
  TetMesh fine = refined(box_mesh(options));
  const TetMesh expected = box_mesh(twice);
  ASSERT_EQ(fine.vertices.size(), expected.vertices.size());
  EXPECT_NEAR(worst_shape(fine), worst_shape(expected), 1e-9);
  for (const auto& [name, set] : expected.vertex_sets) EXPECT_EQ(fine.vertex_sets[name].size(), set.size()) << name;
}

// Regions and fibres go to the children. A set of the surface takes middles of edges of the surface only, also where an edge
// between two of its vertices runs through the inside; a set that reaches inside takes all between its vertices.
TEST(Refined, CarriesRegionsFibresAndSets) {
  TetMesh mesh = box_mesh({.cells = {1, 1, 1}, .size = {1.0, 1.0, 1.0}});
  mesh.regions = {0, 1, 2, 3, 4, 5};
  mesh.region_names[3] = "vessel";
  for (int i = 0; i < 6; ++i) mesh.fibres.push_back({1.0 * i, 0.0, 1.0});
  std::vector<std::uint32_t> all(8);
  for (std::uint32_t v = 0; v < 8; ++v) all[v] = v;
  mesh.vertex_sets["all"] = all;
  const TetMesh fine = refined(mesh);
  for (std::size_t t = 0; t < 48; ++t) {
    EXPECT_EQ(fine.regions[t], static_cast<int>(t / 8));
    EXPECT_EQ(fine.fibres[t], mesh.fibres[t / 8]);
  }
  EXPECT_EQ(fine.region_names.at(3), "vessel");
  EXPECT_EQ(fine.vertices.size(), 27u);
  EXPECT_EQ(fine.vertex_sets.at("all").size(), 26u) << "all but the middle of the cube, on its diagonal";
  EXPECT_EQ(fine.vertex_sets.at("z_min").size(), 9u);
  TetMesh inside = fine;
  inside.vertex_sets = {{"half", {}}};
  for (std::uint32_t v = 0; v < 27; ++v) {
    if (fine.vertices[v].x < 0.6) inside.vertex_sets["half"].push_back(v);
  }
  const TetMesh finer = refined(inside);
  std::size_t expected = 0;
  for (const Vec3d& x : finer.vertices) expected += x.x < 0.6 ? 1 : 0;
  EXPECT_EQ(finer.vertex_sets.at("half").size(), expected);
}

TEST(Refined, RefusesWhatIsNoMesh) {
  EXPECT_THROW(refined(TetMesh{{{0, 0, 0}}, {{0, 1, 2, 3}}, {}, {}, {}}), std::invalid_argument);
}

}  // namespace
}  // namespace glisson
