// The viscous force in stages: what they leave of a velocity, the true limit of the step, the explicit scheme's answers at longer
// steps.
#include "element/drag_stages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <sstream>

#include "dynamics/figure3a.h"
#include "glisson/instruments/motion.h"
#include "material/reference/reference.h"
#include "support/bodies.h"
#include "support/must_step.h"
#include "support/spectral_radius.h"

namespace glisson::drag_stages_test {
namespace {

using test::case_name;
using test::viscous;
using Case = test::ViscousCase;

SimulationOptions in_stages(int stages, Precision precision = Precision::single_precision) {
  SimulationOptions o;
  o.drag_stages = stages;
  o.precision = precision;
  return o;
}

// Π (1 − τ_k z) is [1 + T_n(a − b z)]/(2 + ε): in [0, 1] up to the end, which is nearly n², with slope −1 at 0. Past the first fall of T_n it
// is never above 2/(2 + ε): no motion is left as it was.
TEST(DragStages, LeaveChebyshevsPolynomial) {
  for (int n = 2; n <= kMostDragStages; ++n) {
    const std::vector<double> stages = drag_stages(n);
    ASSERT_EQ(stages.size(), static_cast<std::size_t>(n));
    double sum = 0.0;
    for (const double tau : stages) sum += tau;
    EXPECT_NEAR(sum, 1.0, 1e-13) << n << " stages";
    const DragPolynomial R(n);
    EXPECT_NEAR(R.end() / (n * n), 0.94, 0.02);
    for (int i = 0; i <= 1000; ++i) {
      const double z = R.end() * i / 1000.0;
      double left = 1.0;
      for (const double tau : stages) left *= 1.0 - tau * z;
      EXPECT_NEAR(left, R(z), 1e-11) << n << " stages, z = " << z;
      EXPECT_GE(left, -1e-11);
      EXPECT_LE(left, z < (R.a - 1.0) / R.b ? 1.0 : 2.0 / (2.0 + kStageDamping) + 1e-11);
    }
  }
  EXPECT_EQ(drag_stages(1), std::vector<double>{1.0});
}

// From u = 0 nothing but drag acts: the velocity after a step is Π (1 − τ_k h M⁻¹ C) v₋, with C of the executable specification.
TEST(DragStages, AStepIsTheProductOfItsStages) {
  std::mt19937 random(3);
  const TetMesh mesh = test::jittered_box({3, 2, 2}, 0.01, 0.2, random);
  const Tissue tissue = viscous(40.0, ViscousTensor::deviatoric);
  for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
    for (const int n : {2, 3, 5}) {
      SimulationOptions o = in_stages(n, precision);
      o.step = 0.9 * Simulation(mesh, {{0, tissue}}, o).stable_step();
      Simulation s(mesh, {{0, tissue}}, o);
      const std::vector<Vec3d> v = test::random_field(mesh.vertices.size(), 0.01, random);
      s.set_state(std::vector<Vec3d>(v.size()), v);
      test::must_step(s);
      std::vector<Vec3d> w = v;
      for (const double tau : drag_stages(n)) {
        const std::vector<Vec3d> force =
            reference::mesh_forces(mesh, {{0, tissue}}, std::vector<Vec3d>(v.size()), w).viscous;
        for (std::size_t i = 0; i < w.size(); ++i) w[i] += force[i] * (tau * *o.step / s.masses()[i]);
      }
      const double allowed = precision == Precision::double_precision ? 1e-12 : 1e-5;
      EXPECT_LE(test::relative_difference(s.velocity(), w), allowed) << n << " stages";
    }
  }
}

class DragLimit : public testing::TestWithParam<Case> {};

// A step just below h* magnifies nothing (rigid motions are double eigenvalues at 1, which rounding splits by √ε).
TEST_P(DragLimit, MagnifiesNothing) {
  const Case& c = GetParam();
  std::mt19937 random(8);
  const TetMesh mesh = test::jittered_box({1, 1, 2}, 0.01, 0.0, random);
  SimulationOptions o = in_stages(c.stages);
  o.damping_rate = c.damping_rate;
  EXPECT_LE(test::spectral_radius(mesh, c.tissue(), o, 0.999), 1.0 + 1e-5);
}
INSTANTIATE_TEST_SUITE_P(DragStages, DragLimit,
                         testing::Values(Case{"mild", 0.3, ViscousTensor::shear, 50.0, 2},
                                         Case{"middling", 10.0, ViscousTensor::shear, 0.0, 2},
                                         Case{"three", 10.0, ViscousTensor::deviatoric, 0.0, 3},
                                         Case{"proportional", 10.0, ViscousTensor::proportional, 0.0, 3},
                                         Case{"damped", 30.0, ViscousTensor::shear, 200.0, 4},
                                         Case{"thick", 1000.0, ViscousTensor::shear, 0.0, 8}),
                         case_name);

// Where drag is all, two stages magnify where their polynomial does, at 2a/b: 6 % above h*.
TEST(DragStages, LimitIsSharpWhereDragIsAll) {
  std::mt19937 random(8);
  const TetMesh mesh = test::jittered_box({1, 1, 2}, 0.01, 0.0, random);
  const DragPolynomial R(2);
  const double above = 2.0 * R.a / (R.b * R.end());
  EXPECT_LT(above, 1.06);
  EXPECT_LE(test::spectral_radius(mesh, viscous(1000.0), in_stages(2), 0.99 * above), 1.0 + 1e-5);
  EXPECT_GE(test::spectral_radius(mesh, viscous(1000.0), in_stages(2), 1.02 * above), 1.01);
}

// n stages bear nearly n²/2 times the step of one, until stiffness has the word: then 0.946 of the elastic body's for four.
TEST(DragStages, StepGrowsWithTheSquareOfTheirNumber) {
  const TetMesh mesh = test::paper_mesh();
  const double one = Simulation(mesh, {{0, viscous(1000.0)}}, {}).stable_step();
  for (const int n : {2, 4, 8}) {
    const double times = 0.5 * DragPolynomial(n).end();
    EXPECT_NEAR(Simulation(mesh, {{0, viscous(1000.0)}}, in_stages(n)).stable_step(), times * one, 0.02 * times * one);
  }
  const double elastic = Simulation(mesh, {{0, Tissue{}}}, {}).stable_step();
  EXPECT_NEAR(Simulation(mesh, {{0, viscous(1.0)}}, in_stages(4)).stable_step(), 0.946 * elastic, 1e-3 * elastic);
}

// Figure 3a, η = 1000 Pa·s: eight stages at 32 times the explicit step give its forces within 0.2 % of the peak from 5 ms on. Before,
// the tool gets up to speed within 2 ms, seven of their steps: 4.4 % of the peak, where two stages, of 1.9 times the step, have 0.24 %.
TEST(DragStages, FollowFigure3a) {  // long
  const test::PressRun reference = test::figure3a({});
  const auto follow = [&](int stages, double at_the_start) {
    const test::PressRun staged = test::figure3a(in_stages(stages));
    const double apart = test::apart(staged, reference), start = test::apart_at_the_start(staged, reference);
    const std::string of = std::to_string(stages) + "_stages_";
    RecordProperty(of + "apart_percent_of_peak", std::to_string(100.0 * apart));
    RecordProperty(of + "start_percent_of_peak", std::to_string(100.0 * start));
    RecordProperty(of + "cost_ratio", std::to_string(reference.seconds / staged.seconds));
    EXPECT_LE(apart, 0.002) << stages << " stages";
    EXPECT_LE(start, at_the_start) << stages << " stages";
  };
  follow(2, 0.004), follow(8, 0.06);
}

/// Tissue with a law, branches, viscosity and a second region that does not drag, under a press and gravity.
Simulation busy_body(SimulationOptions o, TetMesh mesh = test::paper_mesh()) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) mesh.regions.push_back(static_cast<int>(t % 4));
  Tissue law = viscous(60.0), relaxing = viscous(20.0), linear = viscous(100.0), dry;
  law.law = LinearLaw{20000.0};
  relaxing.law = LinearLaw{10000.0};
  relaxing.maxwell = {{0.3, 0.1}, {0.2, 1.0}};
  dry.law = ExponentialLaw{.amplitude = 500.0, .rate = 6.0};
  o.gravity = {0.0, 0.0, -9.81};
  o.gravity_ramp = 0.1;
  o.damping_rate = 5.0;
  Simulation s(mesh, {{0, law}, {1, relaxing}, {2, linear}, {3, dry}}, o);
  s.fix(mesh.vertex_sets.at("z_min"));
  s.drive(test::paper_triangle(), press({.velocity = 0.05, .depth = 0.01, .hold = 1.0}));
  return s;
}

