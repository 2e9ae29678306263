// Viscosity in stages beside instruments: pressed tissue comes to the force at rest that it has with one stage, and more stages
// than three are refused.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "glisson/instruments/contact.h"
#include "instruments/contact_scenes.h"
#include "support/bodies.h"
#include "support/must_step.h"

namespace glisson::drag_stages_beside_instruments {
namespace {

struct Rest {
  double poisson_ratio, viscosity;
};
void PrintTo(const Rest& c, std::ostream* out) { *out << "nu " << c.poisson_ratio << ", eta " << c.viscosity; }

class StagesBesideABall : public testing::TestWithParam<Rest> {};

/// Force on a ball that stands a fifth of its radius deep in a block, after a second.
double force_at_rest(const Rest& c, int stages) {
  Tissue tissue;
  tissue.poisson_ratio = c.poisson_ratio;
  tissue.viscosity = c.viscosity;
  SimulationOptions o = test::in_double();
  o.damping_rate = 60.0;
  o.drag_stages = stages;
  o.track_energies = false;
  const TetMesh mesh = box_mesh({.cells = {6, 6, 4}, .size = {0.03, 0.03, 0.02}});
  Simulation s(mesh, {{0, tissue}}, o);
  s.fix(mesh.vertex_sets.at("z_min"));
  ContactOptions ball;
  ball.shape = Ball{.radius = 0.01};
  const auto tool = std::make_shared<ContactTool>(ball, std::make_shared<test::GivenPath>([](double t) {
                                                    const double way = std::min(1.0, t / 0.1);
                                                    return Pose{{0.015, 0.015, 0.02 - 2e-3 * way}};
                                                  }));
  s.attach(tool);
  while (s.time() < 0.6) test::must_step(s);
  return std::abs(tool->forces().total().z);
}

// The ball stands still on tissue that has come to rest. Two stages have the force of one; with three, tissue under the ball has
// yielded a little.
TEST_P(StagesBesideABall, FindTheForceAtRest) {
  const double one = force_at_rest(GetParam(), 1), two = force_at_rest(GetParam(), 2),
               three = force_at_rest(GetParam(), 3);
  EXPECT_NEAR(two, one, 0.004 * one);
  EXPECT_NEAR(three, one, 0.045 * one);
  RecordProperty("two_apart", std::to_string(two / one - 1.0));
  RecordProperty("three_apart", std::to_string(three / one - 1.0));
}
INSTANTIATE_TEST_SUITE_P(DragStages, StagesBesideABall,
                         testing::Values(Rest{0.3, 30.0}, Rest{0.45, 30.0}, Rest{0.45, 100.0}, Rest{0.49, 30.0}));

TEST(DragStages, AreThreeAtMostBesideInstruments) {
  SimulationOptions o;
  o.drag_stages = kMostDragStagesBesideInstruments + 1;
  Tissue tissue;
  tissue.viscosity = 10.0;
  Simulation s(test::paper_mesh(), {{0, tissue}}, o);
  const auto tool = std::make_shared<ContactTool>(ContactOptions{}, std::make_shared<test::GivenPath>([](double) {
                                                    return Pose{{0.0, 0.0, 1.0}};
                                                  }));
  EXPECT_THROW(s.attach(tool), std::invalid_argument);
}

}  // namespace
}  // namespace glisson::drag_stages_beside_instruments
