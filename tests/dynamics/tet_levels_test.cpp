// Steps of bodies in which single tets are squashed: they come back, do not depend on threads or on what was before a state was
// set, go on from a checkpoint, and follow tets that go.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "glisson/instruments/motion.h"
#include "support/bodies.h"
#include "support/must_step.h"

namespace glisson {
namespace {

Tissue neo_hooke() {
  Tissue t;
  t.hyperelastic = NeoHookean{.mu = t.lame().mu, .bulk_modulus = t.lame().lambda + 2.0 / 3.0 * t.lame().mu};
  return t;
}

/// A block of which one inner vertex is moved nine tenths of a cell up: the tets above it are squashed to a tenth.
struct Dented {
  TetMesh mesh = box_mesh({.cells = {6, 6, 6}, .size = {0.06, 0.06, 0.06}});
  std::vector<Vec3d> u = std::vector<Vec3d>(mesh.vertices.size()), v = u;
  Dented() {
    for (std::size_t i = 0; i < u.size(); ++i) {
      if (norm(mesh.vertices[i] - Vec3d{0.03, 0.03, 0.03}) < 1e-9) u[i].z = 0.009;
    }
  }
};

SimulationOptions damped() {
  SimulationOptions o;
  o.damping_rate = 50.0;
  return o;
}

// Squashed tets hold the step while they are, by far less than if all of the body were as stiff; when they have stood up it is what it
// was. No energy comes from anywhere.
TEST(TetLevels, StepComesBackWhenSquashedTetsRecover) {
  const Dented d;
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    SimulationOptions o = damped();
    o.precision = precision;
    Simulation s(d.mesh, {{0, neo_hooke()}}, o);
    const double at_rest = s.step_size();
    s.set_state(d.u, d.v);
    const double stored = s.energies().elastic;
    ASSERT_EQ(s.step().status, StepStatus::ok);
    const double squashed = s.step_size();
    EXPECT_LT(squashed, 0.7 * at_rest);
    EXPECT_GT(squashed, 0.1 * at_rest) << "a body as stiff throughout has a twentieth";
    double most = 0.0;
    while (s.time() < 0.5) {
      ASSERT_EQ(s.step().status, StepStatus::ok);
      most = std::max(most, s.energies().kinetic + s.energies().elastic);
    }
    EXPECT_LE(most, 1.001 * stored);
    // the bound is 1/1.2 = 0.833 of it, 0.87 is found: a bar lower would let a level stay
    EXPECT_GT(s.step_size(), 0.8 * at_rest) << "a room of 1.2 squared in stiffness may be left";
    EXPECT_LE(std::abs(s.energies().imbalance()), 1e-6 * stored);
  }
}

// A state that is set makes the same steps as in a body made for it, whatever steps were before.
TEST(TetLevels, StateThatIsSetForgetsWhatWasBefore) {
  const Dented d;
  Simulation fresh(d.mesh, {{0, neo_hooke()}}, damped()), used(d.mesh, {{0, neo_hooke()}}, damped());
  used.set_state(d.u, d.v);
  for (int i = 0; i < 40; ++i) test::must_step(used);
  for (const auto* u : {&d.v, &d.u}) {  // at rest and dented
    used.set_state(*u, d.v), fresh.set_state(*u, d.v);
    for (int i = 0; i < 300; ++i) {
      ASSERT_EQ(used.step_size(), fresh.step_size()) << i;
      ASSERT_EQ(used.step().status, fresh.step().status);
    }
    EXPECT_EQ(used.state_hash(), fresh.state_hash());
    EXPECT_EQ(used.stable_step(), fresh.stable_step());
    fresh = Simulation(d.mesh, {{0, neo_hooke()}}, damped());
  }
}

// The same bytes on any number of threads, steps included, while tets come and go from levels of their own.
TEST(TetLevels, DoNotDependOnThreads) {
  const TetMesh mesh = box_mesh({.cells = {12, 12, 12}, .size = {0.12, 0.12, 0.12}});
  std::vector<std::uint64_t> hashes;
  std::vector<double> times;
  for (const int threads : {1, 2, 3}) {
    SimulationOptions o = damped();
    o.threads = threads;
    Simulation s(mesh, {{0, neo_hooke()}}, o);
    s.fix(mesh.vertex_sets.at("z_min"));
    s.drive({{6 + 13 * (6 + 13 * 12)}}, press({.velocity = 0.5, .depth = 0.05}));
    for (int i = 0; i < 150; ++i) ASSERT_LE(s.step().status, StepStatus::inverted);
    hashes.push_back(s.state_hash());
    times.push_back(s.time());
  }
  EXPECT_EQ(hashes, std::vector<std::uint64_t>(3, hashes[0]));
  EXPECT_EQ(times, std::vector<double>(3, times[0]));
}

// A run that goes on from a checkpoint has the bytes of the whole one, with levels as they were; saved at every stage.
TEST(TetLevels, ContinueFromACheckpointToTheByte) {
  const Dented d;
  for (const int first : {0, 1, 17, 100}) {
    Simulation whole(d.mesh, {{0, neo_hooke()}}, damped()), continued(d.mesh, {{0, neo_hooke()}}, damped());
    whole.set_state(d.u, d.v);
    for (int i = 0; i < first; ++i) test::must_step(whole);
    std::stringstream file;
    whole.save(file);
    continued.load(file);
    EXPECT_EQ(continued.step_size(), whole.step_size()) << first;
    for (int i = 0; i < 200; ++i) test::must_step(whole), test::must_step(continued);
    EXPECT_EQ(continued.state_hash(), whole.state_hash()) << first;
    EXPECT_EQ(continued.step_size(), whole.step_size()) << first;
  }
}

// Squashed tets that are removed hold the step no longer, and steps stay stable; so with another tissue in their place.
TEST(TetLevels, FollowRemovalAndTissue) {
  const Dented d;
  Simulation s(d.mesh, {{0, neo_hooke()}}, damped());
  const double at_rest = s.step_size();
  s.set_state(d.u, d.v);
  test::must_step(s);
  std::vector<std::uint32_t> squashed;
  for (std::uint32_t t = 0; t < d.mesh.tets.size(); ++t) {
    for (const std::uint32_t v : d.mesh.tets[t]) {
      if (d.u[v].z > 0.0) squashed.push_back(t);
    }
  }
  Simulation other(d.mesh, {{0, neo_hooke()}}, damped());
  other.set_state(d.u, d.v);
  test::must_step(other);
  const double before = s.step_size();
  s.remove_tets(squashed);
  while (s.steps() < 100) ASSERT_EQ(s.step().status, StepStatus::ok);
  EXPECT_GT(s.step_size(), 1.2 * before);
  Tissue soft;
  soft.youngs_modulus *= 0.25;
  other.set_tissue(0, soft);
  EXPECT_GT(other.step_size(), 1.9 * at_rest)
      << "a linear tissue has no level; at a quarter of the stiffness twice the step";
  while (other.time() < 0.2) ASSERT_LE(other.step().status, StepStatus::inverted);
}

}  // namespace
}  // namespace glisson
