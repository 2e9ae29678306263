// Capsules under variable mass scaling: their vertices get mass, and steps are those of the tissue.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "glisson/instruments/capsule.h"
#include "glisson/instruments/motion.h"
#include "glisson/simulation/simulation.h"
#include "support/bodies.h"
#include "support/must_step.h"

namespace glisson::heavy_capsule_test {
namespace {

struct Covered {
  Simulation simulation;
  std::shared_ptr<Capsule> capsule;
};

TetMesh block() { return box_mesh({.cells = {5, 5, 5}, .size = {0.02, 0.02, 0.02}, .split = BoxSplit::alternating}); }

Tissue soft() {
  Tissue tissue;
  tissue.youngs_modulus = 3000.0, tissue.poisson_ratio = 0.4;
  return tissue;
}

/// A block on its ground, its top covered by a sheet whose bare step is a quarter of that of the tissue.
Covered covered(const SimulationOptions& options, double stiffening = 0.0) {
  const TetMesh mesh = block();
  CapsuleOptions o;
  o.youngs_modulus = 2000.0 / o.thickness;
  o.stiffening = stiffening;
  o.vertices = mesh.vertex_sets.at("z_max");
  Covered c{Simulation(mesh, {{0, soft()}}, options), std::make_shared<Capsule>(o)};
  c.simulation.fix(mesh.vertex_sets.at("z_min"));
  c.simulation.attach(c.capsule);
  return c;
}

/// The middle of its top, which a press takes down.
std::vector<std::uint32_t> middle_of_top() {
  const TetMesh mesh = block();
  std::vector<std::uint32_t> middle;
  for (const std::uint32_t v : mesh.vertex_sets.at("z_max")) {
    const Vec3d d = mesh.vertices[v] - Vec3d{0.01, 0.01, 0.02};
    if (norm(d) < 0.004) middle.push_back(v);
  }
  return middle;
}

SimulationOptions heavy(SimulationOptions o, double times) {
  o.mass_scaling_step = times * Simulation(block(), {{0, soft()}}, o).step_size();
  o.mass_scaling = MassScalingKind::variable;
  return o;
}

// Pressed by 4 mm at 10 mm/s, the plain body's step is below a third of that of the tissue; with mass it is what was asked for. Forces
// on the way are those without within 2 % of the peak (1.2 and 1.5 measured; inertia of 2.5 % is borne). Held there, the sheet's added mass
// goes on swinging: its force is within 1 % of the plain one at every step (0.3 measured), and the mean of half a second, in which the swing
// has no share, within 1e-4 (1.3e-5 measured).
TEST(HeavyCapsule, StepsAreThoseOfTheTissue) {  // long
  SimulationOptions o;
  o.damping_rate = 50.0;
  for (const double stiffening : {0.0, 5.0}) {
    const SimulationOptions scaled = heavy(o, 0.9);
    Covered plain = covered(o, stiffening), with_mass = covered(scaled, stiffening);
    for (Covered* c : {&plain, &with_mass}) {
      c->simulation.drive(middle_of_top(), press({.velocity = 0.01, .depth = 0.004, .ramp = 0.1, .hold = 2.0}));
    }
    double apart = 0.0, peak = 0.0;
    for (double t = 0.05; t < 2.0; t += 0.05) {
      for (Covered* c : {&plain, &with_mass}) {
        while (c->simulation.time() < t) test::must_step(c->simulation);
      }
      const double force = plain.simulation.force({1}).elastic.z;
      apart = std::max(apart, std::abs(with_mass.simulation.force({1}).elastic.z - force));
      peak = std::max(peak, std::abs(force));
    }
    RecordProperty("apart", std::to_string(apart / peak));
    EXPECT_LT(apart, 0.02 * peak);
    EXPECT_LT(2.5 * static_cast<double>(with_mass.simulation.steps()), static_cast<double>(plain.simulation.steps()));
    const double force = plain.simulation.force({1}).total().z;
    double impulse = 0.0, swing = 0.0;
    const double from = with_mass.simulation.time();
    while (with_mass.simulation.time() < from + 0.5) {
      const double before = with_mass.simulation.time();
      test::must_step(with_mass.simulation);
      const double now = with_mass.simulation.force({1}).total().z;
      impulse += now * (with_mass.simulation.time() - before);
      swing = std::max(swing, std::abs(now - force));
    }
    RecordProperty("swing", std::to_string(swing / std::abs(force)));
    EXPECT_LT(swing, 0.01 * std::abs(force));
    EXPECT_NEAR(impulse / (with_mass.simulation.time() - from), force, 1e-4 * std::abs(force));
    EXPECT_NEAR(with_mass.simulation.step_size(), *scaled.mass_scaling_step, 1e-12);
    EXPECT_GT(with_mass.simulation.mass_scaling().present, 0.0);
    EXPECT_NEAR(with_mass.simulation.energies().imbalance(), 0.0, 1e-9 * with_mass.simulation.energies().work_tools);
  }
}

// A stretched sheet on undamped tissue, let go: it whips back, folds and stretches anew, and there is never more energy than at first,
// which is that of the sheet as it was set, too.
TEST(HeavyCapsule, DoesNotFeedASwing) {
  for (const double stiffening : {0.0, 5.0}) {
    Covered c = covered(heavy(test::in_double(), 1.5), stiffening);
    const TetMesh mesh = block();
    std::vector<Vec3d> u(mesh.vertices.size());
    for (std::size_t i = 0; i < u.size(); ++i) {
      const Vec3d& x = mesh.vertices[i];
      u[i] = Vec3d{x.x - 0.01, x.y - 0.01, 0.0} * (0.2 * x.z / 0.02);
    }
    c.simulation.set_state(u, std::vector<Vec3d>(u.size()));
    EXPECT_GT(c.capsule->energy(), 0.5 * c.simulation.energies().initial) << "the sheet has most of it";
    EXPECT_GT(c.simulation.mass_scaling().present, 0.0) << "from the first step on";
    double largest = 0.0;
    for (int i = 0; i < 3000; ++i) {
      test::must_step(c.simulation);
      const Energies e = c.simulation.energies();
      largest = std::max(largest, (e.elastic + e.kinetic) / e.initial);
    }
    RecordProperty("largest", std::to_string(largest));
    EXPECT_LT(largest, 1.01);
  }
}

// Same bytes on any number of threads, from a checkpoint on, and where the same state is set again.
TEST(HeavyCapsule, GivesTheSameBytes) {
  const auto body = [](int threads) {
    SimulationOptions o = heavy({}, 1.0);
    o.threads = threads;
    Covered c = covered(o, 5.0);
    c.simulation.drive(middle_of_top(), press({.velocity = 0.05, .depth = 0.006, .ramp = 0.02}));
    return c;
  };
  const auto run = [](Covered& c, int steps) {
    for (int i = 0; i < steps; ++i) test::must_step(c.simulation);
  };
  Covered one = body(1), two = body(2);
  run(one, 200), run(two, 200);
  EXPECT_EQ(one.simulation.state_hash(), two.simulation.state_hash());
  ASSERT_GT(one.simulation.mass_scaling().present, 0.0);
  std::stringstream saved;
  one.simulation.save(saved);
  run(one, 100);
  Covered again = body(1);
  run(again, 50);
  again.simulation.load(saved);
  run(again, 100);
  EXPECT_EQ(again.simulation.state_hash(), one.simulation.state_hash());
  EXPECT_EQ(again.simulation.mass_scaling().present, one.simulation.mass_scaling().present);
}

// The same state set again goes on in the same way, whatever has been in between: with mass and without.
TEST(HeavyCapsule, GoesOnTheSameFromTheSameState) {
  for (const bool with_mass : {true, false}) {
    Covered c = covered(with_mass ? heavy({}, 1.2) : SimulationOptions{}, 5.0);
    const TetMesh mesh = block();
    const auto from = [&](double stretch) {
      std::vector<Vec3d> u(mesh.vertices.size());
      for (std::size_t i = 0; i < u.size(); ++i)
        u[i].x = stretch * (mesh.vertices[i].x - 0.01) * mesh.vertices[i].z / 0.02;
      c.simulation.set_state(u, std::vector<Vec3d>(u.size()));
      for (int i = 0; i < 40; ++i) test::must_step(c.simulation);
      return std::vector<Vec3d>(c.simulation.displacement().begin(), c.simulation.displacement().end());
    };
    const std::vector<Vec3d> first = from(0.02);
    const std::vector<Vec3d> stretched = from(0.25);
    const std::vector<Vec3d> again = from(0.02);
    double apart = 0.0, between = 0.0;
    for (std::size_t i = 0; i < first.size(); ++i) {
      apart = std::max(apart, norm(first[i] - again[i])), between = std::max(between, norm(first[i] - stretched[i]));
    }
    EXPECT_EQ(apart, 0.0) << with_mass;
    EXPECT_GT(between, 1e-4);
  }
}

// Torn and opened by chance while it is heavy: nothing blows up and the books balance.
TEST(HeavyCapsule, GoesOnThroughTears) {
  Covered c = covered(heavy(test::in_double(), 1.2), 5.0);
  Simulation& s = c.simulation;
  s.drive(middle_of_top(), press({.velocity = 0.05, .depth = 0.006, .ramp = 0.02, .hold = 1.0}));
  while (s.time() < 0.06) test::must_step(s);
  for (std::size_t t = 0; t < c.capsule->triangles().size(); t += 3) {
    c.capsule->tear(t);
    for (int i = 0; i < 20; ++i) test::must_step(s);
    for (const Vec3d& v : s.velocity()) ASSERT_LT(norm(v), 2.0) << t;
  }
  s.remove_tets(std::vector<std::uint32_t>{300, 301, 302});
  for (int i = 0; i < 200; ++i) test::must_step(s);
  EXPECT_LE(std::abs(s.energies().imbalance()), 1e-9 * s.energies().work_tools);
}

}  // namespace
}  // namespace glisson::heavy_capsule_test
