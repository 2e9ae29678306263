// Graded meshes: edges are those asked for at each place, tets fit together between coarse and fine, angles, volumes and the step
// are those of meshes of one edge.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "glisson/liver.h"
#include "glisson/simulation/mesh_step.h"
#include "mesh_checks.h"
#include "mesher/lattice/cell_octree.h"
#include "mesher/lattice/graded_lattice.h"
#include "random_body.h"

namespace glisson {
namespace graded_mesh {

using lattice::CellOctree;
using lattice::RegionFields;
using lattice::SizeField;
using lattice::TetComplex;
using test::Face;
using test::RandomShapes;
using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

/// Of that of regular tets of the edge asked for at each place.
constexpr double kLeastStep = 0.3;

// Cubes that share a corner differ by one level at most, cover the box, and split where they were told.
TEST(CellOctree, IsBalanced) {
  CellOctree tree({2, 3, 2}, 5);
  for (std::uint32_t at = 0; tree.cell(at).level > 0; at = tree.cell(at).children + 7) tree.split(at);
  tree.balance();
  double volume = 0.0;
  for (const std::uint32_t leaf : tree.leaves()) {
    const lattice::OctreeCell& cell = tree.cell(leaf);
    volume += std::pow(cell.side(), 3);
    for (int n = 0; n < 27; ++n) {
      const auto at = CellOctree::beside(cell, {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1});
      const std::uint32_t other = tree.find(at, 0);
      if (other != CellOctree::kNowhere) {
        EXPECT_LE(tree.cell(other).level, cell.level + 1);  // seen from the smaller of two
      }
    }
  }
  EXPECT_EQ(volume, 12.0 * 32768.0);
  EXPECT_EQ(tree.find({-1, 0, 0}, 0), CellOctree::kNowhere);
  EXPECT_EQ(tree.find({0, 96, 0}, 0), CellOctree::kNowhere);
}

// Before a surface touches it, the lattice fills the space between levels without gaps, and all its angles are 45° to 120°.
TEST(GradedLattice, FitsTogetherBetweenLevels) {
  const std::vector<BodyRegion> regions{region_of("box", BoxShape{{}, {2, 2, 2}})};
  const std::vector<MeshSize> finer{{.edge = 0.03, .path = {{{-0.3, 0.1, 0.2}}, {{0.5, -0.4, 0.1}}}, .within = 0.02},
                                    {.edge = 0.06, .path = {{{0.1, 0.7, -0.6}}}}};
  const SizeField sizes(regions, {.edge = 0.25, .sizes = finer, .growth = 0.8});
  TetComplex complex;
  fill_graded_lattice(RegionFields(regions, sizes), sizes, 1000000, complex);
  TetMesh mesh;
  mesh.vertices = complex.points;
  mesh.tets = complex.tets;
  mesh.regions.assign(mesh.tets.size(), 1);
  test::expect_conforming(mesh);
  double low = 180.0, high = 0.0;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    for (const double angle : dihedral_angles(mesh, t)) low = std::min(low, angle), high = std::max(high, angle);
  }
  EXPECT_NEAR(low, 45.0, 1e-6);
  EXPECT_NEAR(high, 120.0, 1e-6);
  // No face of one tet alone has its middle inside the box: there would be a gap.
  for (const Face& f : test::faces_of(mesh)) {
    if (f.regions.size() == 2) continue;
    const Vec3d middle =
        (mesh.vertices[f.corners[0]] + mesh.vertices[f.corners[1]] + mesh.vertices[f.corners[2]]) * (1.0 / 3.0);
    EXPECT_GE(std::max({std::abs(middle.x), std::abs(middle.y), std::abs(middle.z)}), 1.0 - 1e-9);
  }
}

/// Length of a tet's edges, mean [m].
double mean_edge(const TetMesh& mesh, std::size_t t) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      sum += norm(mesh.vertices[mesh.tets[t][i]] - mesh.vertices[mesh.tets[t][j]]) / 6.0;
    }
  }
  return sum;
}
Vec3d centre_of(const TetMesh& mesh, std::size_t t) {
  Vec3d centre{};
  for (const std::uint32_t v : mesh.tets[t]) centre += mesh.vertices[v] * 0.25;
  return centre;
}

struct GradedBody {
  std::vector<BodyRegion> regions;
  RegionMeshOptions options;
};

