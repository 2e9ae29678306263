// Meshes of several regions: conforming, of good shape, where the surfaces are, and of the volume that the shapes have.
#include "glisson/region_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <map>
#include <numbers>

#include "glisson/liver.h"
#include "glisson/simulation/mesh_step.h"
#include "mesh_checks.h"
#include "random_body.h"

namespace glisson {
namespace {

using test::expect_conforming;
using test::Face;
using test::faces_of;
using test::least_altitude;
using test::RandomShapes;
using testing::AllOf;
using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

/// Angles between 10° and 165°, and no altitude that would shorten the stable step below 0.3 of that of regular tets (the
/// last hundredths are those of a tet that was left when its angles were good).
void expect_good_shapes(const RegionMesh& made, double edge) {
  EXPECT_GE(least_altitude(made.mesh, edge), 0.29);
  EXPECT_GE(made.report.min_dihedral_deg, 10.0);
  EXPECT_LE(made.report.max_dihedral_deg, 165.0);
  EXPECT_TRUE(made.report.poor_tets.empty());
}

/// Distance of an interface's faces, at their centres and corners, from the surface that they stand for [edges].
std::vector<double> interface_distances(const TetMesh& mesh, const std::vector<BodyRegion>& regions, double edge) {
  std::vector<double> distances;
  for (const Face& f : faces_of(mesh)) {
    if (f.regions.size() == 2 && f.regions[0] == f.regions[1]) continue;
    const int first = f.regions.size() == 2 ? std::min(f.regions[0], f.regions[1]) : f.regions[0];
    const auto off = [&](const Vec3d& p) {
      double least = std::abs(regions[static_cast<std::size_t>(first) - 1].distance(p));
      for (int k = 0; f.regions.size() == 1 && k + 1 < first; ++k) {  // a hole's
        const BodyRegion& r = regions[static_cast<std::size_t>(k)];
        if (r.hole) least = std::min(least, std::abs(r.distance(p)));
      }
      return least / edge;
    };
    const Vec3d &a = mesh.vertices[f.corners[0]], &b = mesh.vertices[f.corners[1]], &c = mesh.vertices[f.corners[2]];
    distances.push_back(off((a + b + c) * (1.0 / 3.0)));
    for (const Vec3d& p : {a, b, c}) distances.push_back(off(p));
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

double p95(const std::vector<double>& sorted) { return sorted[sorted.size() * 95 / 100]; }

RegionMesh mesh_of(const Solid& solid, double edge) { return mesh_regions({region_of("body", solid)}, {edge}); }

/// Undamped, over that of a regular tet of the edge asked for.
constexpr double kLeastStep = 0.4;

/// Random bodies, ten a test.
class RandomBodies : public testing::TestWithParam<unsigned> {};

// A random body is meshed conformingly, every dihedral angle lies between 10° and 165°, 95 % of its interfaces are within a tenth of an
// edge of the surfaces, the stable step is no less than 0.4 of that of a regular tet (0.516 measured), and it takes no more than 1 ms of
// the processor a tet, twenty times the mean on the machine it was written on.
TEST_P(RandomBodies, AreConformingAndOfGoodShape) {
  constexpr double kEdge = 0.15;
  for (unsigned i = 0; i < 10; ++i) {
    const unsigned seed = 10 * GetParam() + i;
    SCOPED_TRACE("seed " + std::to_string(seed));
    const std::vector<BodyRegion> regions = RandomShapes(seed).body();
    try {
      const std::clock_t start = std::clock();
      const RegionMesh made = mesh_regions(regions, {kEdge});
      const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
      expect_conforming(made.mesh);
      expect_good_shapes(made, kEdge);
      EXPECT_LT(p95(interface_distances(made.mesh, regions, kEdge)), 0.1);
      EXPECT_GE(relative_stable_step(made.mesh, kEdge), kLeastStep);
      EXPECT_LT(seconds, 1.0 + 1e-3 * static_cast<double>(made.mesh.tets.size()));
    } catch (const std::invalid_argument& error) {  // a region that others cover
      EXPECT_THAT(error.what(), HasSubstr("earlier regions cover it"));
    }
  }
}
INSTANTIATE_TEST_SUITE_P(First, RandomBodies, testing::Range(0u, 4u));  // long: 1; verify: 2, 3
INSTANTIATE_TEST_SUITE_P(All, RandomBodies, testing::Range(4u, 30u));   // verify

// A regular tet has the stable step that the others are held against, by its matrix as by its formula; one of half the edge has half.
TEST(RelativeStableStep, IsOneOfARegularTet) {
  const double a = 0.01 / std::sqrt(8.0);
  TetMesh tet;
  tet.vertices = {{a, a, a}, {-a, a, -a}, {a, -a, -a}, {-a, -a, a}};
  tet.tets = {{0, 1, 2, 3}};
  ASSERT_GT(six_rest_volume(tet, 0), 0.0);
  EXPECT_NEAR(relative_stable_step(tet, 0.01), 1.0, 1e-4);
  EXPECT_NEAR(relative_stable_step(tet, 0.02), 0.5, 1e-4);
  EXPECT_THROW(relative_stable_step(tet, 0.0), std::invalid_argument);
}

struct Known {
  const char* name;
  Solid solid;
  double volume, across;
};
std::vector<Known> known_bodies() {
  const double cap = 0.05;  // of balls of radius 0.1 whose centres are 0.1 apart
  return {
      {"ball", BallShape{{}, 0.05}, 4.0 / 3.0 * kPi * 0.05 * 0.05 * 0.05, 0.1},
      {"ellipsoid", EllipsoidShape{{}, {0.1, 0.07, 0.05}}, 4.0 / 3.0 * kPi * 0.1 * 0.07 * 0.05, 0.1},
      {"torus", TorusShape{{}, {0, 0, 1}, 0.06, 0.03}, 2.0 * kPi * kPi * 0.06 * 0.03 * 0.03, 0.06},
      {"lens", intersect({BallShape{{0, 0, 0.05}, 0.1}, BallShape{{0, 0, -0.05}, 0.1}}),
       2.0 / 3.0 * kPi * cap * cap * (0.3 - cap), 2 * cap},
      {"tube", TubeShape{{{{0, 0, 0}, 0.03}, {{0, 0, 0.12}, 0.03}}},
       kPi * 0.03 * 0.03 * 0.12 + 4.0 / 3.0 * kPi * 0.03 * 0.03 * 0.03, 0.06},
      {"box", Solid(BoxShape{{}, {0.1, 0.08, 0.06}}).placed({"", 1.0, {1, 2, 3}, 40.0, {}}), 0.1 * 0.08 * 0.06, 0.06},
      {"cylinder", CylinderShape{{}, {0, 0, 0.1}, 0.05}, kPi * 0.05 * 0.05 * 0.1, 0.1},
  };
}

// At ten edges across a body's volume is within half a percent of the exact one, where vertices on a ball would lose 1.5 %,
// and twice as fine at least three times as near (second order is four, less what chance leaves of a small error).
TEST(RegionMesh, KeepsVolumes) {  // long
  for (const Known& body : known_bodies()) {
    SCOPED_TRACE(body.name);
    const double coarse = mesh_of(body.solid, body.across / 10).report.regions[0].volume / body.volume - 1.0;
    const double fine = mesh_of(body.solid, body.across / 20).report.regions[0].volume / body.volume - 1.0;
    std::printf("%s %.3f %% %.3f %%\n", body.name, 100.0 * coarse, 100.0 * fine);
    EXPECT_LT(std::abs(coarse), 1.5e-3);
    EXPECT_LT(std::abs(fine), std::max(std::abs(coarse) / 3.0, 5e-4));
  }
}

// Interfaces are where the surfaces are: 95 % of their points within a tenth of an edge. A body of shells has them inside, too.
TEST(RegionMesh, PutsInterfacesOntoSurfaces) {  // long
  for (const Known& body : known_bodies()) {
    SCOPED_TRACE(body.name);
    const double edge = body.across / 10;
    const std::vector<BodyRegion> regions{region_of("body", body.solid)};
    EXPECT_LT(p95(interface_distances(mesh_regions(regions, {edge}).mesh, regions, edge)), 0.05);
  }
  const std::vector<BodyRegion> shells{region_of("core", BallShape{{0.01, 0, 0}, 0.02}),
                                       region_of("vessel", TubeShape{{{{-0.06, 0, 0}, 0.008}, {{0.06, 0, 0}, 0.008}}}),
                                       region_of("body", BallShape{{}, 0.05})};
  const RegionMesh made = mesh_regions(shells, {0.004});
  expect_conforming(made.mesh);
  expect_good_shapes(made, 0.004);
  EXPECT_LT(p95(interface_distances(made.mesh, shells, 0.004)), 0.1);
  EXPECT_NEAR(made.report.regions[0].volume, 4.0 / 3.0 * kPi * 8e-6, 0.01 * 4.0 / 3.0 * kPi * 8e-6);
}

// And surfaces are where the interfaces are: no point of a surface is further than half an edge from a vertex of the mesh's
// surface than faces of that edge allow.
TEST(RegionMesh, LeavesNoPartOfASurfaceOut) {
  const double edge = 0.01, radius = 0.05;
  const RegionMesh made = mesh_of(BallShape{{}, radius}, edge);
  std::vector<std::uint32_t> surface;
  for (const Triangle& t : boundary_triangles(made.mesh)) surface.insert(surface.end(), t.begin(), t.end());
  RandomShapes random(3);
  for (int i = 0; i < 500; ++i) {
    const Vec3d p = unit(random.point(1)) * radius;
    double nearest = 1.0;
    for (const std::uint32_t v : surface) nearest = std::min(nearest, norm(made.mesh.vertices[v] - p));
    EXPECT_LT(nearest, edge);
  }
}

// The corners of a box are vertices of its mesh, and its edges are followed: no vertex of the surface is off the box.
TEST(RegionMesh, KeepsSharpEdges) {
  const Vec3d size{0.1, 0.08, 0.06};
  const double edge = 0.01;
  const Solid box = BoxShape{{0.003, 0.001, 0.002}, size};
  const RegionMesh made = mesh_of(box, edge);
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d p{0.003 + (corner & 1 ? 0.5 : -0.5) * size.x, 0.001 + (corner & 2 ? 0.5 : -0.5) * size.y,
                  0.002 + (corner & 4 ? 0.5 : -0.5) * size.z};
    double nearest = 1.0;
    for (const Vec3d& v : made.mesh.vertices) nearest = std::min(nearest, norm(v - p));
    EXPECT_LT(nearest, 0.02 * edge) << "corner " << corner;
  }
  const std::vector<double> off = interface_distances(made.mesh, {region_of("box", box)}, edge);
  EXPECT_LT(off.back(), 0.2);  // where a face bridges an edge near its end
}

/// The tets of a region as a mesh of its own.
TetMesh part_of(const TetMesh& mesh, int region) {
  TetMesh part;
  part.vertices = mesh.vertices;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.regions[t] == region) part.tets.push_back(mesh.tets[t]);
  }
  return part;
}

// What is two edges thick is kept whole: a shell without holes, and a vessel in one piece inside another region.
TEST(RegionMesh, KeepsWhatIsTwoEdgesThick) {
  const double edge = 0.005;
  const RegionMesh shell = mesh_of(subtract(BallShape{{}, 0.05}, {Solid(BallShape{{}, 0.04})}), edge);
  const double exact = 4.0 / 3.0 * kPi * (125e-6 - 64e-6);
  EXPECT_NEAR(shell.report.regions[0].volume, exact, 0.01 * exact);
  EXPECT_EQ(inspect(shell.mesh).pieces, 1u);
  std::size_t inside = 0;
  for (const Triangle& t : boundary_triangles(shell.mesh)) inside += norm(shell.mesh.vertices[t[0]]) < 0.045;
  // Euler's formula for a closed surface without handles, 2 = V − E + F = V − F/2, holds for the inner wall.
  std::vector<std::uint32_t> corners;
  for (const Triangle& t : boundary_triangles(shell.mesh)) {
    if (norm(shell.mesh.vertices[t[0]]) < 0.045) corners.insert(corners.end(), t.begin(), t.end());
  }
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  EXPECT_EQ(2 * corners.size(), inside + 4);

  const Solid vessel = TubeShape{{{{-0.04, 0, 0}, edge}, {{0, 0.02, 0.01}, edge}, {{0.04, -0.01, 0}, edge}}};
  const RegionMesh body = mesh_regions({region_of("vessel", vessel), region_of("body", BallShape{{}, 0.06})}, {edge});
  EXPECT_EQ(inspect(part_of(body.mesh, 1)).pieces, 1u);
}

// The same body gives the same bytes.
TEST(RegionMesh, IsTheSameEachTime) {
  const std::vector<BodyRegion> regions = RandomShapes(8).body();
  EXPECT_EQ(mesh_regions(regions, {0.2}).mesh, mesh_regions(regions, {0.2}).mesh);
}

// A hole stays empty, and takes precedence like a region.
TEST(RegionMesh, LeavesHolesEmpty) {
  const Solid body = BallShape{{}, 0.05}, hole = BallShape{{}, 0.03};
  const RegionMesh made = mesh_regions({region_of("hole", hole, true), region_of("wall", body)}, {0.005});
  ASSERT_EQ(made.report.regions.size(), 1u);
  EXPECT_EQ(made.report.regions[0].number, 2);
  const double exact = 4.0 / 3.0 * kPi * (125e-6 - 27e-6);
  EXPECT_NEAR(made.report.regions[0].volume, exact, 0.005 * exact);
  for (const Vec3d& v : made.mesh.vertices) EXPECT_GT(norm(v), 0.028);
}

// The mean edge is the one asked for, to some percent.
TEST(RegionMesh, HasTheMeanEdgeAskedFor) {
  const RegionMesh made = mesh_of(BallShape{{}, 0.05}, 0.008);
  double sum = 0.0;
  for (const Tet& t : made.mesh.tets) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) sum += norm(made.mesh.vertices[t[i]] - made.mesh.vertices[t[j]]);
    }
  }
  EXPECT_NEAR(sum / (6.0 * static_cast<double>(made.mesh.tets.size())), 0.008, 0.05 * 0.008);
}

