// surface_repair_test.cpp — surfaces as they come, with triangles missing, doubled and corners a little off, close and bound the volume of the
// whole surface; what was done is said in numbers and places, and what cannot be closed is refused with its place.
#include "glisson/surface_repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <numbers>
#include <random>
#include <set>

#include "glisson/scene/surface_file.h"
#include "glisson/surface_region.h"
#include "mesher/implicit/surface_edges.h"
#include "scene/scene_text.h"
#include "support/folder.h"
#include "support/surface_files.h"

namespace glisson {
namespace surface_repair_test {

using test::cube_surface;
using test::icosphere;
using test::torus_surface;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// Every triangle with points of its own, as .stl has them.
TriangleSurface as_soup(const TriangleSurface& s) {
  TriangleSurface soup;
  for (const Triangle& t : s.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.points.size());
    for (const std::uint32_t corner : t) soup.points.push_back(s.points[corner]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

/// A smooth lump with bumps: a ball whose radius waves.
TriangleSurface lump(double radius, int splits) {
  TriangleSurface s = icosphere(radius, splits);
  for (Vec3d& x : s.points) {
    const Vec3d d = unit(x);
    x = x * (1.0 + 0.15 * std::sin(4.0 * d.x + 1.0) * std::cos(3.0 * d.y) + 0.1 * d.z);
  }
  return s;
}

/// A surface as it comes, and where its holes are.
struct Damaged {
  TriangleSurface surface;
  std::vector<Vec3d> holes;
};

/// Takes triangles away, writes others twice, and moves single corners.
Damaged damaged(const TriangleSurface& whole, unsigned seed, std::size_t missing, std::size_t doubled, std::size_t off,
                double by) {
  std::mt19937 random(seed);
  Damaged made{as_soup(whole), {}};
  std::vector<Triangle>& triangles = made.surface.triangles;
  std::shuffle(triangles.begin(), triangles.end(), random);
  for (std::size_t i = 0; i < missing; ++i) {
    made.holes.push_back(made.surface.points[triangles.back()[0]]);
    triangles.pop_back();
  }
  for (std::size_t i = 0; i < doubled; ++i) triangles.push_back(triangles[random() % triangles.size()]);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < off; ++i)
    made.surface.points[random() % made.surface.points.size()] +=
        unit(Vec3d{normal(random), normal(random), normal(random)}) * by;
  return made;
}

/// Whether every edge of a surface belongs to two triangles that go along it both ways.
bool is_watertight(std::span<const Triangle> triangles) {
  const detail::EdgeUses edges = detail::edge_uses(triangles);
  return std::all_of(edges.begin(), edges.end(),
                     [](const auto& e) { return e.second.sum == 0 && e.second.count == 2; });
}

double volume_of(const SurfaceRepair& s) { return test::volume_within({s.points, s.triangles}); }

// A surface that closes is as it was, to the order of its triangles, and nothing is said.
TEST(SurfaceRepair, LeavesAClosedSurfaceAlone) {
  const TriangleSurface whole = torus_surface(0.03, 0.01, 24, 12);
  const SurfaceRepair same = repair_surface(whole.points, whole.triangles);
  EXPECT_EQ(same.triangles, whole.triangles);
  EXPECT_FALSE(same.any());
  EXPECT_EQ(same.text(), "");
}

// A plane loop gets a plane lid: where the winding number of the open surface passes a half. A ball without its cap loses the cap's volume,
// π h² (3 R − h) / 3, and nothing else.
TEST(SurfaceRepair, ClosesAPlaneHoleByAPlane) {
  TriangleSurface ball = icosphere(0.05, 4);
  const double height = 0.0035, level = 0.05 - height;  // 3.5 % of the area
  std::erase_if(ball.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return ball.points[v].z > level; });
  });
  for (Vec3d& x : ball.points) x.z = std::min(x.z, level);  // the rim lies in a plane
  const double before = test::volume_within(icosphere(0.05, 4));
  const SurfaceRepair closed = repair_surface(ball.points, ball.triangles);
  ASSERT_EQ(closed.holes.size(), 1U);
  EXPECT_NEAR(closed.holes[0].middle.z, level, 1e-12);
  // The plane's circle has 3.4 % of the sphere; the triangles that it cuts stay, and a rim half an edge wide with them.
  EXPECT_NEAR(closed.holes[0].share, 0.030, 0.004);
  const double cap = std::numbers::pi * height * height * (0.15 - height) / 3.0;
  EXPECT_NEAR(volume_of(closed), before - cap, 0.15 * cap) << "of 320 facets across";
  EXPECT_TRUE(is_watertight(closed.triangles));
  const Solid open_top = surface_solid(closed.points, closed.triangles);
  EXPECT_LT(open_top.distance({0, 0, level - 1e-4}), 0.0);
  EXPECT_NEAR(open_top.distance({0, 0, level + 1e-4}), 1e-4, 1e-9) << "the lid is plane";
}

