// Linear finite elements in their modes: all of them are the body, fewer are the nearer the more there are, and what the correction knows is exact.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "compare/experiments.h"

namespace glisson::models {
namespace {

const Stop kGoing{false};

/// A block held below, its top turned about the vertical: no translation of the tool, which the correction would know.
Problem turned_top() {
  Problem p = cube({3, 3, 3});
  p.supports.push_back({p.mesh.vertex_set("z_min"), {}});
  const auto turn = [](double t) {
    const double a = 0.1 * std::min(1.0, t);
    Pose pose;
    pose.axes = {{{{std::cos(a), -std::sin(a), 0}, {std::sin(a), std::cos(a), 0}, {0, 0, 1}}}};
    pose.position = Vec3d{kEdge / 2, kEdge / 2, 0} - pose.axes * Vec3d{kEdge / 2, kEdge / 2, 0};
    return pose;
  };
  p.tools.push_back({p.mesh.vertex_set("z_max"), {}, PoseMotion(turn)});
  p.moment_about = Vec3d{kEdge / 2, kEdge / 2, 0};
  return p;
}

double difference(const Answer& a, const Answer& b) {
  double sum = 0.0, all = 0.0;
  for (std::size_t v = 0; v < a.displacement.size(); ++v) {
    sum += dot(a.displacement[v] - b.displacement[v], a.displacement[v] - b.displacement[v]);
    all += dot(b.displacement[v], b.displacement[v]);
  }
  return std::sqrt(sum / all);
}

// All modes are the body to rounding: its displacement, and the moment at the tool.
TEST(LinearFemModal, AllModesAreTheBody) {
  const Problem p = turned_top();
  const Answer whole = linear_fem(p, {}, kGoing), modes = linear_fem_modal(p, {0, 100000}, kGoing);
  ASSERT_EQ(modes.forces.size(), whole.forces.size()) << modes.trouble;
  EXPECT_LE(difference(modes, whole), 1e-10);
  EXPECT_LE(norm(modes.forces[1] - whole.forces[1]), 1e-9 * norm(whole.forces[1]));
}

// With more modes the energy of the error never grows, and with 40 of some hundred most of it is gone.
TEST(LinearFemModal, ErrorFallsWithTheNumberOfModes) {
  const Problem p = turned_top();
  const Answer whole = linear_fem(p, {}, kGoing);
  double before = 1.0;
  const double first = norm(linear_fem_modal(p, {0, 2}, kGoing).forces[1] - whole.forces[1]);
  for (const int count : {2, 10, 20, 40}) {
    const Answer modes = linear_fem_modal(p, {0, count}, kGoing);
    const double error = norm(modes.forces[1] - whole.forces[1]) / first;
    EXPECT_LE(error, before * (1.0 + 1e-9)) << count;
    before = error;
  }
  EXPECT_LT(before, 0.5);
}

// A tool that moves without turning, and weight, are answered exactly by a single mode: by its static correction.
TEST(LinearFemModal, WhatTheCorrectionKnowsIsExact) {
  Problem p = cube({3, 3, 3});
  p.motion.gravity = {0, -2.0, 0};
  p.supports.push_back({p.mesh.vertex_set("z_min"), {}});
  p.tools.push_back({p.mesh.vertex_set("z_max"), {}, ramp_to({0.001, 0, -0.002}, 1.0)});
  const Answer whole = linear_fem(p, {}, kGoing), modes = linear_fem_modal(p, {0, 1}, kGoing);
  ASSERT_EQ(modes.forces.size(), 2U) << modes.trouble;
  EXPECT_LE(difference(modes, whole), 1e-10);
  EXPECT_LE(norm(modes.forces[1] - whole.forces[1]), 1e-9 * norm(whole.forces[1]));
}

}  // namespace
}  // namespace glisson::models
