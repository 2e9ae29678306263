#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "glisson/mesh.h"

namespace glisson {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string refusal(const BoxOptions& options) {
  try {
    box_mesh(options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

// The default box is the mesh of the paper's figure 1: 225 vertices, 768 tetrahedra in 1 cm cubes.
TEST(BoxMesh, DefaultIsThePapersMesh) {
  const TetMesh mesh = box_mesh({});
  EXPECT_EQ(mesh.vertices.size(), 225u);
  EXPECT_EQ(mesh.tets.size(), 768u);
  EXPECT_NEAR(volume(mesh), 0.04 * 0.04 * 0.08, 1e-16);  // a sum of 768 roundings at 1e-4 m³
  EXPECT_NO_THROW(require_valid(mesh));
}

// At rest every tet of the cube split has the mean ratio 0.755953, mirrored or not.
TEST(BoxMesh, EveryTetHasTheShapeOfTheCubeSplit) {
  for (const BoxSplit split : {BoxSplit::kuhn, BoxSplit::alternating}) {
    BoxOptions options;
    options.split = split;
    const TetMesh mesh = box_mesh(options);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      ASSERT_NEAR(regular_mean_ratio(mesh, t), 0.755953, 5e-7) << "tet " << t;
      // All six tets of a cube have a sixth of its volume; positive sign: positive orientation.
      ASSERT_NEAR(six_rest_volume(mesh, t), 1e-6, 1e-18) << "tet " << t;
    }
  }
}

// Both splits conform: the boundary is two triangles a square of the surface, in one manifold piece.
TEST(BoxMesh, BothSplitsConform) {
  for (const BoxSplit split : {BoxSplit::kuhn, BoxSplit::alternating}) {
    BoxOptions options;
    options.cells = {3, 4, 5};
    options.split = split;
    const MeshReport report = inspect(box_mesh(options));
    EXPECT_EQ(report.boundary_triangles, 2u * 2u * (3 * 4 + 4 * 5 + 3 * 5));
    EXPECT_EQ(report.non_manifold_faces, 0u);
    EXPECT_EQ(report.pieces, 1u);
    EXPECT_THAT(report.warnings, ElementsAre());
  }
}

// The Kuhn split runs along (0,0,0)–(1,1,1) in every cube; the alternating one uses all four diagonals.
TEST(BoxMesh, SplitsDifferInTheirDiagonals) {
  BoxOptions options;
  options.cells = {2, 2, 2};
  options.size = {2.0, 2.0, 2.0};
  const auto diagonals = [&](BoxSplit split) {
    options.split = split;
    const TetMesh mesh = box_mesh(options);
    std::set<std::array<double, 3>> found;
    for (const Tet& tet : mesh.tets) {
      for (const std::uint32_t a : tet) {
        for (const std::uint32_t b : tet) {
          const Vec3d d = mesh.vertices[b] - mesh.vertices[a];
          if (dot(d, d) == 3.0 && d.z > 0.0) found.insert({d.x, d.y, d.z});
        }
      }
    }
    return found;
  };
  EXPECT_THAT(diagonals(BoxSplit::kuhn), ElementsAre(std::array<double, 3>{1.0, 1.0, 1.0}));
  EXPECT_EQ(diagonals(BoxSplit::alternating).size(), 4u);
}

// Vertices are numbered with x fastest, then y, then z, from the given origin.
TEST(BoxMesh, NumbersVerticesAlongXFirst) {
  BoxOptions options;
  options.cells = {2, 3, 4};
  options.size = {2.0, 3.0, 4.0};
  options.origin = {-1.0, 10.0, 100.0};
  const TetMesh mesh = box_mesh(options);
  EXPECT_EQ(mesh.vertices[1], (Vec3d{0.0, 10.0, 100.0}));
  EXPECT_EQ(mesh.vertices[3], (Vec3d{-1.0, 11.0, 100.0}));
  EXPECT_EQ(mesh.vertices[12], (Vec3d{-1.0, 10.0, 101.0}));
  EXPECT_EQ(mesh.vertices.back(), (Vec3d{1.0, 13.0, 104.0}));
}

// The six named sides hold exactly the vertices on their plane, sorted.
TEST(BoxMesh, NamesItsSides) {
  const TetMesh mesh = box_mesh({});
  ASSERT_EQ(mesh.vertex_sets.size(), 6u);
  const char* names[] = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  const double planes[] = {0.0, 0.04, 0.0, 0.04, 0.0, 0.08};
  for (std::size_t s = 0; s < 6; ++s) {
    std::vector<std::uint32_t> expected;
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      if (mesh.vertices[v][s / 2] == planes[s]) expected.push_back(v);
    }
    EXPECT_EQ(mesh.vertex_sets.at(names[s]), expected) << names[s];
  }
}

// A bad option is refused with its name, its value and the allowed range.
TEST(BoxMesh, RefusesBadOptions) {
  BoxOptions options;
  options.cells = {4, 0, 8};
  EXPECT_THAT(refusal(options), testing::AllOf(HasSubstr("cells[1] = 0"), HasSubstr("1 to 10000")));
  options = {};
  options.size.z = -0.1;
  EXPECT_THAT(refusal(options), testing::AllOf(HasSubstr("size.z [m] = -0.1"), HasSubstr("> 0 and ≤ 10000")));
  options = {};
  options.size.x = std::nan("");
  EXPECT_THAT(refusal(options), HasSubstr("size.x [m] = nan"));
  options = {};
  options.origin.y = INFINITY;
  EXPECT_THAT(refusal(options), HasSubstr("origin.y [m] = inf"));
  options = {};
  options.cells = {10000, 10000, 10000};
  EXPECT_THAT(refusal(options), HasSubstr("at most 1e8"));
}

}  // namespace
}  // namespace glisson
