// Paths of tools are where they say at their corners, keep their speed continuous, end when they say, and pass through
// what was measured.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "glisson/instruments/tool_motion.h"

namespace glisson {
namespace {

const Vec3d kDown{0, 0, -1};

/// What a factory throws, or nothing.
template <class Make>
std::string refusal(Make make) {
  try {
    make();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

/// Largest change of velocity between samples, over the acceleration that is allowed: about 1 for a path that is C¹.
double velocity_jump(const ToolPath& path, double end, double acceleration) {
  constexpr double kApart = 1e-4;
  double worst = 0.0;
  for (double t = kApart; t < end; t += kApart) {
    const Vec3d a = (path.displacement(t + kApart) - path.displacement(t) * 2.0 + path.displacement(t - kApart)) *
                    (1.0 / (kApart * kApart));
    worst = std::max(worst, norm(a) / acceleration);
  }
  return worst;
}

// A driver moves its pose by the way at the end of the step, and keeps how the tool is turned.
TEST(PathDriver, GoesTheWayFromItsStart) {
  Pose start{.position = {0.1, 0.2, 0.3}, .axes = identity<double>()};
  start.axes(0, 0) = -1.0;
  start.axes(1, 1) = -1.0;
  PathDriver driver(start, steady_path({.velocity = 0.02}));
  const Pose pose = driver.advance(1.0, 0.5, {});
  EXPECT_NEAR(norm(pose.position - Vec3d{0.1, 0.2, 0.27}), 0.0, 1e-15);
  EXPECT_EQ(pose.axes, start.axes);
  EXPECT_FALSE(driver.end().has_value());
}

// A steady motion with a ramp lags half the ramp behind one without.
TEST(SteadyMotion, RampsUp) {
  const ToolPath path = steady_path({.velocity = 0.01, .start = 1.0, .ramp = 0.5});
  EXPECT_EQ(path.displacement(1.0), (Vec3d{0, 0, 0}));
  EXPECT_NEAR(path.displacement(1.5).z, -0.0025, 1e-15);
  EXPECT_NEAR(path.displacement(2.0).z, -0.0075, 1e-15);
}

// Insert, rest, aside, withdraw: each corner is met exactly at its time, speed never jumps, and the motion ends when it
// says: 0.03/0.01 + 0.1 ramp, 2 s rest, 0.004/0.002 + 0.1, and √(0.03² + 0.004²)/0.02 + 0.05.
TEST(StrokeMotion, MeetsItsCorners) {
  StrokeMotion motion{.start = 0.5, .strokes = {}};
  motion.strokes.push_back({.to = kDown * 0.03, .velocity = 0.01, .ramp = 0.1, .rest = 2.0});
  motion.strokes.push_back({.to = {0.004, 0, -0.03}, .velocity = 0.002, .ramp = 0.1});
  motion.strokes.push_back({.to = {}, .velocity = 0.02, .ramp = 0.05});
  const ToolPath path = stroke_path(motion);
  EXPECT_EQ(path.displacement(0.5), (Vec3d{}));
  EXPECT_NEAR(norm(path.displacement(3.6) - kDown * 0.03), 0.0, 1e-15);
  EXPECT_NEAR(norm(path.displacement(5.6) - kDown * 0.03), 0.0, 1e-15);
  EXPECT_NEAR(norm(path.displacement(7.7) - Vec3d{0.004, 0, -0.03}), 0.0, 1e-15);
  EXPECT_NEAR(*path.end, 7.7 + std::hypot(0.03, 0.004) / 0.02 + 0.05, 1e-12);
  EXPECT_NEAR(norm(path.displacement(*path.end)), 0.0, 1e-15);
  EXPECT_NEAR(norm(path.displacement(*path.end - 1e-3)), 0.0, 0.02 * 1e-3) << "and not earlier at rest by a jump";
  // 0.02/0.05 m/s² is the steepest ramp; differences of second order see twice that where a ramp begins within a sample.
  EXPECT_LT(velocity_jump(path, *path.end + 0.1, 0.02 / 0.05), 1.01);
}

// A move too short for its ramp peaks below its speed and still arrives: t = 2 √(L r / v).
TEST(StrokeMotion, ShortMovesArrive) {
  StrokeMotion motion{.start = 0.0, .strokes = {{.to = kDown * 1e-4, .velocity = 0.01, .ramp = 1.0}}};
  const ToolPath path = stroke_path(motion);
  EXPECT_NEAR(*path.end, 0.2, 1e-12);
  EXPECT_NEAR(path.displacement(0.1).z, -0.5e-4, 1e-15);
  EXPECT_NEAR(path.displacement(0.2).z, -1e-4, 1e-15);
}

// Without a ramp the first stroke is the press of the same speed and depth.
TEST(StrokeMotion, OneStrokeIsAPress) {
  StrokeMotion motion{.start = 0.2, .strokes = {{.to = kDown * 0.02, .velocity = 0.01, .rest = 1.0}}};
  const ToolPath stroke = stroke_path(motion);
  const ToolPath pressed = press_path({.velocity = 0.01, .depth = 0.02, .start = 0.2, .hold = 1.0});
  EXPECT_DOUBLE_EQ(*stroke.end, *pressed.end);
  for (double t = 0.0; t < 4.0; t += 0.037)
    EXPECT_NEAR(stroke.displacement(t).z, pressed.displacement(t).z, 1e-15) << t;
}

// A sine comes up smoothly about its mean, has its amplitude and frequency then, and rests at its end.
TEST(SineMotion, SwingsAboutItsMean) {
  const SineMotion m{.amplitude = 0.002, .frequency = 2.0, .mean = 0.003, .start = 0.1, .ramp = 0.5, .duration = 3.0};
  const ToolPath path = sine_path(m);
  EXPECT_EQ(path.displacement(0.1), (Vec3d{}));
  for (double t = 0.7; t < 3.1; t += 0.01) {
    EXPECT_NEAR(path.displacement(t).z, -0.003 - 0.002 * std::sin(4.0 * std::numbers::pi * (t - 0.1)), 1e-15);
  }
  EXPECT_EQ(path.displacement(3.1), path.displacement(9.0));
  EXPECT_DOUBLE_EQ(*path.end, 3.1);
  EXPECT_LT(velocity_jump(path, 3.0, 0.002 * 16 * std::pow(std::numbers::pi, 2)), 3.0) << "of the order of A ω²";
}

RecordedMotion record(int points, double seconds) {
  RecordedMotion m;
  for (int i = 0; i < points; ++i) {
    const double t = seconds * i / (points - 1);
    m.times.push_back(t);
    m.positions.push_back({std::sin(t), 1.0 - std::cos(2.0 * t), t * t});
  }
  return m;
}

// A record is gone through its own points, from the first one on, at its times.
TEST(RecordedMotion, PassesThroughItsPoints) {
  RecordedMotion m = record(20, 3.0);
  m.start = 0.75;
  const ToolPath path = recorded_path(m);
  for (std::size_t i = 0; i < m.times.size(); ++i) {  // up to 9 m, an ulp of which is 1.8e-15
    EXPECT_NEAR(norm(path.displacement(m.times[i] + 0.75) - (m.positions[i] - m.positions[0])), 0.0, 4e-15) << i;
  }
  EXPECT_DOUBLE_EQ(*path.end, 3.75);
  EXPECT_EQ(path.displacement(0.0), (Vec3d{}));
  EXPECT_EQ(path.displacement(99.0), path.displacement(3.75));
}

// Where the way is smooth and monotone the error falls as h³ or better with the distance of its points: halving takes it
// to less than 1/6. (Second order, as of straight lines, would be 1/4.)
TEST(RecordedMotion, ConvergesFasterThanStraightLines) {
  const auto error = [](int points) {
    const ToolPath path = recorded_path(record(points, 1.2));
    double worst = 0.0;
    for (double t = 0.2; t < 1.0; t += 0.0013) {
      worst = std::max(worst, norm(path.displacement(t) - Vec3d{std::sin(t), 1.0 - std::cos(2.0 * t), t * t}));
    }
    return worst;
  };
  EXPECT_LT(error(41), error(21) / 6.0);
  EXPECT_LT(error(81), error(41) / 6.0);
}

// A tool that stood still does not creep or swing back: a step in the record stays between its two values, and the speed is
// continuous.
TEST(RecordedMotion, NeverOvershoots) {
  const RecordedMotion m{.times = {0, 1, 1.2, 2, 3}, .positions = {{}, {}, kDown * 0.01, kDown * 0.01, kDown * 0.02}};
  const ToolPath path = recorded_path(m);
  for (double t = 0.0; t < 3.0; t += 1e-3) {
    const double depth = -path.displacement(t).z, low = t < 1.0 ? 0.0 : (t < 1.2 ? 0.0 : 0.01);
    const double high = t < 1.0 ? 0.0 : (t < 2.0 ? 0.01 : 0.02);
    EXPECT_GE(depth, low - 1e-15) << t;
    EXPECT_LE(depth, high + 1e-15) << t;
  }
  EXPECT_LT(velocity_jump(path, 2.9, 6.0 * 0.01 / 0.04), 1.5) << "cubics over 0.2 s: 6 Δ/w² at most";
}

// What cannot be a motion is refused, naming the field and what it may be.
TEST(ToolPath, RefusesWhatIsNone) {
  EXPECT_NE(refusal([] { steady_path({.velocity = 0.0}); }).find("velocity [m/s] = 0"), std::string::npos);
  EXPECT_NE(refusal([] { steady_path({.direction = {}}); }).find("no length"), std::string::npos);
  EXPECT_NE(refusal([] { steady_path({.ramp = -1.0}); }).find("ramp"), std::string::npos);
  EXPECT_NE(refusal([] { stroke_path({}); }).find("none were given"), std::string::npos);
  EXPECT_NE(refusal([] { stroke_path({.start = 0.0, .strokes = {{.to = kDown, .velocity = -1.0}}}); }).find("velocity"),
            std::string::npos);
  EXPECT_NE(refusal([] { sine_path({.frequency = 0.0}); }).find("frequency"), std::string::npos);
  EXPECT_NE(refusal([] { sine_path({.duration = std::nan("")}); }).find("duration"), std::string::npos);
  EXPECT_NE(refusal([] { recorded_path({.times = {0}, .positions = {{}}}); }).find("two or more"), std::string::npos);
  EXPECT_NE(refusal([] {
              recorded_path({.times = {0, 0}, .positions = {{}, {}}});
            }).find("point 1"),
            std::string::npos);
  EXPECT_NE(refusal([] { PathDriver({}, {}); }).find("no displacement"), std::string::npos);
}

}  // namespace
}  // namespace glisson
