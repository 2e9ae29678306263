#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "glisson/mesh.h"

namespace glisson {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TetMesh one_tet() { return {{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}}, {{0, 1, 2, 3}}, {}, {}, {}}; }

void scale(TetMesh& mesh, double factor) {
  for (Vec3d& x : mesh.vertices) x *= factor;
}

// A sound mesh is reported with its counts, box, volume and shape, and without a warning.
TEST(Inspect, ReportsASoundMesh) {
  const MeshReport report = inspect(box_mesh({}));
  EXPECT_EQ(report.vertices, 225u);
  EXPECT_EQ(report.tets, 768u);
  EXPECT_EQ(report.boundary_triangles, 2u * (16 + 16 + 4 * 32));
  EXPECT_EQ(report.box_min, (Vec3d{0, 0, 0}));
  EXPECT_EQ(report.box_max, (Vec3d{0.04, 0.04, 0.08}));
  EXPECT_NEAR(report.volume, 1.28e-4, 1e-16);
  EXPECT_NEAR(report.worst_mean_ratio, 0.755953, 5e-7);
  EXPECT_NEAR(report.median_mean_ratio, 0.755953, 5e-7);
  EXPECT_EQ(report.pieces, 1u);
  EXPECT_THAT(report.warnings, IsEmpty());
}

// The regular tetrahedron has mean ratio 1 and an inverted one 0, whatever their size.
TEST(Inspect, MeanRatioIsOneForTheRegularTet) {
  TetMesh mesh{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {{0, 2, 1, 3}}, {}, {}, {}};
  if (six_rest_volume(mesh, 0) < 0) std::swap(mesh.tets[0][2], mesh.tets[0][3]);
  EXPECT_NEAR(regular_mean_ratio(mesh, 0), 1.0, 1e-15);
  scale(mesh, 1e-3);
  EXPECT_NEAR(regular_mean_ratio(mesh, 0), 1.0, 1e-15);
  std::swap(mesh.tets[0][0], mesh.tets[0][1]);
  EXPECT_EQ(regular_mean_ratio(mesh, 0), 0.0);
}

// inspect lists inverted tets and leaves them; orient_and_inspect turns them and says so.
TEST(Inspect, TurnsInvertedTetsOnlyWhenAskedTo) {
  TetMesh mesh = box_mesh({});
  const TetMesh sound = mesh;
  std::swap(mesh.tets[5][2], mesh.tets[5][3]);
  std::swap(mesh.tets[17][0], mesh.tets[17][1]);
  const TetMesh before = mesh;
  EXPECT_THAT(inspect(mesh).reoriented_tets, ElementsAre(5u, 17u));
  EXPECT_THAT(inspect(mesh).warnings, ElementsAre(AllOf(HasSubstr("2 tets (5, 17) are inverted"))));
  EXPECT_EQ(mesh, before);
  const MeshReport report = orient_and_inspect(mesh);
  EXPECT_THAT(report.reoriented_tets, ElementsAre(5u, 17u));
  EXPECT_THAT(report.warnings, ElementsAre(HasSubstr("2 tets (5, 17) were inverted (negative volume): turned")));
  EXPECT_EQ(mesh.tets[5], sound.tets[5]);
  EXPECT_NO_THROW(require_valid(mesh));
  EXPECT_NEAR(report.volume, 1.28e-4, 1e-16);
}

// The same four vertices in another order are a duplicate; the first one counts as the original.
TEST(Inspect, FindsDuplicateTets) {
  TetMesh mesh = box_mesh({});
  const Tet t = mesh.tets[100];
  mesh.tets.push_back({t[1], t[2], t[0], t[3]});
  mesh.tets.push_back(t);
  const MeshReport report = inspect(mesh);
  EXPECT_THAT(report.duplicate_tets, ElementsAre(768u, 769u));
  EXPECT_THAT(report.warnings, ElementsAre(HasSubstr("2 tets (768, 769) have the same four vertices")));
  EXPECT_EQ(report.non_manifold_faces, 0u);
}

// A tet without volume or with a vertex twice is degenerate and neither inverted nor merely badly shaped.
TEST(Inspect, FindsDegenerateTets) {
  TetMesh mesh = box_mesh({});
  mesh.tets.push_back({0, 1, 2, 3});  // four vertices on a line
  mesh.tets.push_back({7, 7, 50, 90});
  const MeshReport report = orient_and_inspect(mesh);
  EXPECT_THAT(report.degenerate_tets, ElementsAre(768u, 769u));
  EXPECT_THAT(report.reoriented_tets, IsEmpty());
  EXPECT_EQ(report.worst_mean_ratio, 0.0);
  EXPECT_THAT(report.warnings, Contains(HasSubstr("2 tets (768, 769) are degenerate")));
  EXPECT_THROW(require_valid(mesh), std::invalid_argument);
}

