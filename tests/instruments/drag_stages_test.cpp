// Viscosity in stages beside instruments: stages leave what instruments hold as it is, so that forces are those of one stage; more
// stages than are right beside what acts are refused.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "glisson/instruments/contact.h"
#include "glisson/instruments/container.h"
#include "instruments/contact_scenes.h"
#include "instruments/needle_scenes.h"
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

// The ball stands still on tissue that has come to rest: the force is that of one stage, closely with two, and lower with more, as
// points under the ball go for a step with the lumped mass alone.
TEST_P(StagesBesideABall, FindTheForceAtRest) {  // long: 1, 2, 3
  const double one = force_at_rest(GetParam(), 1);
  const auto expect = [&](int stages, double apart) {
    const double force = force_at_rest(GetParam(), stages);
    EXPECT_NEAR(force, one, apart * one) << stages << " stages";
    RecordProperty("apart_" + std::to_string(stages), std::to_string(force / one - 1.0));
  };
  expect(2, 0.004), expect(kMostDragStagesBesideOthers, 0.016);
}
INSTANTIATE_TEST_SUITE_P(DragStages, StagesBesideABall,
                         testing::Values(Rest{0.3, 30.0}, Rest{0.45, 30.0}, Rest{0.45, 100.0}, Rest{0.49, 30.0}));

/// Force on a needle over time: it presses, pierces, goes on into tissue with η = 100 Pa·s and comes back.
struct Course {
  std::vector<double> force;  ///< means over 5 ms [N]
  double puncture = 0.0;      ///< [s]
  Energies energies;
};

test::Inserted viscous_insertion(int stages, int threads = 1, Precision precision = Precision::single_precision) {
  test::Insertion o;
  o.mesh = {.radius = 0.02, .height = 0.03, .radial_cells = 4, .axial_cells = 6, .grading = 2.0};
  o.start = {0.0, 0.0, 0.0302};
  o.viscosity = 100.0;
  o.needle.rupture.force = 0.4;
  o.strokes = {{.to = {0, 0, -0.012}, .velocity = 0.04, .ramp = 0.02, .rest = 0.05},
               {.to = {0, 0, 0.012}, .velocity = 0.04, .ramp = 0.02, .rest = 0.0}};
  o.options.drag_stages = stages;
  o.options.threads = threads;
  o.options.precision = precision;
  return test::insert(o);
}

Course course(int stages) {
  test::Inserted in = viscous_insertion(stages);
  Course c;
  double sum = 0.0, since = 0.0;
  while (in.simulation.time() < in.end) {
    const double before = in.simulation.time();
    test::must_step(in.simulation);
    const double h = in.simulation.time() - before;
    sum += in.needle->forces().total().z * h, since += h;
    if (since < 5e-3) continue;
    c.force.push_back(sum / since);
    sum = since = 0.0;
  }
  for (const InstrumentEvent& e : in.needle->events()) {
    if (e.event == "puncture") c.puncture = e.time;
  }
  c.energies = in.simulation.energies();
  return c;
}

// What a needle holds, stages leave as it is: four give the force, the puncture and the dissipation of one. Left out are 20 ms around the
// puncture, where the tissue springs back.
TEST(DragStages, FollowANeedle) {  // long
  const Course one = course(1);
  double peak = 0.0;
  for (const double f : one.force) peak = std::max(peak, std::abs(f));
  ASSERT_GT(one.puncture, 0.0);
  for (const int stages : {3, kMostDragStagesBesideInstruments}) {
    const Course staged = course(stages);
    EXPECT_NEAR(staged.puncture, one.puncture, 2e-3) << stages << " stages";
    double square = 0.0, count = 0.0;
    for (std::size_t k = 0; k < std::min(one.force.size(), staged.force.size()); ++k) {
      if (std::abs(5e-3 * (static_cast<double>(k) + 0.5) - one.puncture) < 0.02) continue;
      square += std::pow(staged.force[k] - one.force[k], 2), count += 1.0;
    }
    const double apart = std::sqrt(square / count) / peak;
    RecordProperty("apart_" + std::to_string(stages), std::to_string(apart));
    EXPECT_LE(apart, 0.005) << stages << " stages";
    EXPECT_NEAR(staged.energies.dissipated, one.energies.dissipated, 0.05 * one.energies.dissipated);
    EXPECT_LE(std::abs(staged.energies.imbalance()), 1e-9 * staged.energies.dissipated);
  }
}

