// A step that is not made says why and what to do, whatever the integrator, and a loop over time can end on it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "glisson/instruments/motion.h"
#include "glisson/simulation/simulation.h"
#include "support/integrators.h"

namespace glisson {
namespace {

using ::testing::HasSubstr;

TetMesh cube() { return box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}}); }

/// A cube that stiffens steeply when it is pressed.
Tissue steep() {
  Tissue tissue;
  tissue.law = LinearLaw{1e6};
  return tissue;
}

/// Pressed to the half within a second.
Simulation pressed(const SimulationOptions& options) {
  const TetMesh mesh = cube();
  Simulation simulation(mesh, {{0, steep()}}, options);
  simulation.fix(mesh.vertex_sets.at("z_min"));
  simulation.drive(mesh.vertex_sets.at("z_max"), press({.velocity = 0.01, .depth = 0.01}));
  return simulation;
}

// A given step that the tissue outgrows is refused with h* and the ways out, again and again, and time stays.
TEST(StepMessage, NamesTheStableStepThatTissueHasOutgrown) {
  for (const Integrator integrator : {Integrator::central_difference, Integrator::semi_implicit}) {
    const double h = pressed({.integrator = integrator}).stable_step();
    Simulation s = pressed({.integrator = integrator, .step = 0.95 * h});
    const StepResult last = s.advance_to(1.0);
    EXPECT_EQ(last.status, StepStatus::step_too_large);
    EXPECT_FALSE(last.made());
    const std::string message(last.message);
    for (const char* part : {"stiffened", "stable step h* = ", "smaller step", "auto", "implicit"})
      EXPECT_THAT(message, HasSubstr(part));
    const double reached = s.time();
    EXPECT_GT(reached, 0.0);
    EXPECT_LT(reached, 1.0);
    EXPECT_LT(s.stable_step(), 0.95 * h);
    EXPECT_EQ(std::string(s.step().message), message);
    EXPECT_EQ(s.time(), reached);
  }
}

// A state that is not finite: no integrator keeps silent.
TEST(StepMessage, SaysWhatIsNotFinite) {
  for (const Integrator integrator : test::every_integrator()) {
    const TetMesh mesh = cube();
    Simulation s(mesh, {{0, Tissue{}}}, {.integrator = integrator});
    s.fix(mesh.vertex_sets.at("z_min"));
    std::vector<Vec3d> u(mesh.vertices.size());
    u[13].x = std::numeric_limits<double>::quiet_NaN();
    s.set_state(u, std::vector<Vec3d>(u.size()));
    const StepResult step = s.step();
    EXPECT_FALSE(step.made()) << static_cast<int>(integrator);
    EXPECT_THAT(std::string(step.message), HasSubstr("not finite")) << static_cast<int>(integrator);
    EXPECT_THAT(std::string(step.message), HasSubstr("Ways out")) << static_cast<int>(integrator);
  }
}

// Statics of a body that nothing holds.
TEST(StepMessage, SaysWhatIsNotHeld) {
  Simulation loose(cube(), {{0, Tissue{}}}, {.integrator = Integrator::quasi_static});
  const StepResult step = loose.step();
  EXPECT_EQ(step.status, StepStatus::not_held);
  EXPECT_THAT(std::string(step.message), HasSubstr("Hold at least three"));
}

// Steps that are made have nothing to say, and end where they were asked to.
TEST(StepMessage, IsEmptyWhereStepsAreMade) {
  for (const Integrator integrator : test::every_integrator()) {
    const TetMesh mesh = cube();
    Simulation s(mesh, {{0, Tissue{}}}, {.integrator = integrator});
    s.fix(mesh.vertex_sets.at("z_min"));
    s.drive(mesh.vertex_sets.at("z_max"), press({.velocity = 0.01, .depth = 0.001}));
    const StepResult last = s.advance_to(0.05);
    EXPECT_TRUE(last.made());
    EXPECT_TRUE(last.message.empty());
    EXPECT_NEAR(s.time(), 0.05, 0.51 * s.step_size());
    EXPECT_TRUE(s.advance_to(0.01).made()) << "that is over already: no step";
    EXPECT_NEAR(s.time(), 0.05, 0.51 * s.step_size());
  }
}

}  // namespace
}  // namespace glisson
