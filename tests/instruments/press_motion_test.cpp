// The press: constant speed from the first instant, or a ramp; hold; return; exact depths at the corners.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "glisson/instruments/motion.h"

namespace glisson {
namespace {

// As in the paper: full speed at once, depth v t, at rest at the depth.
TEST(PressMotion, ConstantSpeed) {
  const PressMotion m{.velocity = 0.01, .depth = 0.02};
  EXPECT_DOUBLE_EQ(press_depth(m, 0.0), 0.0);
  EXPECT_DOUBLE_EQ(press_depth(m, 1.0), 0.01);
  EXPECT_DOUBLE_EQ(press_depth(m, 3.0), 0.02);
  EXPECT_DOUBLE_EQ(press_end(m), 2.0);
}

// A ramp reaches the depth half a ramp later, with the speed continuous.
TEST(PressMotion, RampHoldReturn) {
  const PressMotion m{.velocity = 0.01, .depth = 0.02, .start = 1.0, .ramp = 0.5, .hold = 0.25, .returns = true};
  EXPECT_DOUBLE_EQ(press_depth(m, 1.0), 0.0);
  EXPECT_DOUBLE_EQ(press_depth(m, 1.5), 0.0025);
  EXPECT_NEAR((press_depth(m, 1.5 + 1e-6) - press_depth(m, 1.5 - 1e-6)) / 2e-6, 0.01, 1e-6);
  EXPECT_DOUBLE_EQ(press_depth(m, 3.25), 0.02);
  EXPECT_DOUBLE_EQ(press_depth(m, 3.5), 0.02);
  EXPECT_DOUBLE_EQ(press_depth(m, 3.5 + 2.25), 0.0);
  EXPECT_DOUBLE_EQ(press_end(m), 5.75);
}

// A depth that is reached within the ramp is met exactly and not overshot.
TEST(PressMotion, ShallowDepthWithinTheRamp) {
  const PressMotion m{.velocity = 0.01, .depth = 0.001, .ramp = 1.0};
  EXPECT_NEAR(press_end(m), std::sqrt(0.2), 1e-12);
  EXPECT_NEAR(press_depth(m, press_end(m)), 0.001, 1e-15);
  EXPECT_DOUBLE_EQ(press_depth(m, 10.0), 0.001);
}

// The displacement is along the unit direction.
TEST(PressMotion, DirectionNeedNotBeAUnitVector) {
  const Vec3d u = press({.direction = {3.0, 0.0, -4.0}, .velocity = 0.01, .depth = 0.05})(1.0);
  EXPECT_NEAR(u.x, 0.006, 1e-15);
  EXPECT_NEAR(u.z, -0.008, 1e-15);
}

// Each precondition is refused with its name and value.
TEST(PressMotion, RefusesWhatMeansNothing) {
  const auto message = [](const PressMotion& m) -> std::string {
    try {
      press(m);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_NE(message({.velocity = 0.0}).find("velocity [m/s] = 0"), std::string::npos);
  EXPECT_NE(message({.depth = -1.0}).find("depth [m] = -1"), std::string::npos);
  EXPECT_NE(message({.start = -1.0}).find("start [s] = -1"), std::string::npos);
  EXPECT_NE(message({.ramp = -1.0}).find("ramp [s] = -1"), std::string::npos);
  EXPECT_NE(message({.hold = -1.0}).find("hold [s] = -1"), std::string::npos);
  EXPECT_NE(message({.direction = {0, 0, 0}}).find("direction: (0, 0, 0) has no length"), std::string::npos);
}

}  // namespace
}  // namespace glisson
