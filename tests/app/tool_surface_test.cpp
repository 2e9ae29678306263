// The surfaces that are written of tools are closed, face outwards and hold the volume of the solid, where the tool is.
#include "report/tool_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "glisson/instruments/contact.h"
#include "glisson/instruments/tool_motion.h"

namespace glisson::test::tool_surface_test {
namespace {

constexpr double kPi = std::numbers::pi;

std::shared_ptr<ContactTool> tool_of(const Shape& shape) {
  const Pose start{{0.3, -0.2, 0.1}, {{{{0.0, -1.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}}}}};
  return std::make_shared<ContactTool>(ContactOptions{.shape = shape},
                                       std::make_shared<PathDriver>(start, steady_path({})));
}

/// Volume by the divergence theorem, about the tool's tip: > 0 where faces look outwards.
double volume(const SurfaceMesh& mesh, const Vec3d& tip) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles) {
    sum += dot(mesh.points[t[0]] - tip, cross(mesh.points[t[1]] - tip, mesh.points[t[2]] - tip)) / 6.0;
  }
  return sum;
}

// Round parts are polygons of 32 sides, whose area is 0.9936 of the circle's; a ball is flat between its rings, too.
TEST(ToolSurface, HasTheVolumeOfTheSolid) {
  const double r = 4e-3, l = 0.03, polygon = 32.0 / (2.0 * kPi) * std::sin(2.0 * kPi / 32.0);
  const NeedleShape needle{.diameter = 2.0 * r, .length = l, .tip_angle = 0.8};
  const double tip = needle.tip_length();
  const std::pair<Shape, double> cases[] = {
      {FlatPunch{.radius = r, .length = l}, polygon * kPi * r * r * l},
      {needle, polygon * kPi * r * r * (l - tip + tip / 3.0)},
      {Block{.size = {0.01, 0.02, 0.03}}, 0.01 * 0.02 * 0.03},
  };
  for (const auto& [shape, exact] : cases) {
    const auto tool = tool_of(shape);
    EXPECT_NEAR(volume(tool_surface(*tool, 0.1), tool->pose().position), exact, 1e-9 * exact) << shape.index();
  }
  const auto ball = tool_of(Ball{r});
  const double exact = 4.0 / 3.0 * kPi * r * r * r;
  EXPECT_NEAR(volume(tool_surface(*ball, 0.1), ball->pose().position), exact, 0.02 * exact);
}

// It lies at the pose: a ball's points are its radius from its centre; a plate is as large as asked for.
TEST(ToolSurface, IsWhereTheToolIs) {
  const auto ball = tool_of(Ball{4e-3});
  const Vec3d centre = ball->pose().position + Vec3d{0.0, 0.0, 4e-3};
  for (const Vec3d& x : tool_surface(*ball, 0.1).points) EXPECT_NEAR(norm(x - centre), 4e-3, 1e-15);
  const SurfaceMesh plate = tool_surface(*tool_of(Plate{}), 0.1);
  ASSERT_EQ(plate.points.size(), 4u);
  EXPECT_NEAR(norm(plate.points[2] - plate.points[0]), 0.1 * std::sqrt(2.0), 1e-15);
}

}  // namespace
}  // namespace glisson::test::tool_surface_test
