// The stable step h* is the true limit of the paper's scheme: figures for the paper's mesh, runs on both sides.
#include "dynamics/step/stable_step.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "glisson/instruments/motion.h"
#include "glisson/simulation/simulation.h"
#include "material/reference/reference.h"
#include "support/bodies.h"

namespace glisson::stable_step_test {
namespace {

Tissue viscous_tissue(double eta, ViscousTensor tensor) {
  Tissue tissue;
  tissue.viscosity = eta;
  tissue.viscous_tensor = tensor;
  return tissue;
}

double free_step(const TetMesh& mesh, const Tissue& tissue, double damping_rate = 0.0, double stiffening = 1.0) {
  const Body body = build_body(mesh, {{0, tissue}});
  std::vector<double> gamma;
  for (const double m : body.masses) gamma.push_back(damping_rate * m);
  return stable_step(body, std::vector<double>{stiffening}, gamma).step;
}

// The largest eigenvalue of the paper's mesh is the figure found by two independent codes.
TEST(StableStep, SpectrumOfThePapersMesh) {
  const double h = free_step(test::paper_mesh(), Tissue{}), value = 4.0 / (h * h);
  EXPECT_NEAR(value, 7.176e5, 7.176e5 * 2e-4) << "lambda_max = " << value;
}

// h* of the paper's mesh for the elastic tissue and the three viscous tensors.
TEST(StableStep, FiguresOfThePapersMesh) {
  const TetMesh mesh = test::paper_mesh();
  EXPECT_NEAR(free_step(mesh, Tissue{}), 2.361e-3, 1e-6);
  EXPECT_NEAR(free_step(mesh, viscous_tissue(1000.0, ViscousTensor::shear)), 1.03e-5, 0.01e-5);
  EXPECT_NEAR(free_step(mesh, viscous_tissue(1000.0, ViscousTensor::deviatoric)), 1.28e-5, 0.01e-5);
  EXPECT_NEAR(free_step(mesh, viscous_tissue(1000.0, ViscousTensor::proportional)), 1.005e-5, 0.003e-5);
}

// What the paper's step of 0.01 s would need: density or damping beyond those of tissue.
TEST(StableStep, WhatThePapersStepWouldNeed) {
  const TetMesh mesh = test::paper_mesh();
  Tissue heavy;
  heavy.density = 1.80e4;
  EXPECT_GE(free_step(mesh, heavy), 0.01);
  heavy.density = 1.78e4;
  EXPECT_LT(free_step(mesh, heavy), 0.01);
  EXPECT_GE(free_step(mesh, Tissue{}, 3.40e3), 0.01);
  EXPECT_LT(free_step(mesh, Tissue{}, 3.37e3), 0.01);
  Tissue viscous = viscous_tissue(1000.0, ViscousTensor::shear);
  // adding the largest c and the largest k as if they were of one mode gives 1.98e5 1/s; the two modes differ
  EXPECT_GE(free_step(mesh, viscous, 1.98e5), 0.01);
  EXPECT_LT(free_step(mesh, viscous, 1.96e5), 0.01);
  viscous.density = 9.9e5;
  EXPECT_GE(free_step(mesh, viscous), 0.01);
}

// On one tetrahedron φ(h*) = 4 against a dense eigenvalue solver, with viscosity and nodal damping at once.
TEST(StableStep, AgreesWithDenseEigenvalues) {
  TetMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0.011, 0, 0.001}, {0.002, 0.012, 0}, {0, 0.003, 0.009}};
  mesh.tets = {{0, 1, 2, 3}};
  const Tissue tissue = viscous_tissue(0.5, ViscousTensor::shear);
  const double h = free_step(mesh, tissue, 30.0);

  Tissue viscous_as_elastic = tissue;  // E with ν = 0 gives λ = 0, μ = E/2 = η
  viscous_as_elastic.youngs_modulus = 2.0 * tissue.viscosity;
  viscous_as_elastic.poisson_ratio = 0.0;
  const Eigen::MatrixXd K = reference::stiffness_matrix(mesh, {{0, tissue}});
  const Eigen::MatrixXd C = reference::stiffness_matrix(mesh, {{0, viscous_as_elastic}});
  const double m = build_body(mesh, {{0, tissue}}).masses[0];
  const Eigen::MatrixXd A = h * h * K + 2.0 * h * (C - 30.0 * m * Eigen::MatrixXd::Identity(12, 12));
  const double top = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A).eigenvalues()(11) / m;
  EXPECT_LE(top, 4.0) << "safe: phi(h*) = " << top;
  EXPECT_GE(top, 4.0 * (1.0 - 1e-3)) << "and close: phi(h*) = " << top;
}