// Same bytes on any number of threads, and from a checkpoint on, with what was held in the last step.
TEST(DragStages, BesideANeedleGiveTheSameBytes) {
  test::Inserted one = viscous_insertion(4), three = viscous_insertion(4, 3), again = viscous_insertion(4, 2);
  const auto run = [](test::Inserted& in, double end) {
    while (in.simulation.time() < end) test::must_step(in.simulation);
  };
  run(one, 0.15), run(three, 0.15);
  EXPECT_EQ(one.needle->stage(), NeedleStage::inside);
  EXPECT_EQ(one.simulation.state_hash(), three.simulation.state_hash());
  std::stringstream saved;
  one.simulation.save(saved);
  again.simulation.load(saved);
  run(one, 0.2), run(again, 0.2);
  EXPECT_EQ(one.simulation.state_hash(), again.simulation.state_hash());
}

// A free body gains the momentum that a ball gives it, whatever its stages do within.
TEST(DragStages, GiveABodyTheMomentumOfTheBall) {
  Tissue tissue;
  tissue.viscosity = 50.0;
  SimulationOptions o = test::in_double();
  o.drag_stages = kMostDragStagesBesideOthers;
  Simulation s(box_mesh({.cells = {5, 5, 4}, .size = {0.03, 0.03, 0.02}}), {{0, tissue}}, o);
  ContactOptions ball;
  ball.shape = Ball{.radius = 0.01};
  ball.friction = 0.3;
  const auto tool = std::make_shared<ContactTool>(ball, std::make_shared<test::GivenPath>([](double t) {
                                                    return Pose{{0.013 + 0.05 * t, 0.015, 0.02 - 0.1 * t}};
                                                  }));
  s.attach(tool);
  Vec3d given{};
  double largest = 0.0;
  while (s.time() < 0.05) {
    const double before = s.time();
    test::must_step(s);
    given += tool->forces().total() * (s.time() - before);
    largest = std::max(largest, norm(given));
  }
  EXPECT_GT(largest, 1e-4);
  EXPECT_LE(norm(test::momentum(s) - given), 1e-11 * largest);
}

/// A program's own, which does not tell what it holds.
class Untold : public Interaction {
 public:
  void attached(const BodyView&, double) override {}
  void body_changed(const BodyView&, std::span<const std::uint32_t>) override {}
  std::span<const std::uint32_t> reach(double, double) override { return {}; }
};

// More stages than are right beside what acts on a body are refused; a bonded container takes all.
TEST(DragStages, AreLimitedByWhatActs) {
  Tissue tissue;
  tissue.viscosity = 10.0;
  const TetMesh mesh = box_mesh({.cells = {4, 4, 4}, .size = {0.03, 0.03, 0.03}});
  const auto refuses = [&](int stages, const std::shared_ptr<Interaction>& interaction) {
    SimulationOptions o;
    o.drag_stages = stages;
    Simulation s(mesh, {{0, tissue}}, o);
    try {
      s.attach(interaction);
    } catch (const std::invalid_argument& e) {
      EXPECT_NE(std::string(e.what()).find("drag_stages = " + std::to_string(stages)), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("integrator = implicit"), std::string::npos) << e.what();
      return true;
    }
    return false;
  };
  const auto above = [] { return test::standing(Pose{{0.015, 0.015, 0.1}}); };
  const auto vessel = [](bool bonded) {
    ContainerOptions o;
    o.vessel = BoxVessel{.width = 0.1, .length = 0.1, .height = 0.1};
    o.bonded = bonded;
    return std::make_shared<Container>(o);
  };
  EXPECT_TRUE(refuses(kMostDragStagesBesideInstruments + 1, std::make_shared<Needle>(NeedleOptions{}, above())));
  EXPECT_FALSE(refuses(kMostDragStages, vessel(true)));
  EXPECT_TRUE(refuses(kMostDragStagesBesideInstruments + 1, vessel(false)));
  EXPECT_TRUE(refuses(kMostDragStagesBesideOthers + 1, std::make_shared<ContactTool>(ContactOptions{}, above())));
  EXPECT_FALSE(refuses(kMostDragStagesBesideOthers, std::make_shared<ContactTool>(ContactOptions{}, above())));
  EXPECT_TRUE(refuses(kMostDragStagesBesideOthers + 1, std::make_shared<Untold>()));
  EXPECT_FALSE(refuses(kMostDragStagesBesideOthers, std::make_shared<Untold>()));
}

}  // namespace
}  // namespace glisson::drag_stages_beside_instruments
