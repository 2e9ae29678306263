// The static integrator: equilibrium against independent solutions, load stepping that ends where it should, clear refusals.
#include <gtest/gtest.h>

#include <cmath>

#include "element/tissue_operator.h"
#include "glisson/instruments/motion.h"
#include "support/bodies.h"

namespace glisson {
namespace {

SimulationOptions in_equilibrium() {
  SimulationOptions options;
  options.integrator = Integrator::quasi_static;
  return options;
}

// The paper's press has the stiffness of the assembled matrix (docs/paper.md), in one step or in twenty.
TEST(Static, PressHasTheStiffnessOfTheMatrix) {
  const TetMesh mesh = test::paper_mesh();
  for (const double step : {1.0, 0.05}) {
    SimulationOptions o = in_equilibrium();
    o.step = step;
    Simulation s(mesh, {{0, Tissue{}}}, o);
    const ConstraintId base = s.fix(mesh.vertex_sets.at("z_min"));
    const ConstraintId tool = s.drive(test::paper_triangle(), [](double t) {
      return Vec3d{0.0, 0.0, -0.005 * std::min(t, 1.0)};
    });
    while (s.time() < 1.0 - 1e-9) ASSERT_EQ(s.step().status, StepStatus::ok);
    EXPECT_NEAR(-s.force(tool).total().z / 0.005, 51.19, 0.01) << "step " << step;
    EXPECT_NEAR(s.force(tool).total().z, -s.force(base).total().z, 1e-9);
    const Energies e = s.energies();
    EXPECT_NEAR(e.work_tools, 0.5 * 51.195 * 0.005 * 0.005, 1e-7) << "½ k d²";
    EXPECT_LE(std::abs(e.imbalance()), 1e-9 * e.elastic);
    EXPECT_EQ(e.kinetic, 0.0);
  }
}

/// Stress P_zz of a neo-Hookean bar stretched by λ along z with free sides: t from 0 = ∂W/∂t, by bisection.
double uniaxial_stress(const NeoHookean& law, double stretch) {
  const auto slopes = [&](double t) {  // W = μ/2 (J^(−⅔) (λ² + 2t²) − 3) + κ/2 (J − 1)², J = λ t²
    const double J = stretch * t * t, I = stretch * stretch + 2.0 * t * t, p = std::pow(J, -2.0 / 3.0);
    const double bulk = law.bulk_modulus * (J - 1.0) - law.mu / 3.0 * p * I / J;  // dW/dJ
    return std::pair{law.mu * p * 2.0 * t + bulk * 2.0 * stretch * t, law.mu * p * stretch + bulk * t * t};
  };
  double low = 0.5, high = 2.0;
  for (int i = 0; i < 200; ++i) (slopes(0.5 * (low + high)).first < 0.0 ? low : high) = 0.5 * (low + high);
  return slopes(low).second;
}

// A neo-Hookean bar stretched uniformly, from a quarter shorter to half as long again, has the closed form's force: the
// mesh can hold the solution, so that only Newton's tolerance is left.
TEST(Static, NeoHookeanBarHasTheClosedForm) {
  Tissue tissue;
  const NeoHookean law{.mu = 1000.0, .bulk_modulus = 5000.0};
  tissue.hyperelastic = law;
  for (const double stretch : {0.75, 1.2, 1.5}) {
    std::mt19937 random(4);
    const TetMesh mesh = test::jittered_box({2, 2, 3}, 0.01, 0.2, random);
    SimulationOptions o = in_equilibrium();
    Simulation s(mesh, {{0, tissue}}, o);
    s.fix(mesh.vertex_sets.at("z_min"), {false, false, true});
    s.fix(mesh.vertex_sets.at("x_min"), {true, false, false});
    s.fix(mesh.vertex_sets.at("y_min"), {false, true, false});
    const ConstraintId end = s.drive(mesh.vertex_sets.at("z_max"),
                                     [=](double t) {
                                       return Vec3d{0.0, 0.0, 0.03 * (stretch - 1.0) * t};
                                     },
                                     {false, false, true});
    while (s.time() < 1.0 - 1e-9) ASSERT_EQ(s.step().status, StepStatus::ok);
    const double expected = uniaxial_stress(law, 1.0 + (stretch - 1.0) * s.time()) * 0.02 * 0.02;
    EXPECT_NEAR(s.force(end).total().z, expected, 1e-6 * std::abs(expected)) << "stretch " << stretch;
  }
}

// The order in which loads come does not matter to an elastic body, and their work is what is stored.
TEST(Static, EndDoesNotDependOnTheSteps) {
  const TetMesh mesh = box_mesh({.cells = {2, 2, 6}, .size = {0.02, 0.02, 0.06}});
  Tissue tissue;
  tissue.kinematics = Kinematics::corotational;
  std::vector<std::vector<Vec3d>> ends;
  for (const double largest : {0.5, 0.02}) {
    SimulationOptions o = in_equilibrium();
    o.implicit.largest_step = largest;
    Simulation s(mesh, {{0, tissue}}, o);
    s.fix(mesh.vertex_sets.at("z_min"));
    s.add_load(mesh.vertex_sets.at("z_max"), {0.02, 0.0, 0.0}, [](double t) { return std::min(t, 1.0); });
    while (s.time() < 1.5) ASSERT_EQ(s.step().status, StepStatus::ok);
    ends.emplace_back(s.displacement().begin(), s.displacement().end());
    EXPECT_GT(norm(ends.back()[mesh.vertex_sets.at("z_max").front()]), 0.01) << "a large rotation";
    if (largest > 0.1) continue;
    const double stored = TissueOperator(build_body(mesh, {{0, tissue}})).energy(s.displacement());
    EXPECT_NEAR(s.energies().elastic, stored, 1e-3 * stored) << "work by trapezoids of 75 steps";
  }
  EXPECT_LE(test::relative_difference(ends[0], ends[1]), 1e-5);
}

// Maxwell branches have relaxed and dashpots give nothing: the stiffness is the long-time one.
TEST(Static, RelaxedTissueHasItsLongTimeStiffness) {
  const TetMesh mesh = test::paper_mesh();
  Tissue tissue;
  tissue.maxwell = {{0.5, 1.0}};
  tissue.maxwell_part = MaxwellPart::all;
  tissue.viscosity = 1000.0;
  Simulation s(mesh, {{0, tissue}}, in_equilibrium());
  s.fix(mesh.vertex_sets.at("z_min"));
  const ConstraintId tool = s.drive(test::paper_triangle(), press({.velocity = 0.01, .depth = 0.005}));
  while (s.time() < 1.0) ASSERT_EQ(s.step().status, StepStatus::ok);
  EXPECT_NEAR(-s.force(tool).total().z / 0.005, 0.5 * 51.19, 0.01);
}

// A body that can move as a whole has no equilibrium: each free motion is named, the state stays.
TEST(Static, FreeRigidMotionsAreNamed) {
  const TetMesh mesh = test::paper_mesh();
  const auto message = [&](auto hold) {
    Simulation s(mesh, {{0, Tissue{}}}, in_equilibrium());
    hold(s);
    const StepResult r = s.step();
    EXPECT_EQ(r.status, StepStatus::not_held);
    EXPECT_EQ(s.time(), 0.0);
    return std::string(r.message);
  };
  const std::string along_x = message([&](Simulation& s) { s.fix(mesh.vertex_sets.at("z_min"), {false, true, true}); });
  EXPECT_NE(along_x.find("move along x"), std::string::npos) << along_x;
  const test::VertexSet one{0, 1};
  EXPECT_NE(message([&](Simulation& s) { s.fix(one); }).find("turn around x"), std::string::npos) << "both lie on x";
  EXPECT_NE(message([](Simulation&) {}).find("Hold at least three vertices"), std::string::npos);
}

// A piece that a removal has cut off is found too.
TEST(Static, LoosePieceIsFound) {
  const TetMesh mesh = test::paper_mesh();
  Simulation s(mesh, {{0, Tissue{}}}, in_equilibrium());
  s.fix(mesh.vertex_sets.at("z_min"));
  ASSERT_EQ(s.step().status, StepStatus::ok);
  std::vector<std::uint32_t> middle;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    double z = 0.0;
    for (const std::uint32_t v : mesh.tets[t]) z += 0.25 * mesh.vertices[v].z;
    if (z > 0.04 && z < 0.05) middle.push_back(t);
  }
  s.remove_tets(middle);
  EXPECT_EQ(s.step().status, StepStatus::not_held);
}

// A load no equilibrium exists for is reported, and the state is what it was: a string of corotational tets under a
// pressure without end, on a secant law that softens to nothing.
TEST(Static, NoEquilibriumIsReported) {
  const TetMesh mesh = box_mesh({.cells = {1, 1, 2}, .size = {0.01, 0.01, 0.02}});
  Tissue tissue;
  tissue.law = PolynomialLaw{{-1.2 * 3600.0}};  // E falls to its floor
  SimulationOptions o = in_equilibrium();
  o.implicit.most_iterations = 8;
  o.implicit.most_cuts = 3;
  Simulation s(mesh, {{0, tissue}}, o);
  s.fix(mesh.vertex_sets.at("z_min"));
  s.add_load(mesh.vertex_sets.at("z_max"), {0.0, 0.0, 1.0}, [](double t) { return 1e6 * t; });
  StepResult r;
  for (int i = 0; i < 50 && r.status != StepStatus::not_converged; ++i) {
    const std::uint64_t before = s.state_hash();
    const double time = s.time();
    r = s.step();
    if (r.status != StepStatus::not_converged) continue;
    EXPECT_EQ(s.state_hash(), before);
    EXPECT_EQ(s.time(), time);
    EXPECT_NE(r.message.find("no balance of forces"), std::string_view::npos);
  }
  for (const Vec3d& u : s.displacement()) EXPECT_TRUE(std::isfinite(norm(u)));
}

}  // namespace
}  // namespace glisson
