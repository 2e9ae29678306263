// Energy is accounted exactly: what tools and loads put in is found as kinetic, elastic or dissipated.
#include <gtest/gtest.h>

#include <cmath>

#include "element/body.h"
#include "element/tet_fields.h"
#include "glisson/instruments/motion.h"
#include "support/bodies.h"
#include "support/must_step.h"

namespace glisson {
namespace {

/// The paper's press with everything switched on.
struct BusyPress {
  TetMesh mesh = test::paper_mesh();
  Simulation simulation;
  explicit BusyPress(const Tissue& tissue, Precision precision = Precision::double_precision)
      : simulation(mesh, {{0, tissue}}, options(precision)) {
    simulation.fix(mesh.vertex_sets.at("z_min"));
    simulation.drive(test::paper_triangle(), press({.velocity = 0.05, .depth = 0.01, .hold = 0.1, .returns = true}));
    simulation.add_load(mesh.vertex_sets.at("x_max"), {0.05, 0.0, 0.02}, [](double t) { return std::sin(20.0 * t); });
  }
  static SimulationOptions options(Precision precision) {
    SimulationOptions o;
    o.precision = precision;
    o.damping_rate = 5.0;
    o.gravity = {0.0, 0.0, -9.81};
    o.gravity_ramp = 0.05;
    return o;
  }
  void run(double seconds) {
    while (simulation.time() < seconds) ASSERT_EQ(simulation.step().status, StepStatus::ok);
  }
  /// Largest of the terms, to compare with.
  double scale() const {
    const Energies e = simulation.energies();
    return std::abs(e.elastic) + std::abs(e.dissipated) + std::abs(e.kinetic);
  }
};

Tissue viscous() {
  Tissue tissue;
  tissue.viscosity = 5.0;
  return tissue;
}

// The balance holds to rounding for the linear viscous tissue under tool, load, gravity and damping at once.
TEST(Energy, BalanceIsExact) {
  BusyPress body(viscous());
  body.run(0.5);
  const Energies e = body.simulation.energies();
  EXPECT_LE(std::abs(e.imbalance()), 1e-10 * body.scale()) << "imbalance " << e.imbalance() << " J of " << body.scale();
  EXPECT_GT(e.dissipated, 0.0);
}

// The same with a step that shrinks as the tissue stiffens.
TEST(Energy, BalanceIsExactWhileTheStepChanges) {
  Tissue tissue = viscous();
  tissue.law = LinearLaw{20.0 * tissue.youngs_modulus};
  BusyPress body(tissue);
  const double before = body.simulation.step_size();
  body.run(0.5);
  EXPECT_LT(body.simulation.step_size(), before);
  EXPECT_LE(std::abs(body.simulation.energies().imbalance()), 1e-10 * body.scale());
}

// For a linear tissue the accounted elastic work is the stored energy V (½ λ tr² + μ ε:ε) of the state.
TEST(Energy, ElasticWorkIsTheStoredEnergy) {
  BusyPress body(viscous());
  const Body rest = build_body(body.mesh, {{0, viscous()}});
  body.run(0.3);
  const std::vector<Vec3d> u(body.simulation.displacement().begin(), body.simulation.displacement().end());
  ASSERT_EQ(body.simulation.step().status, StepStatus::ok);  // books the kick at the state `u`
  const double stored = secant_energy(rest, u);
  EXPECT_NEAR(body.simulation.energies().elastic, stored, 1e-10 * stored) << "stored " << stored << " J";
}

// Kinetic energy is that of the velocities, to the second order of the step that the scheme itself has.
TEST(Energy, KineticEnergyIsThatOfTheVelocities) {
  const TetMesh mesh = test::paper_mesh();
  Simulation simulation(mesh, {{0, Tissue{}}}, test::in_double());
  const std::vector<Vec3d> velocity(mesh.vertices.size(), Vec3d{0.0, 0.0, 0.3});
  simulation.set_state(std::vector<Vec3d>(mesh.vertices.size()), velocity);
  test::must_step(simulation);
  const double mass = 1000.0 * volume(mesh);
  EXPECT_NEAR(simulation.energies().kinetic, 0.5 * mass * 0.09, 1e-12);
  EXPECT_NEAR(simulation.energies().imbalance(), 0.0, 1e-12);
}

// An undamped linear body keeps its energy over a hundred thousand steps.
TEST(Energy, FreeVibrationKeepsItsEnergy) {  // long
  std::mt19937 random(2);
  const TetMesh mesh = box_mesh({.cells = {1, 1, 3}, .size = {0.01, 0.01, 0.03}});
  Simulation simulation(mesh, {{0, Tissue{}}}, test::in_double());
  simulation.set_state(test::random_field(mesh.vertices.size(), 1e-4, random),
                       std::vector<Vec3d>(mesh.vertices.size()));
  test::must_step(simulation);
  const Energies start = simulation.energies();
  for (int i = 0; i < 100000; ++i) test::must_step(simulation);
  const Energies end = simulation.energies();
  EXPECT_NEAR(end.kinetic + end.elastic, start.kinetic + start.elastic, 1e-10 * start.elastic);
}

// The force of a tool is the sum of its parts, and equals the momentum the body gains.
TEST(ToolForce, IsTheMomentumTheBodyGains) {
  BusyPress body(viscous());
  const TetMesh& mesh = body.mesh;
  SimulationOptions options = test::in_double();
  Simulation free(mesh, {{0, viscous()}}, options);
  const ConstraintId tool = free.drive(test::paper_triangle(), press({.velocity = 0.05, .depth = 0.01}));
  Vec3d impulse{}, momentum{};
  for (int i = 0; i < 300; ++i) {
    const double h = free.step_size();
    test::must_step(free);
    impulse += free.force(tool).total() * h;
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) momentum += free.velocity()[i] * free.masses()[i];
  EXPECT_LE(norm(impulse - momentum), 1e-10 * norm(momentum));
}

// In float the balance is as good as the element arithmetic.
TEST(Energy, BalanceInFloat) {
  BusyPress body(viscous(), Precision::single_precision);
  body.run(0.5);
  EXPECT_LE(std::abs(body.simulation.energies().imbalance()), 1e-10 * body.scale());
}

// A million steps of 10 µs at 1 mm/s in float follow double to 0.1 %: no step is lost in a float's grain.
TEST(Precision, MillionSmallStepsInFloatFollowDouble) {  // long
  const TetMesh mesh = box_mesh({.cells = {1, 1, 2}, .size = {0.05, 0.05, 0.1}});
  std::vector<Simulation> runs;
  std::vector<ConstraintId> tools;
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    SimulationOptions options;
    options.precision = precision;
    options.step = 1e-5;
    runs.emplace_back(mesh, std::map<int, Tissue>{{0, Tissue{}}}, options);
    runs.back().fix(mesh.vertex_sets.at("z_min"));
    tools.push_back(runs.back().drive(mesh.vertex_sets.at("z_max"), press({.velocity = 0.001, .depth = 1.0})));
  }
  for (Simulation& run : runs) {
    for (int i = 0; i < 1000000; ++i) test::must_step(run);
  }
  EXPECT_LE(test::relative_difference(runs[0].displacement(), runs[1].displacement()), 1e-3);
  const double in_float = runs[0].force(tools[0]).elastic.z, in_double = runs[1].force(tools[1]).elastic.z;
  EXPECT_NEAR(in_float / in_double, 1.0, 1e-3);
  EXPECT_NEAR(runs[0].time(), 10.0, 1e-6);
}

}  // namespace
}  // namespace glisson
