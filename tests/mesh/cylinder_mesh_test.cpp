#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "glisson/mesh.h"

namespace glisson {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::string refusal(const CylinderOptions& options) {
  try {
    cylinder_mesh(options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

double radius_of(const Vec3d& x) { return std::hypot(x.x, x.y); }

// A cylinder mesh is valid, conforming and in one piece, for every number of rings and layers and any grading.
TEST(CylinderMesh, IsValidAndConforming) {
  for (const int rings : {1, 2, 5, 12}) {
    for (const double grading : {1.0, 4.0, 30.0}) {
      CylinderOptions options;
      options.radial_cells = rings;
      options.axial_cells = 3;
      options.grading = grading;
      const TetMesh mesh = cylinder_mesh(options);
      ASSERT_NO_THROW(require_valid(mesh)) << rings << " rings, grading " << grading;
      const MeshReport report = inspect(mesh);
      const auto n = static_cast<std::size_t>(rings);
      EXPECT_EQ(report.tets, 3 * 6 * n * n * 3);
      EXPECT_EQ(report.boundary_triangles, 2 * 6 * n * n + 2 * 6 * n * 3);
      EXPECT_EQ(report.non_manifold_faces, 0u);
      EXPECT_EQ(report.pieces, 1u);
    }
  }
}

// The volume converges to π r² h at second order: the wall is a polygon inscribed in the circle.
TEST(CylinderMesh, VolumeConvergesToThatOfTheCylinder) {
  CylinderOptions options;
  options.grading = 3.0;
  const double exact = std::numbers::pi * options.radius * options.radius * options.height;
  double previous = 0.0;
  for (const int rings : {4, 8, 16, 32}) {
    options.radial_cells = rings;
    const double error = exact - volume(cylinder_mesh(options));
    EXPECT_GT(error, 0.0);
    // 1 − sin(x)/x with x = 2π/6n falls by 4 when n doubles, up to a part x²/20 (below 0.4 % from n = 4).
    if (previous > 0.0) {
      EXPECT_NEAR(previous / error, 4.0, 0.02) << rings << " rings";
    }
    previous = error;
  }
  EXPECT_LT(previous / exact, 2e-4);
}

// `grading` is the width of the outermost ring over that of the innermost, with constant growth in between.
TEST(CylinderMesh, GradesRingsTowardTheAxis) {
  CylinderOptions options;
  options.radial_cells = 5;
  options.grading = 16.0;
  std::set<double> radii;
  for (const Vec3d& x : cylinder_mesh(options).vertices) radii.insert(std::round(radius_of(x) * 1e12) / 1e12);
  const std::vector<double> r(radii.begin(), radii.end());
  ASSERT_EQ(r.size(), 6u);
  for (std::size_t k = 2; k < r.size(); ++k) {
    EXPECT_NEAR((r[k] - r[k - 1]) / (r[k - 1] - r[k - 2]), 2.0, 1e-6);  // 16^(1/4)
  }
  EXPECT_DOUBLE_EQ(r.back(), options.radius);
}

// The sets bottom, top, wall and axis hold exactly the vertices on these parts of the cylinder.
TEST(CylinderMesh, NamesItsParts) {
  CylinderOptions options;
  options.radial_cells = 4;
  options.axial_cells = 5;
  const TetMesh mesh = cylinder_mesh(options);
  std::map<std::string, std::vector<std::uint32_t>> expected;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3d& x = mesh.vertices[v];
    if (x.z == 0.0) expected["bottom"].push_back(v);
    if (x.z == options.height) expected["top"].push_back(v);
    if (radius_of(x) == 0.0) expected["axis"].push_back(v);
    if (std::abs(radius_of(x) - options.radius) < 1e-12) expected["wall"].push_back(v);
  }
  EXPECT_EQ(mesh.vertex_sets, expected);
  EXPECT_EQ(mesh.vertex_sets.at("wall").size(), 6u * 4u * 6u);
}

// With equal rings and layers of that size no tet is worse than half as good as the cube split's.
TEST(CylinderMesh, ShapesAreReasonable) {
  CylinderOptions options;
  options.radius = 0.05;
  options.height = 0.05;
  const MeshReport report = inspect(cylinder_mesh(options));
  EXPECT_GT(report.worst_mean_ratio, 0.5 * 0.755953);
  EXPECT_GT(report.median_mean_ratio, 0.7);
  EXPECT_THAT(report.warnings, ElementsAre());
}

// A bad option is refused with its name, its value and the allowed range.
TEST(CylinderMesh, RefusesBadOptions) {
  CylinderOptions options;
  options.radius = 0.0;
  EXPECT_THAT(refusal(options), AllOf(HasSubstr("radius [m] = 0"), HasSubstr("> 0 and ≤ 10000")));
  options = {};
  options.height = std::nan("");
  EXPECT_THAT(refusal(options), HasSubstr("height [m] = nan"));
  options = {};
  options.radial_cells = 0;
  EXPECT_THAT(refusal(options), AllOf(HasSubstr("radial_cells = 0"), HasSubstr("1 to 2000")));
  options = {};
  options.axial_cells = -3;
  EXPECT_THAT(refusal(options), HasSubstr("axial_cells = -3"));
  options = {};
  options.grading = 0.5;
  EXPECT_THAT(refusal(options), AllOf(HasSubstr("grading = 0.5"), HasSubstr("1 to 10000")));
  options = {};
  options.radial_cells = 2000;
  options.axial_cells = 10000;
  EXPECT_THAT(refusal(options), HasSubstr("at most 2e8"));
}

}  // namespace
}  // namespace glisson