// Flatness, not size or place, makes a tet degenerate: a sound tet of 1 µm at 0.5 m stays sound.
TEST(Inspect, SmallTetsAreNotDegenerate) {
  TetMesh mesh = one_tet();
  scale(mesh, 1e-5);
  for (Vec3d& x : mesh.vertices) x += Vec3d{0.5, 0.5, 0.5};
  EXPECT_THAT(inspect(mesh).degenerate_tets, IsEmpty());
}

// Vertices in no tet are listed and do not stretch the bounding box.
TEST(Inspect, FindsUnusedVertices) {
  TetMesh mesh = box_mesh({});
  mesh.vertices.push_back({9.0, 9.0, 9.0});
  const MeshReport report = inspect(mesh);
  EXPECT_THAT(report.unused_vertices, ElementsAre(225u));
  EXPECT_EQ(report.box_max, (Vec3d{0.04, 0.04, 0.08}));
  EXPECT_THAT(report.warnings, ElementsAre(HasSubstr("1 vertex (225) is in no tet")));
}

// Pieces are counted by shared faces: tets that touch in an edge only are two pieces.
TEST(Inspect, CountsPiecesByFaces) {
  TetMesh mesh = one_tet();
  mesh.vertices.push_back({0.0, -0.1, 0.0});
  mesh.vertices.push_back({0.0, 0.0, -0.1});
  mesh.tets.push_back({0, 1, 4, 5});  // shares the edge 0–1
  const MeshReport report = orient_and_inspect(mesh);
  EXPECT_EQ(report.pieces, 2u);
  EXPECT_EQ(report.boundary_triangles, 8u);
  EXPECT_THAT(report.warnings, Contains(HasSubstr("2 pieces that share no face (1 tet from tet 0, 1 tet from tet 1)")));
}

// Pieces feel nothing of each other, and the report says so; of two that are near enough to meet it says how near, by their boxes:
// two blocks of 20 mm over one another, 1 mm apart, in one another and 1 m apart.
TEST(Inspect, SaysThatPiecesDoNotTouch) {
  const TetMesh block = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
  const auto warning = [&](double lift) {
    TetMesh two = block;
    for (const Vec3d& x : block.vertices) two.vertices.push_back(x + Vec3d{0.0, 0.0, 0.02 + lift});
    const auto first = static_cast<std::uint32_t>(block.vertices.size());
    for (const Tet& t : block.tets) two.tets.push_back({t[0] + first, t[1] + first, t[2] + first, t[3] + first});
    const MeshReport report = inspect(two);
    EXPECT_EQ(report.pieces, 2u);
    return report.warnings.empty() ? std::string() : report.warnings.front();
  };
  for (const double lift : {0.001, -0.005, 1.0}) {
    EXPECT_THAT(warning(lift), HasSubstr("do not touch each other: no contact between them is computed")) << lift;
  }
  EXPECT_THAT(warning(0.001), HasSubstr("from tet 0 and tet 48 are 1 mm apart: WHERE THEY MEET"));
  EXPECT_THAT(warning(-0.005), HasSubstr("from tet 0 and tet 48 overlap: WHERE THEY MEET"));
  EXPECT_THAT(warning(1.0), Not(HasSubstr("WHERE THEY MEET")));
}

// A face shared by three tets is not manifold.
TEST(Inspect, FindsNonManifoldFaces) {
  TetMesh mesh = one_tet();
  mesh.vertices.push_back({0.01, 0.01, -0.1});
  mesh.vertices.push_back({0.02, 0.02, -0.2});
  mesh.tets.push_back({0, 2, 1, 4});
  mesh.tets.push_back({0, 2, 1, 5});
  const MeshReport report = orient_and_inspect(mesh);
  EXPECT_EQ(report.non_manifold_faces, 1u);
  EXPECT_EQ(report.pieces, 1u);
  EXPECT_THAT(report.warnings, Contains(HasSubstr("1 face is shared by more than two tets")));
}