/// A random body with one or two sizes at random places.
GradedBody random_graded_body(unsigned seed) {
  GradedBody body{RandomShapes(seed).body(), {.edge = 0.25}};
  RandomShapes random(seed + 1000);
  const int count = 1 + random.below(2);
  for (int i = 0; i < count; ++i) {
    MeshSize size{.edge = std::array{0.12, 0.06, 0.09}[static_cast<std::size_t>(random.below(3))],
                  .within = random.between(0, 0.1)};
    const auto region = static_cast<std::size_t>(random.below(static_cast<int>(body.regions.size())));
    const int kind = random.below(3);
    if (kind == 0) size.near = body.regions[region].name;
    if (kind == 1) size.surface = body.regions[region].name;
    if (kind == 2) size.path = {{random.point(1)}, {random.point(1)}};
    if (kind != 2) size.edge = std::max(size.edge, 0.09);
    body.options.sizes.push_back(size);
  }
  body.options.growth = random.between(0.2, 0.6);
  return body;
}

/// Distance of interfaces from the surfaces that they stand for, in edges asked for there, ascending.
std::vector<double> interface_distances(const TetMesh& mesh, const GradedBody& body) {
  const SizeField sizes(body.regions, body.options);
  std::vector<double> distances;
  for (const Face& f : test::faces_of(mesh)) {
    if (f.regions.size() == 2 && f.regions[0] == f.regions[1]) continue;
    const int first = f.regions.size() == 2 ? std::min(f.regions[0], f.regions[1]) : f.regions[0];
    const auto off = [&](const Vec3d& p) {
      double least = std::abs(body.regions[static_cast<std::size_t>(first) - 1].distance(p));
      for (std::size_t k = 0; f.regions.size() == 1 && k + 1 < static_cast<std::size_t>(first); ++k) {  // a hole's
        if (body.regions[k].hole) least = std::min(least, std::abs(body.regions[k].distance(p)));
      }
      return least / sizes.at(p);
    };
    const Vec3d &a = mesh.vertices[f.corners[0]], &b = mesh.vertices[f.corners[1]], &c = mesh.vertices[f.corners[2]];
    for (const Vec3d& p : {a, b, c, (a + b + c) * (1.0 / 3.0)}) distances.push_back(off(p));
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

/// Random bodies with random sizes, ten a test.
class RandomGradedBodies : public testing::TestWithParam<unsigned> {};

// Wherever edges change, tets fit together, angles are those of meshes of one edge, 95 % of the interfaces are within a tenth of an edge
// asked for there, and the step is no less than 0.3 of that of regular tets of that edge (0.329 measured, 0.50 in the middle).
TEST_P(RandomGradedBodies, AreConformingAndOfGoodShape) {
  for (unsigned seed = 10 * GetParam(); seed < 10 * GetParam() + 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const GradedBody body = random_graded_body(seed);
    try {
      const RegionMesh made = mesh_regions(body.regions, body.options);
      test::expect_conforming(made.mesh);
      EXPECT_GE(made.report.min_dihedral_deg, 10.0);
      EXPECT_LE(made.report.max_dihedral_deg, 165.0);
      EXPECT_TRUE(made.report.poor_tets.empty());
      const std::vector<double> off = interface_distances(made.mesh, body);
      const std::vector<double> edges = edges_asked(made.mesh, body.regions, body.options);
      EXPECT_LT(off[off.size() * 95 / 100], 0.1);
      EXPECT_GE(relative_stable_step(made.mesh, edges), kLeastStep);
    } catch (const std::invalid_argument& error) {  // a region that others cover
      EXPECT_THAT(error.what(), HasSubstr("earlier regions cover it"));
    }
  }
}
INSTANTIATE_TEST_SUITE_P(First, RandomGradedBodies, testing::Range(0u, 4u));  // long; verify: 2, 3
INSTANTIATE_TEST_SUITE_P(All, RandomGradedBodies, testing::Range(4u, 30u));   // verify

/// A ball with a core of another region, finer there and along a line.
GradedBody ball_with_core() {
  return {{region_of("core", BallShape{{0.01, 0, 0}, 0.01}), region_of("ball", BallShape{{}, 0.05})},
          {.edge = 0.008,
           .sizes = {{.edge = 0.002, .near = "core", .within = 0.002},
                     {.edge = 0.004, .path = {{{0.01, 0, 0}}, {{0.01, 0, 0.06}}}, .within = 0.002}}}};
}

// Edges have the mean asked for where they are shortest, and that of the mesh far from there; in between they grow as they should,
// to the factor of √2 by which cubes differ.
TEST(GradedMesh, HasTheEdgesAskedFor) {
  const GradedBody body = ball_with_core();
  const RegionMesh made = mesh_regions(body.regions, body.options);
  const std::vector<double> asked = edges_asked(made.mesh, body.regions, body.options);
  double core = 0.0, far = 0.0;
  std::size_t core_count = 0, far_count = 0;
  for (std::size_t t = 0; t < made.mesh.tets.size(); ++t) {
    const double edge = mean_edge(made.mesh, t);
    if (norm(centre_of(made.mesh, t) - Vec3d{0.01, 0, 0}) < 0.01) core += edge, ++core_count;
    if (asked[t] == body.options.edge) far += edge, ++far_count;
    EXPECT_LT(edge, 2.0 * asked[t]);
    EXPECT_GT(edge, 0.4 * asked[t]);
  }
  EXPECT_NEAR(core / static_cast<double>(core_count), 0.002, 0.0001);
  EXPECT_NEAR(far / static_cast<double>(far_count), 0.008, 0.0008);
  EXPECT_EQ(*std::min_element(asked.begin(), asked.end()), 0.002);
}

// Regions keep their volumes where the edge changes on their surface, as with one edge: a ball to two thousandths.
TEST(GradedMesh, KeepsVolumes) {
  const double exact = 4.0 / 3.0 * kPi * 0.05 * 0.05 * 0.05;
  for (const double fine : {0.005, 0.0025}) {
    const RegionMesh made =
        mesh_regions({region_of("ball", BallShape{{}, 0.05})},
                     {.edge = 0.01, .sizes = {{.edge = fine, .path = {{{0, 0, 0.05}}}, .within = 0.01}}});
    EXPECT_NEAR(made.report.regions[0].volume, exact, 2e-3 * exact);
  }
  const RegionMesh made = mesh_regions(ball_with_core().regions, ball_with_core().options);
  EXPECT_NEAR(made.report.regions[0].volume, 4.0 / 3.0 * kPi * 1e-6, 2e-3 * 4.0 / 3.0 * kPi * 1e-6);
}

// A mesh whose sizes all ask for its half is that of half the edge in shape: as many tets, to the lattice's other place.
TEST(GradedMesh, ThatIsFineEverywhereIsThatOfItsEdge) {
  const std::vector<BodyRegion> ball{region_of("ball", BallShape{{}, 0.05})};
  const auto graded = mesh_regions(ball, {.edge = 0.016, .sizes = {{.edge = 0.008, .near = "ball"}}});
  const auto plain = mesh_regions(ball, {.edge = 0.008});
  EXPECT_NEAR(static_cast<double>(graded.mesh.tets.size()), static_cast<double>(plain.mesh.tets.size()),
              0.05 * static_cast<double>(plain.mesh.tets.size()));
}

// A size that is not shorter than the edge of the mesh changes no byte.
TEST(GradedMesh, IsAsFineAsItsEdgeAtLeast) {
  const std::vector<BodyRegion> ball{region_of("ball", BallShape{{}, 0.05})};
  EXPECT_EQ(mesh_regions(ball, {.edge = 0.01, .sizes = {{.edge = 0.01, .near = "ball"}}}).mesh,
            mesh_regions(ball, {.edge = 0.01}).mesh);
}

// The same input gives the same bytes.
TEST(GradedMesh, IsTheSameEachTime) {  // long
  const GradedBody body = random_graded_body(6);
  EXPECT_EQ(mesh_regions(body.regions, body.options).mesh, mesh_regions(body.regions, body.options).mesh);
}

// The relative step is that of the edge where all tets were asked for the same, and grows with what they were asked for.
TEST(GradedMesh, HasARelativeStep) {
  const RegionMesh made = mesh_regions({region_of("ball", BallShape{{}, 0.05})}, {.edge = 0.012});
  const std::vector<double> same(made.mesh.tets.size(), 0.012), twice(made.mesh.tets.size(), 0.024);
  const double step = relative_stable_step(made.mesh, 0.012);
  EXPECT_NEAR(relative_stable_step(made.mesh, same), step, 1e-3 * step);
  EXPECT_NEAR(relative_stable_step(made.mesh, twice), 0.5 * step, 1e-3 * step);
  EXPECT_THROW(relative_stable_step(made.mesh, std::vector<double>(3, 0.01)), std::invalid_argument);
}

std::string graded_refusal(const RegionMeshOptions& options) {
  try {
    mesh_regions({region_of("ball", BallShape{{}, 0.05})}, options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

// Sizes that cannot be are named with their values, and the way out.
TEST(GradedMesh, RefusesSizesThatCannotBe) {
  using testing::AllOf;
  EXPECT_THAT(graded_refusal({.edge = 0.01, .sizes = {{.edge = 0.002, .near = "bal"}}}),
              AllOf(HasSubstr("size 0"), HasSubstr("near"), HasSubstr("\"bal\""), HasSubstr("mean \"ball\"")));
  EXPECT_THAT(
      graded_refusal({.edge = 0.01, .sizes = {{.edge = 0.002, .near = "ball"}, {.edge = 1e-6, .near = "ball"}}}),
      AllOf(HasSubstr("size 1"), HasSubstr("0.001 mm"), HasSubstr("0.0391 or more")));
  EXPECT_THAT(graded_refusal({.edge = 0.01, .sizes = {{.edge = 0.002}}}), HasSubstr("names no place"));
  EXPECT_THAT(graded_refusal({.edge = 0.01, .sizes = {{.edge = 0.002, .near = "ball", .path = {{{0, 0, 0}}}}}}),
              HasSubstr("more than one place"));
  EXPECT_THAT(graded_refusal({.edge = 0.01, .sizes = {{.edge = 0.002, .near = "ball", .per_radius = 2}}}),
              HasSubstr("without `surface`"));
  EXPECT_THAT(graded_refusal({.edge = 0.01, .sizes = {{.edge = 0.002, .near = "ball", .within = -1}}}),
              AllOf(HasSubstr("within"), HasSubstr("0 to 10000")));
  EXPECT_THAT(graded_refusal({.edge = 0.01, .sizes = {{.edge = 0.002, .near = "ball"}}, .growth = 3}),
              AllOf(HasSubstr("growth = 3"), HasSubstr("0.05 to 1")));
  EXPECT_THAT(graded_refusal({.edge = 0.01, .max_tets = 0}), HasSubstr("max_tets = 0"));
  EXPECT_THAT(graded_refusal({.edge = 0.01, .max_tets = 10000, .sizes = {{.edge = 0.001, .near = "ball"}}}),
              AllOf(HasSubstr("more than 10000 tets"), HasSubstr("longer edges")));
}

// The work can be stopped.
TEST(GradedMesh, CanBeStopped) {
  GradedBody body = ball_with_core();
  body.options.progress = [](double part) { return part < 0.3; };
  EXPECT_THROW(mesh_regions(body.regions, body.options), MeshingStopped);
}

// Edges follow curvature: an ellipsoid is finer at its tips, where the radius is that of its curvature, a box at its edges alone.
TEST(GradedMesh, FollowsCurvature) {
  // a = 50, b = 20 mm: R = b²/a = 8 mm at the tips, and at the waist the smaller of 20 (around) and a²/b = 125 mm.
  const std::vector<BodyRegion> egg{region_of("egg", EllipsoidShape{{}, {0.05, 0.02, 0.02}})};
  const RegionMeshOptions options{
      .edge = 0.016, .sizes = {{.edge = 0.001, .surface = "egg", .per_radius = 2}}, .growth = 0.5};
  const SizeField sizes(egg, options);
  // The surface is sampled half an edge apart: the next sample is up to 1.4 mm away, and edges grow by half of that.
  EXPECT_GT(sizes.at({0.05, 0, 0}), 0.0039);
  EXPECT_LT(sizes.at({0.05, 0, 0}), 0.0050);
  EXPECT_NEAR(sizes.at({0, 0.02, 0}), 0.010, 0.0015);
  const RegionMesh made = mesh_regions(egg, options);
  test::expect_conforming(made.mesh);
  EXPECT_TRUE(made.report.poor_tets.empty());

  const std::vector<BodyRegion> box{region_of("box", BoxShape{{}, {0.1, 0.08, 0.06}})};
  const SizeField at_box(box,
                         {.edge = 0.01, .sizes = {{.edge = 0.002, .surface = "box", .per_radius = 2}}, .growth = 0.5});
  EXPECT_NEAR(at_box.at({0.05, 0.04, 0.01}), 0.002, 0.001);  // on an edge
  EXPECT_EQ(at_box.at({0.05, 0.0, 0.0}), 0.01);              // in the middle of a face
  EXPECT_EQ(at_box.at({0.0, 0.0, 0.0}), 0.01);
}

// A liver that is fine in its tumour has the tumour's volume, and less tets than one that is fine throughout.
TEST(GradedMesh, OfTheLiverIsFineInTheTumour) {
  LiverOptions options;
  options.edge = 0.012;
  options.sizes = {{.edge = 0.003, .near = "tumour", .within = 0.003}};
  const RegionMesh made = liver_mesh(options);
  test::expect_conforming(made.mesh);
  EXPECT_TRUE(made.report.poor_tets.empty());
  EXPECT_LT(made.mesh.tets.size(), 40000u);
  const double exact = 4.0 / 3.0 * kPi * std::pow(0.012, 3);
  EXPECT_NEAR(made.report.regions[0].volume, exact, 2e-3 * exact);
}

}  // namespace graded_mesh
}  // namespace glisson