// Bodies of a few tetrahedra have an h* as any other: from one cube, both splits, to where Lanczos takes over.
TEST(StableStep, SmallBodies) {
  for (const BoxSplit split : {BoxSplit::kuhn, BoxSplit::alternating}) {
    for (const int cells : {1, 2, 3, 4, 6}) {
      const TetMesh mesh = box_mesh({.cells = {1, 1, cells}, .size = {0.01, 0.01, 0.01 * cells}, .split = split});
      const Body body = build_body(mesh, {{0, Tissue{}}});
      const std::vector<double> one{1.0}, gamma(body.vertex_count, 0.0);
      const StableStep h = stable_step(body, one, gamma);
      EXPECT_FALSE(h.from_elements) << cells << " cells";
      EXPECT_NEAR(h.step, 2.4e-3, 0.3e-3) << cells << " cells, near that of the paper's mesh of the same cubes";
    }
  }
}

// The element bound, taken when Lanczos fails, never exceeds h*.
TEST(StableStep, ElementBoundIsBelow) {
  std::mt19937 random(3);
  for (int i = 0; i < 10; ++i) {
    const TetMesh mesh = test::jittered_box({3, 3, 3}, 0.01, 0.25, random);
    for (const double eta : {0.0, 1.0, 1000.0}) {
      const Body body = build_body(mesh, {{0, viscous_tissue(eta, ViscousTensor::shear)}});
      const std::vector<double> one{1.0}, gamma(body.vertex_count, 0.0);
      EXPECT_LE(element_bound_step(body, one), stable_step(body, one, gamma).step);
    }
  }
}

/// Growth of a small random velocity over a free run at `factor` × h*: largest speed at the end over that at the start.
double growth(const Tissue& tissue, double damping_rate, double factor) {
  std::mt19937 random(11);
  const TetMesh mesh = test::paper_mesh();
  SimulationOptions options;
  options.damping_rate = damping_rate;
  options.step = factor * free_step(mesh, tissue, damping_rate);
  options.enforce_stability = false;
  options.precision = Precision::double_precision;
  Simulation simulation(mesh, {{0, tissue}}, options);
  const std::vector<Vec3d> kick = test::random_field(mesh.vertices.size(), 1e-6, random);
  simulation.set_state(std::vector<Vec3d>(mesh.vertices.size()), kick);
  for (int i = 0; i < 800; ++i) {
    if (simulation.step().status == StepStatus::not_finite) return 1e300;
  }
  double speed = 0.0;
  for (const Vec3d& v : simulation.velocity()) speed = std::max(speed, norm(v));
  return speed / 1e-6;
}

struct Case {
  const char* name;
  double eta;
  ViscousTensor tensor;
  double damping_rate;
};

class BothSidesOfTheLimit : public testing::TestWithParam<Case> {};

// 2 % below h* a kick stays bounded, 2 % above it grows without limit.
TEST_P(BothSidesOfTheLimit, StableBelowUnstableAbove) {
  const Case& c = GetParam();
  const Tissue tissue = viscous_tissue(c.eta, c.tensor);
  const double below = growth(tissue, c.damping_rate, 0.98), above = growth(tissue, c.damping_rate, 1.02);
  EXPECT_LT(below, 30.0) << "at 0.98 h* the speed grew by the factor " << below;
  EXPECT_GT(above, 1e6) << "at 1.02 h* the speed grew only by the factor " << above;
}

std::string case_name(const testing::TestParamInfo<Case>& c) { return c.param.name; }

INSTANTIATE_TEST_SUITE_P(Schemes, BothSidesOfTheLimit,
                         testing::Values(Case{"elastic", 0.0, ViscousTensor::shear, 0.0},
                                         Case{"nodal_damping", 0.0, ViscousTensor::shear, 300.0},
                                         Case{"shear", 1000.0, ViscousTensor::shear, 0.0},
                                         Case{"deviatoric", 1000.0, ViscousTensor::deviatoric, 0.0},
                                         Case{"proportional", 1000.0, ViscousTensor::proportional, 0.0},
                                         Case{"mild_viscosity_and_damping", 1.0, ViscousTensor::shear, 100.0}),
                         case_name);

/// A body stretched without change of volume, held at its surface: in equilibrium, whatever the law.
struct Stretched {
  TetMesh mesh = test::paper_mesh();
  std::vector<Vec3d> u;
  std::vector<char> held;
  test::VertexSet surface;

  Stretched() : held(3 * mesh.vertices.size(), 0) {
    for (const Vec3d& x : mesh.vertices) u.push_back({0.05 * x.x, -0.05 * x.y, 0.0});
    for (const Triangle& t : boundary_triangles(mesh)) surface.insert(surface.end(), t.begin(), t.end());
    std::sort(surface.begin(), surface.end());
    surface.erase(std::unique(surface.begin(), surface.end()), surface.end());
    for (const std::uint32_t i : surface) held[3 * i] = held[3 * i + 1] = held[3 * i + 2] = 1;
  }

