// A closed surface of triangles bounds a region: its distance is that to the triangles, its mesh has its volume, and a surface that is
// not closed is refused with the place.
#include "glisson/surface_region.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

namespace glisson {
namespace surface_region_test {

using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

struct Surface {
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;

  double volume() const {
    double sum = 0.0;
    for (const Triangle& t : triangles) sum += dot(points[t[0]], cross(points[t[1]], points[t[2]])) / 6.0;
    return sum;
  }
};

/// A sheet over (u, v) in turns, closed along both: where it comes back to a point, points are written again, as in an .stl.
Surface sheet(int across, int along, const std::function<Vec3d(double, double)>& place) {
  Surface s;
  const auto at = [&](int i, int j) {
    return place(static_cast<double>(i % across) / across, static_cast<double>(j) / along);
  };
  for (int i = 0; i < across; ++i) {
    for (int j = 0; j < along; ++j) {
      const auto n = static_cast<std::uint32_t>(s.points.size());
      for (const Vec3d& x : {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}) s.points.push_back(x);
      s.triangles.push_back({n, n + 1, n + 2});
      s.triangles.push_back({n, n + 2, n + 3});
    }
  }
  return s;
}

Surface torus(int across, int along) {
  const double R = 0.06, r = 0.03;
  return sheet(across, along, [=](double u, double v) {
    const double a = 2 * kPi * u, b = 2 * kPi * (v >= 1.0 ? 0.0 : v);
    return Vec3d{(R + r * std::cos(b)) * std::cos(a), (R + r * std::cos(b)) * std::sin(a), r * std::sin(b)};
  });
}

Surface ball(int across, int along, double radius = 0.05) {
  return sheet(across, along, [=](double u, double v) {
    if (v <= 0.0) return Vec3d{0, 0, -radius};
    if (v >= 1.0) return Vec3d{0, 0, radius};
    const double a = 2 * kPi * u, b = kPi * (v - 0.5);
    return Vec3d{radius * std::cos(b) * std::cos(a), radius * std::cos(b) * std::sin(a), radius * std::sin(b)};
  });
}

BodyRegion region(const Surface& s) { return surface_region("organ", s.points, s.triangles); }

// Of a ball of 5000 triangles the distance is that of the ball to the depth of its facets, 0.2 mm: inside, outside and near.
TEST(SurfaceRegion, IsTheDistanceToABall) {
  const BodyRegion organ = region(ball(72, 36));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> within(-0.08, 0.08);
  for (int i = 0; i < 2000; ++i) {
    const Vec3d p{within(random), within(random), within(random)};
    EXPECT_NEAR(organ.distance(p), norm(p) - 0.05, 2e-4);
  }
  EXPECT_NEAR(organ.distance({}), -0.05, 2e-4);
  EXPECT_NEAR(organ.bounds.max.z, 0.05, 1e-12);
}

// The tree finds the triangle that a search through all finds, and the same side.
TEST(SurfaceRegion, TreeIsTheSearchThroughAll) {
  const Surface s = torus(24, 16);
  const BodyRegion organ = region(s);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> within(-0.1, 0.1);
  for (int i = 0; i < 60; ++i) {
    const Vec3d p{within(random), within(random), 0.4 * within(random)};
    double nearest = std::numeric_limits<double>::infinity(), turns = 0.0;
    for (const Triangle& t : s.triangles) {
      const Surface one{{s.points[t[0]], s.points[t[1]], s.points[t[2]]}, {}};
      const Vec3d a = one.points[0] - p, b = one.points[1] - p, c = one.points[2] - p;
      const double x = norm(a), y = norm(b), z = norm(c);
      turns +=
          2 * std::atan2(dot(a, cross(b, c)), x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y) / (4 * kPi);
      for (int k = 0; k <= 40; ++k) {  // points of the triangle, up to 1/40 of its edges apart
        for (int m = 0; k + m <= 40; ++m) {
          nearest = std::min(nearest, norm(a + (b - a) * (k / 40.0) + (c - a) * (m / 40.0)));
        }
      }
    }
    EXPECT_LE(std::abs(organ.distance(p)), nearest * (1.0 + 1e-12));
    EXPECT_GE(std::abs(organ.distance(p)), nearest - 6e-4) << "half the distance of the points searched";
    EXPECT_EQ(organ.distance(p) < 0.0, turns > 0.5) << turns;
  }
}

// A thin ring of long triangles, where far triangles count together: a hundredth of a millimetre to either side of each triangle is
// inside or outside.
TEST(SurfaceRegion, KnowsBothSidesOfEveryTriangle) {
  const double R = 0.06, r = 0.005;
  const Surface s = sheet(300, 8, [=](double u, double v) {
    const double a = 2 * kPi * u, b = 2 * kPi * (v >= 1.0 ? 0.0 : v);
    return Vec3d{(R + r * std::cos(b)) * std::cos(a), (R + r * std::cos(b)) * std::sin(a), r * std::sin(b)};
  });
  const BodyRegion ring = region(s);
  for (const Triangle& t : s.triangles) {
    const Vec3d &a = s.points[t[0]], &b = s.points[t[1]], &c = s.points[t[2]];
    const Vec3d out = unit(cross(b - a, c - a)) * 1e-5, middle = (a + b + c) * (1.0 / 3.0);
    EXPECT_NEAR(ring.distance(middle + out), 1e-5, 1e-10);
    EXPECT_NEAR(ring.distance(middle - out), -1e-5, 1e-10);
  }
}

double p95_of_surface(const TetMesh& mesh, const std::function<double(const Vec3d&)>& distance) {
  std::vector<double> off;
  for (const Triangle& t : boundary_triangles(mesh)) {
    for (const std::uint32_t v : t) off.push_back(std::abs(distance(mesh.vertices[v])));
    off.push_back(std::abs(distance((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) * (1.0 / 3.0))));
  }
  std::sort(off.begin(), off.end());
  return off[off.size() * 95 / 100];
}

// Meshed at ten edges across: the volume of the surface to half a percent, 95 % of the mesh's surface within a tenth of an edge,
// dihedral angles as of any body of shapes.
TEST(SurfaceRegion, IsMeshedAsItsBodyIs) {
  for (const auto& [surface, edge] : {std::pair(ball(80, 40), 0.01), std::pair(torus(100, 50), 0.006)}) {
    const BodyRegion organ = region(surface);
    const RegionMesh made = mesh_regions({organ}, {.edge = edge});
    EXPECT_NEAR(made.report.regions.at(0).volume / surface.volume(), 1.0, 5e-3);
    EXPECT_LT(p95_of_surface(made.mesh, organ.distance), 0.1 * edge);
    EXPECT_GE(made.report.min_dihedral_deg, 10.0);
    EXPECT_LE(made.report.max_dihedral_deg, 165.0);
    testing::Test::RecordProperty("volume_error",
                                  std::to_string(made.report.regions[0].volume / surface.volume() - 1.0));
  }
}

// Normals that all point inward make no difference, and two balls that cross are one body.
TEST(SurfaceRegion, TakesWhatProgramsWrite) {
  Surface s = ball(24, 12);
  const double inside = region(s).distance({0.01, 0, 0});
  for (Triangle& t : s.triangles) std::swap(t[1], t[2]);
  EXPECT_DOUBLE_EQ(region(s).distance({0.01, 0, 0}), inside);
  Surface two = ball(24, 12);
  const auto n = static_cast<std::uint32_t>(two.points.size());
  const Surface other = ball(24, 12);
  for (const Vec3d& x : other.points) two.points.push_back(x + Vec3d{0.06, 0, 0});
  for (const Triangle& t : other.triangles) two.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  for (const double x : {-0.03, 0.03, 0.09}) EXPECT_LT(region(two).distance({x, 0, 0}), 0.0) << x;
  EXPECT_GT(region(two).distance({0.03, 0.045, 0}), 0.0);
}

std::string refusal(const Surface& s) {
  try {
    region(s);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

// What bounds no body is named with its place and the way out.
TEST(SurfaceRegion, RefusesWhatIsNotClosed) {
  Surface s = ball(24, 12);
  s.triangles.erase(s.triangles.begin() + 11);
  EXPECT_THAT(refusal(s), testing::AllOf(HasSubstr("\"organ\": is open at 3 edges, the first at ("),
                                         HasSubstr("repair_surface closes it")));
  s = ball(24, 12);
  std::swap(s.triangles[11][1], s.triangles[11][2]);
  EXPECT_THAT(refusal(s), testing::AllOf(HasSubstr("turn against their neighbours at 3 edges"), HasSubstr("orient")));
  EXPECT_THAT(refusal({}), HasSubstr("has no triangles"));
  s = ball(24, 12);
  s.triangles[3][1] = 999999;
  EXPECT_THAT(refusal(s), HasSubstr("triangle 3 of point 999999; there are"));
  s = ball(24, 12);
  s.points[5].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(s), HasSubstr("point 5 that is not finite"));
  EXPECT_THAT(refusal({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}}), HasSubstr("no volume"));
}

}  // namespace surface_region_test
}  // namespace glisson
