// Corners of motions: every motion that jumps in speed or turns says when, and long steps end there.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "glisson/instruments/contact.h"
#include "glisson/instruments/rigid_motion.h"
#include "glisson/instruments/tool_motion.h"
#include "support/bodies.h"

namespace glisson {
namespace {

std::vector<double> all(const CornerTimes& corners, double until) {
  std::vector<double> times;
  for (double t = corners.after(-1.0); t <= until; t = corners.after(t)) times.push_back(t);
  return times;
}

void expect_times(const CornerTimes& corners, const std::vector<double>& expected, double until = 100.0) {
  const std::vector<double> found = all(corners, until);
  ASSERT_EQ(found.size(), expected.size()) << testing::PrintToString(found);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-12) << i;
}

// A press jumps in acceleration where its ramp ends and in speed where it arrives, leaves and is back: 10 mm/s, 2 mm, ramp 0.1 s, rest
// 0.5 s. Its depth is v (t − ramp/2) after the ramp, so that it arrives at 0.2 + 0.05 s.
TEST(Corners, OfAPress) {
  const PressMotion m{.velocity = 0.01, .depth = 0.002, .start = 1.0, .ramp = 0.1, .hold = 0.5, .returns = true};
  expect_times(press(m).corners, {1.0, 1.1, 1.25, 1.75, 1.85, 2.0});
  expect_times(press({.velocity = 0.1, .depth = 0.003, .returns = true}).corners, {0.0, 0.03, 0.06});
}

// Strokes rise, run, fall and rest; a steady motion ends its ramp.
TEST(Corners, OfStrokesAndSteadyMotion) {
  const StrokeMotion m{.start = 0.5, .strokes = {{.to = {0, 0, -0.01}, .velocity = 0.01, .ramp = 0.2, .rest = 0.3}}};
  expect_times(stroke_path(m).displacement.corners, {0.5, 0.7, 1.5, 1.7});
  expect_times(steady_path({.start = 1.0, .ramp = 0.5}).displacement.corners, {1.0, 1.5});
}

// A sine turns every half period from its first quarter on, until it ends.
TEST(Corners, OfASine) {
  const SineMotion m{.frequency = 2.0, .start = 1.0, .ramp = 0.2, .duration = 1.0};
  expect_times(sine_path(m).displacement.corners, {1.0, 1.125, 1.2, 1.375, 1.625, 1.875, 2.0});
}

// A record has corners where it is not straight: the three points that turn a path of 601, and not the noise of 0.2 % on it.
TEST(Corners, OfARecordAreWhereItTurns) {
  RecordedMotion m{.times = {}, .positions = {}, .start = 2.0};
  for (int i = 0; i <= 600; ++i) {
    const double t = 0.001 * i, x = t < 0.2 ? t : (t < 0.4 ? 0.18 + 0.1 * t : 1.1 * (0.6 - t));
    m.times.push_back(5.0 + t);
    m.positions.push_back({0.0, 0.0, -0.01 * (x + (i % 2 == 0 ? 0.0004 : 0.0))});
  }
  expect_times(recorded_path(m).displacement.corners, {2.0, 2.2, 2.4, 2.6});
}

// A rotation has the corners of its press or table; poses those of places and turns, and what follows a path of both has both.
TEST(Corners, OfMotionsThatTurn) {
  const RotationMotion turn{.axis = {0, 0, 1}, .angle_deg = 60.0, .rate_deg_s = 120.0, .start = 0.25};
  expect_times(rotation_path(turn).pose.corners, {0.25, 0.75});
  const RotationMotion table{.axis = {0, 0, 1}, .times = {0.0, 0.1, 0.2, 0.5}, .angles_deg = {0.0, 1.0, 2.0, 0.0}};
  expect_times(rotation_path(table).pose.corners, {0.0, 0.2, 0.5});
  PosesMotion poses{.times = {1.0, 2.0, 3.0, 4.0},
                    .positions = {{}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}},
                    .quaternions = {},
                    .start = 0.0};
  for (const double half : {0.0, 0.0, 0.2, 0.4})
    poses.quaternions.push_back({std::cos(half), 0.0, 0.0, std::sin(half)});
  expect_times(poses_path(poses).pose.corners, {0.0, 1.0, 3.0});
}

// A function of a program's own has no corners; its driver none either.
TEST(Corners, OfAFunctionOfOnesOwnAreNone) {
  const Motion own = [](double t) { return Vec3d{0.0, 0.0, std::abs(t - 1.0)}; };
  EXPECT_EQ(own.corners.after(0.0), std::numeric_limits<double>::infinity());
  const PathDriver driver({}, {own, 2.0});
  EXPECT_EQ(driver.corners().after(0.0), std::numeric_limits<double>::infinity());
}

// Automatic steps of both implicit integrators end at every corner of motion, load, instrument and gravity and at the time asked for,
// and those between two corners are equal to the last bit, so that a factor is kept. Given steps do not change.
TEST(LongSteps, EndAtCorners) {
  for (const Integrator integrator : {Integrator::quasi_static, Integrator::implicit}) {
    const TetMesh mesh = test::paper_mesh();
    SimulationOptions o;
    o.integrator = integrator;
    o.implicit.largest_step = 0.05;
    o.gravity = {0.0, 0.0, -1.0};
    o.gravity_ramp = 0.31;
    Simulation s(mesh, {{0, Tissue{}}}, o);
    s.fix("z_min");
    s.drive(test::paper_triangle(), press({.velocity = 0.05, .depth = 0.003, .start = 0.1, .returns = true}), {}, 0.1);
    s.add_load("x_max", {0.001, 0.0, 0.0}, {[](double t) { return std::min(1.0, t / 0.37); }, CornerTimes({0.37})});
    Pose start;
    start.position = {0.02, 0.02, 0.13};
    s.attach(std::make_shared<ContactTool>(
        ContactOptions{.shape = Ball{0.005}},
        std::make_shared<PathDriver>(start, press_path({.velocity = 0.01, .depth = 0.001, .start = 0.0}))));
    std::vector<double> ends;
    while (s.time() < 0.45 - 1e-12) {
      s.set_step_end(0.45);
      ASSERT_EQ(s.step().status, StepStatus::ok);
      ends.push_back(s.time());
    }
    for (const double corner : {0.1, 0.16, 0.22, 0.31, 0.37, 0.45}) {
      EXPECT_NE(std::ranges::find_if(ends, [&](double t) { return std::abs(t - corner) < 1e-13; }), ends.end())
          << corner;
    }
    EXPECT_EQ(ends.back(), 0.45);
    EXPECT_EQ(ends.size(), 2u + 2u + 2u + 2u + 2u + 2u) << "none is longer than 0.05 s, and none a sliver";
  }
}

// Steps between two corners have the same bytes, whatever the sum of those before them rounds to.
TEST(LongSteps, BetweenCornersAreTheSame) {
  SimulationOptions o;
  o.integrator = Integrator::quasi_static;
  Simulation s(test::paper_mesh(), {{0, Tissue{}}}, o);
  s.fix("z_min");
  s.set_step_end(0.9);
  const double first = s.step_size();
  for (int i = 0; i < 18; ++i) {
    EXPECT_EQ(s.step_size(), first);
    ASSERT_EQ(s.step().status, StepStatus::ok);
  }
  EXPECT_EQ(s.time(), 0.9);
  EXPECT_EQ(s.step_size(), 0.05) << "nothing ends it any more";
}

}  // namespace
}  // namespace glisson