// A corner of one triangle that is 2 µm off joins the others; a triangle that is written twice, or the second time the other way round, stays
// once; each with its number and place.
TEST(SurfaceRepair, SaysWhatItDid) {
  TriangleSurface soup = as_soup(cube_surface(0.02));
  soup.points[soup.triangles[3][1]].x += 2e-6;
  soup.triangles.push_back(soup.triangles[5]);
  soup.triangles.push_back({soup.triangles[7][0], soup.triangles[7][2], soup.triangles[7][1]});
  const SurfaceRepair closed = repair_surface(soup.points, soup.triangles);
  EXPECT_EQ(closed.welded.size(), 1U);
  EXPECT_NEAR(closed.farthest_weld, 2e-6, 1e-12);
  EXPECT_EQ(closed.doubled.size(), 2U);
  EXPECT_TRUE(closed.holes.empty());
  EXPECT_TRUE(is_watertight(closed.triangles));
  EXPECT_NEAR(volume_of(closed), 8e-6, 1e-15);
  EXPECT_THAT(closed.text(), AllOf(HasSubstr("1 point was joined to others up to 0.002 mm away, at ("),
                                   HasSubstr("2 double triangles were left out, at (")));
}

// A hole above a twentieth of the area is refused with its share, its edges and its place; sheets and turned triangles are left to surface_solid.
TEST(SurfaceRepair, RefusesALargeHoleWithItsPlace) {
  TriangleSurface ball = icosphere(0.05, 4);
  std::erase_if(ball.triangles, [&](const Triangle& t) { return ball.points[t[0]].z > 0.044; });
  try {
    repair_surface(ball.points, ball.triangles);
    ADD_FAILURE() << "closed";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("has a hole of 5."), HasSubstr("% of its area, "), HasSubstr(" edges around ("),
                      HasSubstr(", 0.04"), HasSubstr("holes up to 5 % are closed")));
  }
  TriangleSurface turned = cube_surface(0.02);
  std::swap(turned.triangles[4][0], turned.triangles[4][1]);
  const SurfaceRepair same = repair_surface(turned.points, turned.triangles);
  EXPECT_FALSE(same.any());
  EXPECT_THROW(surface_solid(same.points, same.triangles), std::invalid_argument);
}

/// 95th percentile and largest distance of a mesh's surface from a whole surface, away from holes [m].
double farthest_from(const TetMesh& mesh, const Solid& whole, const std::vector<Vec3d>& holes, double around) {
  double most = 0.0;
  std::set<std::uint32_t> skin;
  for (const Triangle& t : boundary_triangles(mesh)) skin.insert(t.begin(), t.end());
  for (const std::uint32_t v : skin) {
    const Vec3d& x = mesh.vertices[v];
    if (std::any_of(holes.begin(), holes.end(), [&](const Vec3d& h) { return norm(x - h) < around; })) continue;
    most = std::max(most, std::abs(whole.distance(x)));
  }
  return most;
}

