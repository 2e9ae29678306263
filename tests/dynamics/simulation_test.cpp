// The simulation's contract: statuses instead of exceptions, refusals that say why, forces that add up.
#include "glisson/simulation/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "glisson/instruments/motion.h"
#include "support/bodies.h"
#include "support/must_step.h"

namespace glisson {
namespace {

TetMesh small_box() { return box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}}); }

Simulation small_simulation(const SimulationOptions& options = {}) { return {small_box(), {{0, Tissue{}}}, options}; }

void expect_refusal(const std::function<void()>& act, const std::string& fragment) {
  try {
    act();
    ADD_FAILURE() << "accepted, expected: " << fragment;
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(fragment), std::string::npos) << error.what();
  }
}

// Every bad option is refused with its name, value and range.
TEST(Simulation, RefusesBadOptions) {
  const auto with = [](auto change) {
    return [change] {
      SimulationOptions options;
      change(options);
      small_simulation(options);
    };
  };
  expect_refusal(with([](auto& o) { o.step = 0.0; }), "step [s] = 0");
  expect_refusal(with([](auto& o) { o.step = NAN; }), "step [s] = nan");
  expect_refusal(with([](auto& o) { o.step = 1.0; }), "above the stable step");
  expect_refusal(with([](auto& o) { o.damping_rate = -1.0; }), "damping_rate [1/s] = -1");
  expect_refusal(with([](auto& o) { o.nodal_damping = -1.0; }), "nodal_damping [kg/s] = -1");
  expect_refusal(with([](auto& o) { o.gravity_ramp = INFINITY; }), "gravity_ramp [s] = inf");
  expect_refusal(with([](auto& o) { o.gravity = {0.0, NAN, 0.0}; }), "gravity.y [m/s²] = nan");
}

// An integrator refuses the options that its capabilities lack, and takes those that they have; central_difference has most.
TEST(Simulation, IntegratorsTakeWhatTheyAreCapableOf) {
  const auto takes = [](const SimulationOptions& o) {
    Tissue tissue;
    tissue.viscosity = 1.0;
    try {
      const Simulation s(small_box(), {{0, tissue}}, o);
      return true;
    } catch (const std::invalid_argument&) {
      return false;
    }
  };
  for (const Word<Integrator>& w : kWords<Integrator>) {
    SCOPED_TRACE(w.word);
    const Capabilities can = capabilities(w.value);
    SimulationOptions staged{.integrator = w.value}, fixed = staged;
    staged.drag_stages = 2;
    fixed.mass_scaling_step = 1e-6;
    SimulationOptions variable = fixed;
    variable.mass_scaling = MassScalingKind::variable;
    EXPECT_EQ(takes(staged), can.supports_drag_stages);
    EXPECT_EQ(takes(fixed), !can.any_step_is_stable);
    SimulationOptions adaptive{.integrator = w.value};
    adaptive.precision = Precision::adaptive;
    EXPECT_EQ(takes(variable), can.supports_variable_mass);
    EXPECT_EQ(takes(adaptive), can.supports_adaptive_precision);
    EXPECT_EQ(can.supports_adaptive_precision, w.value == Integrator::central_difference);
    EXPECT_EQ(can.supports_drag_stages, w.value == Integrator::central_difference);
    EXPECT_EQ(can.supports_variable_mass, w.value == Integrator::central_difference);
  }
}

// Sets that are empty, leave the mesh or move what another holds are refused, and a refused set leaves nothing held.
TEST(Simulation, RefusesBadSets) {
  Simulation simulation = small_simulation();
  const test::VertexSet outside{0, 27}, overlapping{5, 0}, twice{3, 3};
  const Motion up = [](double t) { return Vec3d{0.0, 0.0, t}; };
  expect_refusal([&] { simulation.fix(std::span<const std::uint32_t>{}); }, "empty");
  expect_refusal([&] { simulation.fix(outside); }, "vertex 27 is outside the mesh, 0 to 26");
  const test::VertexSet first{0};
  simulation.fix(first);
  expect_refusal([&] { simulation.drive(overlapping, up); }, "component x of vertex 0 is held by two constraints");
  expect_refusal([&] { simulation.drive(twice, up); }, "vertex 3");
  const test::VertexSet five{5};
  EXPECT_NO_THROW(simulation.fix(five)) << "vertex 5 was in a refused set only";
  expect_refusal([&] { simulation.add_load(outside, {1, 0, 0}); }, "vertex 27");
  expect_refusal([&] { simulation.add_load(first, {NAN, 0, 0}); }, "force.x [N] = nan is outside the allowed range");
  expect_refusal([&] { simulation.force({7}); }, "constraint id 7 does not exist");
  expect_refusal([&] { simulation.set_state({}, {}); }, "the mesh has 27 vertices");
}