// The books are exact, in float and in double, and both see the same forces.
TEST(DragStages, BooksAreExact) {
  std::vector<double> force;
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    SimulationOptions o = in_stages(3, precision);
    o.step = 2e-4;
    Simulation s = busy_body(o);
    while (s.time() < 0.25) test::must_step(s);
    const Energies e = s.energies();
    EXPECT_LE(std::abs(e.imbalance()), 1e-10 * (std::abs(e.elastic) + e.dissipated));
    EXPECT_GT(e.dissipated, 0.0);
    EXPECT_LT(e.kinetic, 0.1 * e.dissipated) << "nothing has begun to swing";
    force.push_back(s.force({1}).total().z);
    force.push_back(s.force({1}).viscous.z);
  }
  EXPECT_NEAR(force[0], force[2], 1e-4 * std::abs(force[2]));
  EXPECT_NEAR(force[1], force[3], 1e-4 * std::abs(force[2]));
}

// A free body keeps its momentum: stages are inner forces.
TEST(DragStages, KeepMomentum) {
  std::mt19937 random(5);
  const TetMesh mesh = test::jittered_box({4, 3, 3}, 0.01, 0.2, random);
  SimulationOptions o = in_stages(2, Precision::double_precision);
  Simulation s(mesh, {{0, viscous(50.0)}}, o);
  const std::vector<Vec3d> v = test::random_field(mesh.vertices.size(), 0.01, random);
  s.set_state(std::vector<Vec3d>(v.size()), v);
  const auto momentum = [&] {
    Vec3d sum{};
    for (std::size_t i = 0; i < v.size(); ++i) sum += s.velocity()[i] * s.masses()[i];
    return sum;
  };
  const Vec3d before = momentum();
  for (int i = 0; i < 200; ++i) test::must_step(s);
  EXPECT_LE(norm(momentum() - before), 1e-12 * norm(before));
}