/// Surfaces of 60 000 triangles and more.
TriangleSurface shape_of(int shape) {
  if (shape == 0) return icosphere(0.05, 6);
  return shape == 1 ? torus_surface(0.04, 0.015, 300, 100) : lump(0.05, 6);
}

// 25 of 60 000 and more triangles missing, 40 doubled, 200 corners 2 µm off: the mesh of it is watertight, has the volume of the whole surface to 0.5 %
// and lies on it to half an edge away from the holes, within 20 s.
class SurfacesAsTheyCome : public ::testing::TestWithParam<std::tuple<int, unsigned>> {};
TEST_P(SurfacesAsTheyCome, AreMeshed) {
  const auto [shape, seed] = GetParam();
  constexpr double kEdge = 0.005;
  const TriangleSurface whole = shape_of(shape);
  const Solid solid = surface_solid(whole.points, whole.triangles);
  const Damaged came = damaged(whole, seed, 25, 40, 200, 2e-6);
  const std::clock_t start = std::clock();  // of this process, whatever else the machine does
  const SurfaceRepair closed = repair_surface(came.surface.points, came.surface.triangles);
  const TetMesh mesh = mesh_regions({surface_region("body", closed.points, closed.triangles)}, {.edge = kEdge}).mesh;
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const double exact = test::volume_within(whole), off = volume(mesh) / exact - 1.0;
  const double farthest = farthest_from(mesh, solid, came.holes, 2.0 * kEdge);
  std::printf(
      "shape %d seed %u: %zu triangles, %zu welded, %zu doubled, %zu holes, volume %+.3f %%, farthest %.3f edges, %.1f "
      "s\n",
      shape, seed, came.surface.triangles.size(), closed.welded.size(), closed.doubled.size(), closed.holes.size(),
      100.0 * off, farthest / kEdge, seconds);
  EXPECT_TRUE(is_watertight(boundary_triangles(mesh)));
  EXPECT_LT(std::abs(off), 0.005);
  EXPECT_LT(std::abs(volume_of(closed) / exact - 1.0), 1e-4) << "of the surface itself";
  EXPECT_LT(farthest, 0.5 * kEdge);
  EXPECT_LT(seconds, 20.0);
  EXPECT_GE(closed.welded.size(), 195U) << "a corner may be drawn twice, or be of a triangle that is written twice";
  EXPECT_LE(closed.welded.size(), 200U);
  EXPECT_GE(closed.doubled.size(), 38U);
  EXPECT_LE(closed.holes.size(), 25U);
}
INSTANTIATE_TEST_SUITE_P(First, SurfacesAsTheyCome,  // long: 1, 2
                         ::testing::Combine(::testing::Range(0, 3), ::testing::Values(1U)));
INSTANTIATE_TEST_SUITE_P(All, SurfacesAsTheyCome,  // verify
                         ::testing::Combine(::testing::Range(0, 3), ::testing::Range(2U, 51U)));

/// What a scene says of a surface of its.
class SurfaceInAScene : public test::InFolder {};

// A scene's surface is closed on the way, and its notes say so, with the file.
TEST_F(SurfaceInAScene, IsClosedAndSaid) {
  TriangleSurface open = icosphere(30.0, 3);
  open.triangles.pop_back();
  const std::string path = write("open.obj", test::obj_text(open));
  const Scene scene = test::parse(
      "[mesh]\nkind = \"implicit\"\n[[mesh.shape]]\nname = \"s\"\nkind = \"surface\"\nscale = 0.001\npath = \"" + path +
      "\"\n[[mesh.region]]\nname = \"s\"\n[motion]\nduration_s = 1\n");
  ASSERT_EQ(scene.notes.size(), 1U);
  EXPECT_THAT(scene.notes[0],
              AllOf(HasSubstr("open.obj: 1 hole was closed, the largest of 0.0"), HasSubstr("% of the area, at (")));
  EXPECT_EQ(surface_repairs(scene.variants[0]), scene.notes);
}

}  // namespace surface_repair_test
}  // namespace glisson