// A set by name holds, drives and loads the vertices of that set; a name that the mesh has not is refused with those it has.
TEST(Simulation, SetsByName) {
  const TetMesh mesh = small_box();
  Simulation by_name = small_simulation(), by_number = small_simulation();
  const Motion up = [](double t) { return Vec3d{0.0, 0.0, 1e-4 * t}; };
  by_name.fix("z_min");
  by_name.drive("z_max", up);
  by_name.add_load("x_max", {1e-3, 0, 0});
  by_number.fix(mesh.vertex_sets.at("z_min"));
  by_number.drive(mesh.vertex_sets.at("z_max"), up);
  const std::vector<std::uint32_t>& side = mesh.vertex_sets.at("x_max");
  by_number.add_load(side, {1e-3, 0, 0});
  for (int n = 0; n < 20; ++n) ASSERT_TRUE(by_name.step().made() && by_number.step().made());
  EXPECT_EQ(by_name.state_hash(), by_number.state_hash());
  EXPECT_NE(by_name.state_hash(), small_simulation().state_hash());
  expect_refusal([&] { by_name.fix("zmin"); }, "no vertex set \"zmin\"; did you mean \"z_min\"? the sets are: x_max");
  expect_refusal([&] { TetMesh{}.vertex_set("top"); }, "no vertex set \"top\"; the mesh has none");
}

// A region without a tissue is named.
TEST(Simulation, RefusesARegionWithoutTissue) {
  TetMesh mesh = small_box();
  mesh.regions.assign(mesh.tets.size(), 0);
  mesh.regions[5] = 3;
  mesh.region_names[3] = "tumour";
  expect_refusal([&] { Simulation(mesh, {{0, Tissue{}}}); }, "region 3 (\"tumour\") of the mesh has no tissue");
}

// Inverted tetrahedra are reported with their ids, and the run goes on without NaN.
TEST(Simulation, ReportsInvertedTets) {
  Simulation simulation = small_simulation();
  std::vector<Vec3d> u(27);
  u[13] = {0.0, 0.0, 0.015};  // the centre vertex beyond the face above it
  simulation.set_state(u, std::vector<Vec3d>(27));
  const auto fields = simulation.tet_fields();
  const StepResult result = simulation.step();
  EXPECT_EQ(result.status, StepStatus::inverted);
  std::vector<std::uint32_t> expected;
  for (std::uint32_t t = 0; t < fields.jacobian.size(); ++t) {
    if (fields.jacobian[t] <= 0.0) expected.push_back(t);
  }
  EXPECT_EQ(std::vector<std::uint32_t>(result.inverted_tets.begin(), result.inverted_tets.end()), expected);
  EXPECT_FALSE(expected.empty());
  for (int i = 0; i < 2000; ++i) ASSERT_NE(simulation.step().status, StepStatus::not_finite);
}

// A state that is not finite is reported and not stepped.
TEST(Simulation, ReportsWhatIsNotFinite) {
  Simulation simulation = small_simulation();
  std::vector<Vec3d> u(27);
  u[13].x = NAN;
  simulation.set_state(u, std::vector<Vec3d>(27));
  EXPECT_EQ(simulation.step().status, StepStatus::not_finite);
  EXPECT_EQ(simulation.steps(), 0U);
  EXPECT_EQ(simulation.time(), 0.0);
}

// A driven set follows its motion exactly, and only in the components that are driven.
TEST(Simulation, DrivesAlongTheMotion) {
  Simulation simulation = small_simulation();
  const TetMesh mesh = small_box();
  simulation.fix(mesh.vertex_sets.at("z_min"));
  simulation.drive(mesh.vertex_sets.at("z_max"),
                   [](double t) {
                     return Vec3d{0.0, 0.0, -0.01 * t};
                   },
                   {false, false, true});
  for (int i = 0; i < 500; ++i) test::must_step(simulation);
  const std::uint32_t corner = mesh.vertex_sets.at("z_max").front();
  EXPECT_NEAR(simulation.displacement()[corner].z, -0.01 * simulation.time(), 1e-15);
  EXPECT_LT(simulation.displacement()[corner].x, -1e-6) << "free to bulge sideways";
}

