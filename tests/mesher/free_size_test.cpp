// Sizes as a function of a point: edges follow it, the shortest of all sizes counts, and values that cannot be are named with their place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "glisson/implicit.h"
#include "mesh_checks.h"

namespace glisson {
namespace free_size {

using testing::AllOf;
using testing::HasSubstr;

const std::vector<BodyRegion>& ball() {
  static const std::vector<BodyRegion> regions{region_of("ball", BallShape{{}, 0.05})};
  return regions;
}

/// Mean edge of tets whose distance from the origin is in a range, and of those asked for there [m].
struct ShellEdges {
  double edge = 0.0, asked = 0.0;
};
ShellEdges edges_between(const TetMesh& mesh, const std::vector<double>& asked, double low, double high) {
  ShellEdges sum;
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Tet& x = mesh.tets[t];
    Vec3d centre{};
    double edge = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      centre += mesh.vertices[x[i]] * 0.25;
      for (std::size_t j = i + 1; j < 4; ++j) edge += norm(mesh.vertices[x[i]] - mesh.vertices[x[j]]) / 6.0;
    }
    if (norm(centre) < low || norm(centre) >= high) continue;
    sum.edge += edge, sum.asked += asked[t], ++count;
  }
  EXPECT_GT(count, 100u);
  return {sum.edge / static_cast<double>(count), sum.asked / static_cast<double>(count)};
}

// Where the function is constant, the mean edge is the one asked for to 5 %, as with one edge throughout: within, between and outside.
TEST(FreeSize, IsMetWhereItIsConstant) {
  RegionMeshOptions options{.edge = 0.008};
  options.size_at = [](const Vec3d& p) { return norm(p) < 0.012 ? 0.002 : norm(p) < 0.03 ? 0.004 : 0.008; };
  const RegionMesh made = mesh_regions(ball(), options);
  test::expect_conforming(made.mesh);
  EXPECT_GE(made.report.min_dihedral_deg, 10.0);
  EXPECT_LE(made.report.max_dihedral_deg, 165.0);
  const std::vector<double> asked = edges_asked(made.mesh, ball(), options);
  EXPECT_NEAR(edges_between(made.mesh, asked, 0.0, 0.009).edge, 0.002, 0.05 * 0.002);
  EXPECT_NEAR(edges_between(made.mesh, asked, 0.018, 0.024).edge, 0.004, 0.05 * 0.004);
  EXPECT_NEAR(edges_between(made.mesh, asked, 0.042, 0.051).edge, 0.008, 0.05 * 0.008);
}

// Where it grows with the distance, each shell has the mean edge asked for to the factor of √2 by which cubes differ, and the whole
// ball to a tenth.
TEST(FreeSize, IsFollowedWhereItGrows) {
  RegionMeshOptions options{.edge = 0.01};
  options.size_at = [](const Vec3d& p) { return 0.0015 + 0.12 * norm(p); };
  const RegionMesh made = mesh_regions(ball(), options);
  test::expect_conforming(made.mesh);
  EXPECT_TRUE(made.report.poor_tets.empty());
  const std::vector<double> asked = edges_asked(made.mesh, ball(), options);
  for (int shell_5mm = 1; shell_5mm < 10; ++shell_5mm) {
    const double low = 0.005 * shell_5mm;
    const ShellEdges shell = edges_between(made.mesh, asked, low, low + 0.005);
    EXPECT_LT(shell.edge, std::sqrt(2.0) * shell.asked) << low;
    EXPECT_GT(shell.edge, std::sqrt(0.5) * shell.asked) << low;
  }
  const ShellEdges all = edges_between(made.mesh, asked, 0.0, 1.0);
  EXPECT_NEAR(all.edge, all.asked, 0.1 * all.asked);
}

// The shortest of the function, the sizes and the edge of the mesh counts.
TEST(FreeSize, IsOneOfAllSizes) {
  RegionMeshOptions options{.edge = 0.01, .sizes = {{.edge = 0.003, .path = {{{0.02, 0, 0}}}, .within = 0.01}}};
  options.size_at = [](const Vec3d& p) { return p.x < 0.0 ? 0.005 : 1.0; };
  const RegionMesh made = mesh_regions(ball(), options);
  const std::vector<double> asked = edges_asked(made.mesh, ball(), options);
  for (std::size_t t = 0; t < made.mesh.tets.size(); ++t) {
    Vec3d centre{};
    for (const std::uint32_t v : made.mesh.tets[t]) centre += made.mesh.vertices[v] * 0.25;
    const double of_path = 0.003 + kGrowth * std::max(0.0, norm(centre - Vec3d{0.02, 0, 0}) - 0.01);
    EXPECT_DOUBLE_EQ(asked[t], std::min({0.01, of_path, centre.x < 0.0 ? 0.005 : 1.0}));
  }
}

// The same function gives the same bytes, and one that asks for nothing shorter those of no function.
TEST(FreeSize, IsTheSameEachTime) {
  RegionMeshOptions options{.edge = 0.01};
  const TetMesh plain = mesh_regions(ball(), options).mesh;
  options.size_at = [](const Vec3d&) { return 0.01; };
  EXPECT_EQ(mesh_regions(ball(), options).mesh, plain);
  options.size_at = [](const Vec3d& p) { return 0.004 + 0.3 * std::abs(p.z); };
  const TetMesh graded = mesh_regions(ball(), options).mesh;
  EXPECT_EQ(mesh_regions(ball(), options).mesh, graded);
  EXPECT_NE(graded, plain);
}

std::string refusal_of_size(double value, std::size_t max_tets = 1000000) {
  RegionMeshOptions options{.edge = 0.01, .max_tets = max_tets};
  options.size_at = [value](const Vec3d& p) { return p.x > 0.03 ? value : 0.01; };
  try {
    mesh_regions(ball(), options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

// A value that cannot be is named with the point, what is allowed and the way out.
TEST(FreeSize, RefusesValuesThatCannotBe) {
  const auto names = [](const char* value) {
    return AllOf(HasSubstr("size_at gives " + std::string(value) + " m at (0.03"), HasSubstr("3.91e-05 m or more"),
                 HasSubstr("return that edge, 0.01 m"));
  };
  EXPECT_THAT(refusal_of_size(0.0), names("0"));
  EXPECT_THAT(refusal_of_size(-0.002), names("-0.002"));
  EXPECT_THAT(refusal_of_size(1e-6), names("1e-06"));
  EXPECT_THAT(refusal_of_size(std::numeric_limits<double>::infinity()), names("inf"));
  EXPECT_THAT(refusal_of_size(std::numeric_limits<double>::quiet_NaN()), HasSubstr("nan m at (0.03"));
  EXPECT_THAT(refusal_of_size(0.0005, 20000),
              AllOf(HasSubstr("at the finest 0.5 mm"), HasSubstr("more than 20000 tets")));
  EXPECT_EQ(refusal_of_size(0.02), "accepted");
}

}  // namespace free_size
}  // namespace glisson