  /// Growth of a small kick at the step `h`.
  double growth(const Tissue& tissue, double h) const {
    std::mt19937 random(5);
    SimulationOptions options;
    options.precision = Precision::double_precision;
    options.enforce_stability = false;
    options.step = h;
    Simulation simulation(mesh, {{0, tissue}}, options);
    simulation.fix(surface);
    simulation.set_state(u, test::random_field(mesh.vertices.size(), 1e-9, random));
    for (int i = 0; i < 800; ++i) {
      if (simulation.step().status == StepStatus::not_finite) return 1e300;
    }
    double speed = 0.0;
    for (const Vec3d& v : simulation.velocity()) speed = std::max(speed, norm(v));
    return speed / 1e-9;
  }
};

// A tissue that has stiffened past its threshold everywhere has the h* of the stiff modulus, on both sides.
TEST(StableStep, StiffenedTissueOnBothSides) {
  const Stretched body;
  Tissue tissue;
  tissue.law = StepLaw{.threshold = 0.03, .above = 4.0 * tissue.youngs_modulus, .width = 0.02};
  const Body rest = build_body(body.mesh, {{0, tissue}});
  const std::vector<double> gamma(body.mesh.vertices.size(), 0.0), four{4.0};
  const double h = stable_step(rest, four, gamma, body.held).step;
  EXPECT_LT(body.growth(tissue, 0.98 * h), 30.0);
  EXPECT_GT(body.growth(tissue, 1.02 * h), 1e6);
}

// Where the modulus is on the rise the bound of the tangent is safe, and h* lies below the true limit by a known part.
TEST(StableStep, RisingModulusIsSafe) {
  const Stretched body;
  Tissue tissue;
  tissue.law = LinearLaw{30.0 * tissue.youngs_modulus};
  Simulation probe(body.mesh, {{0, tissue}}, test::in_double());
  const double at_rest = probe.stable_step();
  probe.fix(body.surface);
  probe.set_state(body.u, std::vector<Vec3d>(body.u.size()));
  EXPECT_EQ(probe.step().status, StepStatus::ok);
  const double h = probe.stable_step();
  EXPECT_LT(h, at_rest / std::sqrt(5.0)) << "f + f' s = 5.2 at s = 0.07";
  EXPECT_LT(body.growth(tissue, h), 30.0) << "h* = " << h;
  EXPECT_GT(body.growth(tissue, 2.0 * h), 1e6) << "the bound is not tighter than a factor of two";
}

// Without a search a stiffening tissue's step is bounded from the last h*: not above the searched one by more than
// the room that a search leaves, not below it by more than the bound's √r (r with nodal damping), and never unstable.
TEST(StableStep, BoundedStepIsSafe) {
  for (const double damping_rate : {0.0, 500.0}) {
    Tissue tissue;
    tissue.law = LinearLaw{10.0 * tissue.youngs_modulus};
    std::vector<double> steps;
    for (const bool exact : {true, false}) {
      SimulationOptions options = test::in_double();
      options.exact_steps = exact;
      options.damping_rate = damping_rate;
      const TetMesh mesh = test::paper_mesh();
      Simulation simulation(mesh, {{0, tissue}}, options);
      simulation.fix(mesh.vertex_sets.at("z_min"));
      simulation.drive(test::paper_triangle(), press({.velocity = 0.05, .depth = 0.01, .hold = 1.0}));
      const double at_rest = simulation.step_size();
      while (simulation.time() < 0.6) ASSERT_EQ(simulation.step().status, StepStatus::ok);
      EXPECT_LT(simulation.step_size(), at_rest);
      const Energies e = simulation.energies();
      EXPECT_LT(e.kinetic, 0.05 * e.work_tools) << "no oscillation has grown";
      steps.push_back(simulation.step_size());
    }
    EXPECT_LE(steps[1], 1.01 * steps[0]) << "damping " << damping_rate;
    EXPECT_GE(steps[1], 0.25 * steps[0]) << "the stiffest tets are about four times as stiff as at rest";
  }
}

// A step that was stable at rest is refused, not taken, once the tissue has stiffened beyond it.
TEST(StableStep, GivenStepIsRefusedWhenTissueStiffens) {
  const Stretched body;
  Tissue tissue;
  tissue.law = LinearLaw{30.0 * tissue.youngs_modulus};
  SimulationOptions options;
  options.step = 0.8 * free_step(body.mesh, tissue);
  Simulation simulation(body.mesh, {{0, tissue}}, options);
  simulation.set_state(body.u, std::vector<Vec3d>(body.u.size()));
  const StepResult result = simulation.step();
  EXPECT_EQ(result.status, StepStatus::step_too_large);
  EXPECT_EQ(simulation.steps(), 0U);
  EXPECT_LT(simulation.stable_step(), *options.step);
}

// A step above h* is refused at construction, with h* and the ways out in the message.
TEST(StableStep, TooLargeAStepIsAnError) {
  try {
    Simulation(test::paper_mesh(), {{0, Tissue{}}}, {.step = 0.01});
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("step = 0.01 s is above the stable step h* = 0.00236"), std::string::npos) << text;
    for (const char* way : {"smaller step", "nodal damping", "mass scaling"})
      EXPECT_NE(text.find(way), std::string::npos);
  }
}

}  // namespace
}  // namespace glisson::stable_step_test