// A flat tet is named with its mean ratio.
TEST(Inspect, NamesBadlyShapedTets) {
  TetMesh mesh = one_tet();
  mesh.vertices[3] = {0.03, 0.03, 1e-4};
  const MeshReport report = inspect(mesh);
  EXPECT_LT(report.worst_mean_ratio, 0.05);
  EXPECT_THAT(report.warnings,
              ElementsAre(AllOf(HasSubstr("1 tet (0) has a mean ratio below 0.05"), HasSubstr("tet 0)"))));
}

// An organ of 80 m is taken for millimetres and one of 80 µm for scaled twice; between, nothing is said.
TEST(Inspect, SuspectsTheUnit) {
  TetMesh mesh = box_mesh({});
  scale(mesh, 1000.0);
  EXPECT_THAT(inspect(mesh).warnings, ElementsAre(AllOf(HasSubstr("80 m"), HasSubstr("scale = 0.001"))));
  scale(mesh, 1e-6);
  EXPECT_THAT(inspect(mesh).warnings, ElementsAre(AllOf(HasSubstr("8e-05 m"), HasSubstr("scale = 1000"))));
}

// An empty mesh is reported, not refused.
TEST(Inspect, ReportsAnEmptyMesh) {
  const MeshReport report = inspect(TetMesh{});
  EXPECT_EQ(report.tets, 0u);
  EXPECT_THAT(report.warnings, ElementsAre(HasSubstr("no tetrahedra")));
}

// The report does not depend on the order of the tets.
TEST(Inspect, IsIndependentOfOrder) {
  TetMesh mesh = cylinder_mesh({});
  const MeshReport forward = inspect(mesh);
  std::reverse(mesh.tets.begin(), mesh.tets.end());
  const MeshReport backward = inspect(mesh);
  EXPECT_EQ(forward.boundary_triangles, backward.boundary_triangles);
  EXPECT_EQ(forward.median_mean_ratio, backward.median_mean_ratio);
  EXPECT_EQ(forward.pieces, backward.pieces);
  EXPECT_NEAR(forward.volume, backward.volume, 1e-17);
}

struct Invalid {
  const char* what;
  void (*spoil)(TetMesh&);
  const char* fragment;
};

class RequireValid : public testing::TestWithParam<Invalid> {};

// Every precondition of a mesh is refused with the first index at fault and the limit.
TEST_P(RequireValid, NamesTheFault) {
  TetMesh mesh = box_mesh({});
  GetParam().spoil(mesh);
  try {
    require_valid(mesh);
    FAIL() << "accepted a mesh with " << GetParam().what;
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr(GetParam().fragment));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Faults, RequireValid,
    testing::Values(Invalid{"no tets", [](TetMesh& m) { m.tets.clear(); }, "no tetrahedra"},
                    Invalid{"a vertex number too high", [](TetMesh& m) { m.tets[3][1] = 225; },
                            "refers to vertex 225, but the mesh has 225 vertices"},
                    Invalid{"too few regions",
                            [](TetMesh& m) {
                              m.regions = {1, 2};
                            },
                            "regions has 2 entries for 768 tets"},
                    Invalid{"a coordinate that is not a number", [](TetMesh& m) { m.vertices[8].y = std::nan(""); },
                            "vertex 8 is at (0.03, nan, 0)"},
                    Invalid{"an inverted tet", [](TetMesh& m) { std::swap(m.tets[9][0], m.tets[9][1]); }, "tet 9 "},
                    Invalid{"a flat tet",
                            [](TetMesh& m) {
                              m.tets[9] = {0, 1, 2, 3};
                            },
                            "tet 9 (vertices 0, 1, 2, 3) has no volume"},
                    Invalid{"a set with an unknown vertex", [](TetMesh& m) { m.vertex_sets["tip"] = {300}; },
                            "vertex set \"tip\" holds vertex 300"},
                    Invalid{"an unsorted set",
                            [](TetMesh& m) {
                              m.vertex_sets["tip"] = {4, 3};
                            },
                            "vertex set \"tip\" is not sorted"},
                    Invalid{"a set with a vertex twice",
                            [](TetMesh& m) {
                              m.vertex_sets["tip"] = {4, 4};
                            },
                            "4 follows 4"}));

// inspect and boundary_triangles refuse indices that they cannot follow.
TEST(Inspect, RefusesUnknownVertices) {
  TetMesh mesh = one_tet();
  mesh.tets[0][3] = 4;
  EXPECT_THROW(inspect(mesh), std::invalid_argument);
  EXPECT_THROW(orient_and_inspect(mesh), std::invalid_argument);
  EXPECT_THROW(boundary_triangles(mesh), std::invalid_argument);
}

}  // namespace
}  // namespace glisson
