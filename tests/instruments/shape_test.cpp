// A shape's distance is that to its surface, negative inside, with its gradient as normal; what is no shape is refused.
#include <random>

#include "contact/shape_traits.h"
#include "glisson/instruments/tool_motion.h"
#include "instruments/contact_scenes.h"

namespace glisson::shape_test {
namespace {

struct Case {
  const char* name;
  Shape shape;
  bool exact = true;  ///< outside; a bevel's distance is a lower bound near its rim
};

const Case kCases[] = {
    {"punch", FlatPunch{.radius = 0.01, .length = 0.03}},
    {"rounded_punch", FlatPunch{.radius = 0.01, .edge_radius = 0.002, .length = 0.03}},
    {"ball", Ball{.radius = 0.01}},
    {"cone", NeedleShape{.diameter = 0.01, .length = 0.05, .tip = TipForm::conical, .tip_angle = 0.7}},
    {"bevel", NeedleShape{.diameter = 0.01, .length = 0.05, .tip = TipForm::bevelled, .tip_angle = 0.4}, false},
    {"blunt", NeedleShape{.diameter = 0.01, .length = 0.05, .tip = TipForm::blunt}},
    {"plate", Plate{}},
    {"wall", CylinderWall{.radius = 0.02}},
    {"block", Block{.size = {0.01, 0.02, 0.03}}},
    {"rounded_block", Block{.size = {0.01, 0.02, 0.03}, .edge_radius = 0.002}}};

class ShapeDistances : public testing::TestWithParam<Case> {
 protected:
  std::mt19937 random{7};
  Vec3d any(double size = 0.03) {
    std::uniform_real_distribution<double> u(-size, size);
    return {u(random), u(random), u(random) + 0.01};
  }
};

// The normal is the gradient of φ by central differences of 1e-8 m, but on the sets of no measure where it jumps: two of a
// thousand points may lie so near to one.
TEST_P(ShapeDistances, NormalIsTheGradient) {
  int off = 0;
  for (int n = 0; n < 1000; ++n) {
    const Vec3d x = any();
    const ShapeDistance d = distance_to(GetParam().shape, x);
    EXPECT_NEAR(norm(d.normal), 1.0, 1e-12);
    const double e = 1e-8;
    Vec3d g;
    for (std::size_t i = 0; i < 3; ++i) {
      Vec3d a = x, b = x;
      a[i] -= e, b[i] += e;
      g[i] = (distance_to(GetParam().shape, b).distance - distance_to(GetParam().shape, a).distance) / (2.0 * e);
    }
    off += norm(g - d.normal) < 1e-5 ? 0 : 1;
  }
  EXPECT_LE(off, 2);
}

// No two points differ by more in φ than they are apart: what the sweep of fast motion relies on.
TEST_P(ShapeDistances, GrowsNoFasterThanDistance) {
  for (int n = 0; n < 5000; ++n) {
    const Vec3d x = any(), y = n % 2 == 0 ? any() : x + (any(1e-3) - Vec3d{0, 0, 0.01});
    const double difference = distance_to(GetParam().shape, x).distance - distance_to(GetParam().shape, y).distance;
    ASSERT_LE(std::abs(difference), norm(x - y) * (1.0 + 1e-12) + 1e-15);
  }
}

// From outside, going back along the normal by φ ends on the surface: φ is the distance itself, not only a bound of it.
TEST_P(ShapeDistances, LeadsToTheSurface) {
  for (int n = 0; n < 1000; ++n) {
    const Vec3d x = any();
    const ShapeDistance d = distance_to(GetParam().shape, x);
    if (d.distance < 0.0) continue;
    const double there = distance_to(GetParam().shape, x - d.normal * d.distance).distance;
    if (GetParam().exact) {
      ASSERT_NEAR(there, 0.0, 1e-12);
    } else {
      ASSERT_GE(there, -1e-12);
    }
  }
}

// The tip is at the origin, or at the rim of a bevel, and below it is outside by as much as one goes down.
TEST_P(ShapeDistances, TipIsAtTheOrigin) {
  const std::string name = GetParam().name;
  if (name == "wall") return;
  const Vec3d tip = name == "bevel" ? Vec3d{0.005, 0.0, 0.0} : Vec3d{};
  EXPECT_NEAR(distance_to(GetParam().shape, tip).distance, 0.0, 1e-15);
  EXPECT_GT(distance_to(GetParam().shape, tip - Vec3d{0.0, 0.0, 1e-3}).distance, 0.0);
  EXPECT_LT(distance_to(GetParam().shape, {0.0, 0.0, 0.02 - 1e-3 * (name == "ball" ? 1 : 0)}).distance, 0.0);
}

INSTANTIATE_TEST_SUITE_P(All, ShapeDistances, testing::ValuesIn(kCases),
                         [](const auto& c) { return std::string(c.param.name); });

// A tool refuses a shape of sizes that cannot be, naming shape, size, value and what is allowed.
TEST(Shape, RefusesBadSizes) {
  const auto make = [](const Shape& shape) {
    return ContactTool({.shape = shape}, std::make_shared<PathDriver>(Pose{}, press_path({})));
  };
  const double nan = std::nan("");
  for (const Shape& s : std::initializer_list<Shape>{
           FlatPunch{.radius = 0.0}, FlatPunch{.radius = 0.01, .edge_radius = 0.02},
           FlatPunch{.radius = 0.01, .length = 0.0}, FlatPunch{.radius = nan}, Ball{.radius = -1.0},
           CylinderWall{.radius = nan}, NeedleShape{.diameter = 0.0},
           NeedleShape{.diameter = 0.01, .length = 0.01, .tip_angle = 0.1}, NeedleShape{.tip_angle = 0.0},
           NeedleShape{.tip = TipForm::bevelled, .tip_angle = 2.0}, Block{.size = {0.01, 0.0, 0.01}},
           Block{.size = {0.01, 0.01, 0.01}, .edge_radius = 0.006}}) {
    EXPECT_THROW(make(s), std::invalid_argument);
  }
  try {
    make(FlatPunch{.radius = 0.01, .edge_radius = 0.02});
    FAIL() << "an edge rounder than its punch was taken";
  } catch (const std::invalid_argument& e) {
    EXPECT_STREQ(
        e.what(),
        "contact tool \"tool\": shape (punch).edge_radius: 20 mm is above 10 mm, the radius or half the length; "
        "give a smaller one");
  }
}

}  // namespace
}  // namespace glisson::shape_test