// A tool that takes hold later leaves its vertices free until then, exerts nothing, and counts from where they are.
TEST(Simulation, ToolTakesHoldWhenItsTimeComes) {
  SimulationOptions options = test::in_double();
  options.gravity = {0.0, 0.0, -9.81};
  options.damping_rate = 20.0;
  Simulation simulation = small_simulation(options), alone = small_simulation(options);
  const TetMesh mesh = small_box();
  const auto& top = mesh.vertex_sets.at("z_max");
  for (Simulation* s : {&simulation, &alone}) s->fix(mesh.vertex_sets.at("z_min"));
  const PressMotion motion{.velocity = 0.01, .depth = 0.002, .start = 0.2};
  const ConstraintId tool = simulation.drive(top, press(motion), {}, motion.start);
  while (simulation.time() + simulation.step_size() < motion.start) {
    test::must_step(simulation), test::must_step(alone);
    EXPECT_EQ(norm(simulation.force(tool).total()), 0.0);
  }
  EXPECT_EQ(simulation.state_hash(), alone.state_hash()) << "as if there were no tool";
  const double sag = simulation.displacement()[top.front()].z;
  EXPECT_LT(sag, -1e-6);
  while (simulation.time() < press_end(motion)) test::must_step(simulation);
  EXPECT_NEAR(simulation.displacement()[top.front()].z, sag - motion.depth, 2e-5) << "to one step of the motion";
  EXPECT_LT(simulation.force(tool).total().z, 0.0);
  const Energies e = simulation.energies();
  EXPECT_LE(std::abs(e.imbalance()), 1e-10 * (e.work_tools + e.work_loads));
}

// At rest under gravity the support carries the weight.
TEST(Simulation, SupportCarriesTheWeight) {
  SimulationOptions options;
  options.gravity = {0.0, 0.0, -9.81};
  options.damping_rate = 60.0;
  Simulation simulation = small_simulation(options);
  const ConstraintId base = simulation.fix(small_box().vertex_sets.at("z_min"));
  while (simulation.time() < 2.0) test::must_step(simulation);
  const double weight = 9.81 * 1000.0 * 8e-6;
  EXPECT_NEAR(simulation.force(base).total().z, weight, 1e-4 * weight);
}

// Equal runs give equal bytes, and a different state another hash.
TEST(Simulation, HashFollowsTheState) {
  Simulation a = small_simulation(), b = small_simulation();
  std::vector<Vec3d> u(27);
  u[13].x = 1e-3;
  for (Simulation* s : {&a, &b}) s->set_state(u, std::vector<Vec3d>(27));
  for (int i = 0; i < 100; ++i) test::must_step(a), test::must_step(b);
  EXPECT_EQ(a.state_hash(), b.state_hash());
  test::must_step(b);
  EXPECT_NE(a.state_hash(), b.state_hash());
}

// Gravity grows over its ramp and is then constant: the free body falls by ½ g t² after it.
TEST(Simulation, GravityRamp) {
  SimulationOptions options;
  options.gravity = {0.0, 0.0, -10.0};
  options.gravity_ramp = 0.1;
  Simulation simulation = small_simulation(options);
  while (simulation.time() < 0.2) test::must_step(simulation);
  const double t = simulation.time(), expected = -10.0 * (0.5 * 0.1 + (t - 0.1));
  EXPECT_NEAR(simulation.velocity()[0].z, expected, 0.02) << "speed after the ramp, to one step of gravity";
}

// The vibration of a body that dies out meets no denormals in the engine, and leaves the caller's mode alone.
TEST(Simulation, LeavesTheCallersFloatingPointMode) {
  Simulation simulation = small_simulation();
  test::must_step(simulation);
  volatile double tiny = 1e-310;
  EXPECT_GT(tiny * 0.5, 0.0) << "denormals still exist outside the engine";
}

}  // namespace
}  // namespace glisson