// Same bytes on any number of threads, and from a checkpoint on.
TEST(DragStages, GiveTheSameBytes) {
  const TetMesh mesh = box_mesh({.cells = {10, 10, 12}, .size = {0.1, 0.1, 0.12}});
  const auto body = [&](int threads) {
    SimulationOptions o = in_stages(3);
    o.threads = threads;
    Tissue tissue = viscous(30.0);
    tissue.law = LinearLaw{20000.0};
    Simulation s(mesh, {{0, tissue}}, o);
    s.fix(mesh.vertex_sets.at("z_min"));
    s.drive(mesh.vertex_sets.at("z_max"), press({.velocity = 0.1, .depth = 0.01}));
    s.add_load(mesh.vertex_sets.at("x_max"), {2.0, 0.0, 0.0}, [](double t) { return std::sin(200.0 * t); });
    return s;
  };
  const auto run = [](Simulation& s, int steps) {
    for (int i = 0; i < steps; ++i) test::must_step(s);
  };
  Simulation one = body(1), three = body(3);
  run(one, 40), run(three, 40);
  EXPECT_EQ(one.state_hash(), three.state_hash());
  std::stringstream saved;
  one.save(saved);
  run(one, 40);
  Simulation again = body(2);
  again.load(saved);
  run(again, 40);
  EXPECT_EQ(again.state_hash(), one.state_hash());
}

// A state that is set is the first one: what acted before does not act in its stages.
TEST(DragStages, ForgetWhatActedBeforeAStateWasSet) {
  const TetMesh mesh = test::paper_mesh();
  const auto body = [&] {
    SimulationOptions o = in_stages(3);
    o.step = 2e-4;
    Simulation s(mesh, {{0, viscous(20.0)}}, o);
    s.fix(mesh.vertex_sets.at("z_min"));
    s.add_load(mesh.vertex_sets.at("x_max"), {2.0, 0.0, 0.0});
    return s;
  };
  Simulation used = body(), fresh = body();
  for (int i = 0; i < 20; ++i) test::must_step(used);
  const std::vector<Vec3d> none(mesh.vertices.size());
  used.set_state(none, none);
  for (int i = 0; i < 3; ++i) test::must_step(used), test::must_step(fresh);
  EXPECT_EQ(used.state_hash(), fresh.state_hash());
}

// Tets that are taken out of a body whose step drag limits leave a step that is still stable.
TEST(DragStages, StayStableWhenTheBodyIsCut) {
  std::mt19937 random(11);
  const TetMesh mesh = test::jittered_box({6, 5, 5}, 0.01, 0.2, random);
  SimulationOptions o = in_stages(2);
  o.mesh_changes = true;
  Simulation s(mesh, {{0, viscous(200.0)}}, o);
  s.fix(mesh.vertex_sets.at("z_min"));
  const std::vector<Vec3d> v = test::random_field(mesh.vertices.size(), 0.05, random);
  s.set_state(std::vector<Vec3d>(v.size()), v);
  const double before = s.energies().initial;
  for (int i = 0; i < 400; ++i) {
    if (i % 10 == 0) s.remove_tets(std::vector<std::uint32_t>{static_cast<std::uint32_t>(random() % mesh.tets.size())});
    test::must_step(s);
  }
  EXPECT_LT(s.energies().kinetic, 0.5 * before);
}

// What they cannot do is refused by name.
TEST(DragStages, RefuseWhatTheyCannotDo) {
  const auto message = [](const SimulationOptions& o, const Tissue& tissue) -> std::string {
    try {
      const Simulation s(test::paper_mesh(), {{0, tissue}}, o);
      return "";
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
  };
  SimulationOptions semi = in_stages(2);
  semi.integrator = Integrator::semi_implicit;
  EXPECT_NE(message(semi, viscous(10.0)).find("drag_stages = 2 is outside the allowed range"), std::string::npos);
  Tissue corotational = viscous(10.0);
  corotational.kinematics = Kinematics::corotational;
  EXPECT_NE(message(in_stages(2), corotational).find("stages of the viscous force are for tissue of small strain"),
            std::string::npos);
  EXPECT_NE(message(in_stages(9), viscous(10.0)).find("drag_stages"), std::string::npos);
  SimulationOptions too_long = in_stages(2);
  too_long.step = 1.05 * Simulation(test::paper_mesh(), {{0, viscous(1000.0)}}, in_stages(2)).stable_step();
  EXPECT_NE(message(too_long, viscous(1000.0)).find("above the stable step"), std::string::npos);
}

}  // namespace
}  // namespace glisson::drag_stages_test