std::string refusal(const std::vector<BodyRegion>& regions, const RegionMeshOptions& options) {
  try {
    mesh_regions(regions, options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

// What cannot be meshed is named, with the way out.
TEST(RegionMesh, RefusesWhatItCannotMesh) {
  const BodyRegion ball = region_of("ball", BallShape{{}, 0.01});
  EXPECT_THAT(refusal({}, {0.01}), HasSubstr("no region to fill"));
  EXPECT_THAT(refusal({ball}, {0.0}), AllOf(HasSubstr("edge [m] = 0"), HasSubstr("> 0")));
  EXPECT_THAT(refusal({ball}, {0.05}), AllOf(HasSubstr("\"ball\""), HasSubstr("smaller edge")));
  EXPECT_THAT(refusal({ball}, {1e-9}), HasSubstr("longer edge"));
  EXPECT_THAT(refusal({ball}, {0.0005, 1000}),
              AllOf(HasSubstr("an edge of 0.5 mm makes some 320000 tets"), HasSubstr("at most 1000"),
                    HasSubstr("give an edge of"), HasSubstr("raise max_tets")));
  const Solid nothing = intersect({BallShape{{-1, 0, 0}, 0.1}, BallShape{{1, 0, 0}, 0.1}});
  EXPECT_THAT(refusal({region_of("nothing", nothing)}, {0.01}),
              AllOf(HasSubstr("\"nothing\""), HasSubstr("leave nothing")));
  EXPECT_THAT(refusal({ball, region_of("inner", BallShape{{}, 0.005})}, {0.002}),
              HasSubstr("earlier regions cover it; name it before them"));
  const Solid itself = subtract(BallShape{{}, 0.01}, {Solid(BallShape{{}, 0.01})});
  EXPECT_THAT(refusal({region_of("itself", itself)}, {0.002}),
              AllOf(HasSubstr("leave nothing"), HasSubstr("20 × 20 × 20 mm")));
}

// The work can be followed and stopped.
TEST(RegionMesh, CanBeStopped) {
  double last = 0.0;
  RegionMeshOptions options{0.005};
  options.progress = [&](double part) {
    EXPECT_GE(part, last);
    last = part;
    return part < 0.3;
  };
  EXPECT_THROW(mesh_regions({region_of("ball", BallShape{{}, 0.05})}, options), MeshingStopped);
}

// A slow function is not asked for millions of values before somebody can stop the work, or before more tets are refused than are
// allowed.
TEST(RegionMesh, CanBeStoppedWhereFunctionsAreSlow) {
  std::size_t asked = 0;
  const Solid ball(
      [&asked](const Vec3d& p) {
        ++asked;
        return norm(p) - 0.05;
      },
      {{-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}});
  RegionMeshOptions options{0.0005};
  options.progress = [](double) { return false; };
  EXPECT_THROW(mesh_regions({region_of("ball", ball)}, options), MeshingStopped);
  EXPECT_LE(asked, 300U) << "of some two million";
  asked = 0;
  EXPECT_THAT(refusal({region_of("ball", ball)}, {.edge = 0.0005, .max_tets = 10000}),
              HasSubstr("at most 10000 are allowed"));
  EXPECT_LE(asked, 40000U);
}

// The liver has the size and volume of docs/liver.md, its four regions are in one piece each, and all angles are good.
TEST(Liver, HasTheSizeOfALiver) {
  LiverOptions options;
  options.edge = 0.006;
  const RegionMesh made = liver_mesh(options);
  expect_conforming(made.mesh);
  expect_good_shapes(made, options.edge);
  const MeshReport report = inspect(made.mesh);
  EXPECT_EQ(report.pieces, 1u);
  EXPECT_NEAR(report.volume, 1500e-6, 50e-6);
  const Vec3d size = report.box_max - report.box_min;
  EXPECT_NEAR(size.x, 0.21, 0.006);
  EXPECT_NEAR(size.y, 0.11, 0.006);
  EXPECT_NEAR(size.z, 0.16, 0.006);
  ASSERT_EQ(made.report.regions.size(), 4u);
  EXPECT_NEAR(made.report.regions[0].volume, 4.0 / 3.0 * kPi * std::pow(options.tumour_radius, 3), 0.2e-6);
  for (const char* name : {"bare_area", "dome", "visceral_face", "vena_cava"}) {
    EXPECT_GT(made.mesh.vertex_sets.at(name).size(), 50u) << name;
  }
}

}  // namespace
}  // namespace glisson
