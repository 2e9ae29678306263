// States in memory: what is refused changes nothing, reset goes to where the first step began, a checkpoint is read in a simulation that
// has gone on otherwise, and tissue may go under a needle in every integrator.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "glisson/instruments/contact.h"
#include "glisson/instruments/needle.h"
#include "glisson/instruments/tool_motion.h"
#include "support/bodies.h"
#include "support/integrators.h"
#include "support/must_step.h"

namespace glisson::state_test {
namespace {

using testing::HasSubstr;

constexpr double kSize = 0.03;

TetMesh block() { return box_mesh({.cells = {4, 4, 4}, .size = {kSize, kSize, kSize}}); }

Simulation on_its_bottom(Integrator integrator = Integrator::central_difference) {
  SimulationOptions o;
  o.integrator = integrator;
  o.damping_rate = 20.0;
  o.implicit.largest_step = 2e-3;
  Simulation s(block(), {{0, Tissue{}}}, o);
  s.fix("z_min");
  return s;
}

std::shared_ptr<ToolDriver> down(double x, double y, double speed) {
  return std::make_shared<PathDriver>(Pose{.position = {x, y, kSize + 1e-4}}, steady_path({.velocity = speed}));
}

std::shared_ptr<ContactTool> ball(double x = 0.5 * kSize) {
  return std::make_shared<ContactTool>(ContactOptions{.shape = Ball{.radius = 4e-3}}, down(x, 0.5 * kSize, 0.2));
}

void run(Simulation& s, int steps) {
  for (int i = 0; i < steps; ++i) test::must_step(s);
}

std::string refusal(Simulation& s, const State& state) {
  try {
    s.load_state(state);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

// What has been added since is named: a support, a motion, a load, an instrument. Nothing has changed then.
TEST(States, AreRefusedByName) {
  const auto refused_after = [](const std::function<void(Simulation&)>& add) {
    Simulation s = on_its_bottom();
    run(s, 10);
    const State state = s.save_state();
    run(s, 10);
    add(s);
    const std::uint64_t hash = s.state_hash();
    const double time = s.time();
    const std::string why = refusal(s, state);
    EXPECT_EQ(s.state_hash(), hash);
    EXPECT_EQ(s.time(), time);
    run(s, 2);
    return why;
  };
  EXPECT_THAT(refused_after([](Simulation& s) { s.fix("z_max"); }),
              HasSubstr("a support of 25 vertices (no. 2) has been added"));
  EXPECT_THAT(refused_after([](Simulation& s) { s.drive("z_max", [](double) { return Vec3d{}; }); }),
              HasSubstr("a motion of 25 vertices (no. 2) has been added"));
  EXPECT_THAT(refused_after([](Simulation& s) {
                s.add_load("z_max", {0, 0, 1e-3});
              }),
              HasSubstr("load no. 1 has been added"));
  EXPECT_THAT(refused_after([](Simulation& s) { s.attach(ball()); }), HasSubstr("instrument \"tool\" has been added"));
  Simulation s = on_its_bottom(), other = on_its_bottom();
  EXPECT_THAT(refusal(s, State{}), HasSubstr("of no simulation"));
  EXPECT_THAT(refusal(s, other.save_state()), HasSubstr("of another simulation"));
}

// A version of the body that was kept before a support came is not that of the states saved after it.
TEST(States, KnowWhatHoldsTheBodyWhenTheySave) {
  Simulation s = on_its_bottom();
  run(s, 5);
  const State whole = s.save_state();
  s.remove_tets(std::vector<std::uint32_t>{0});
  run(s, 5);
  s.load_state(whole);
  s.add_load("x_max", {1e-3, 0, 0});
  s.fix("z_max");
  const State held = s.save_state();
  run(s, 5);
  const std::uint64_t hash = s.state_hash();
  s.remove_tets(std::vector<std::uint32_t>{1});
  run(s, 5);
  s.load_state(held);
  run(s, 5);
  EXPECT_EQ(s.state_hash(), hash);
}

// reset goes to the state in which the first step was made, whatever came since, again and again; before it, nothing happens.
TEST(States, ResetToTheFirstStep) {
  for (const Integrator integrator : test::every_integrator()) {
    Simulation s = on_its_bottom(integrator);
    s.reset();
    const auto tool = ball();
    s.attach(tool);
    std::vector<std::uint64_t> ends;
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(s.time(), 0.0);
      EXPECT_EQ(tool->depth(), 0.0);
      run(s, 12);
      ends.push_back(s.state_hash());
      if (i == 1) s.remove_tets(std::vector<std::uint32_t>{3, 4}), run(s, 2);
      s.reset();
    }
    EXPECT_EQ(ends[1], ends[0]);
    EXPECT_EQ(ends[2], ends[0]);
  }
}

// A checkpoint of an earlier time, of other tets and of a body that was whole is read where it was written, after instruments have acted.
TEST(States, AreReadFromFilesWhereTheyWereWritten) {
  for (const Integrator integrator : test::every_integrator()) {
    Simulation s = on_its_bottom(integrator);
    s.attach(ball());
    std::stringstream start, early;
    s.save(start);
    run(s, 4);
    s.save(early);
    run(s, 8);
    const std::uint64_t end = s.state_hash();
    s.remove_tets(std::vector<std::uint32_t>{3, 4});
    run(s, 2);
    s.load(early);
    run(s, 8);
    EXPECT_EQ(s.state_hash(), end) << word_of(integrator);
    s.load(start);
    run(s, 12);
    EXPECT_EQ(s.state_hash(), end) << word_of(integrator);
  }
}

// A file that is refused leaves the simulation as it was, a cut one too.
TEST(States, StayWhereAFileIsRefused) {
  Simulation s = on_its_bottom();
  s.attach(ball());
  run(s, 20);
  std::stringstream other_file;
  {
    Simulation other = on_its_bottom();
    run(other, 5);
    other.save(other_file);
  }
  s.remove_tets(std::vector<std::uint32_t>{3});
  run(s, 5);
  const std::uint64_t hash = s.state_hash();
  const State here = s.save_state();
  EXPECT_THROW(s.load(other_file), std::runtime_error);
  EXPECT_EQ(s.state_hash(), hash);
  EXPECT_TRUE(s.is_removed(3));
  run(s, 5);
  const std::uint64_t after = s.state_hash();
  s.load_state(here);
  run(s, 5);
  EXPECT_EQ(s.state_hash(), after);
}

// Tissue that goes under an inserted needle, or that holds its path: the run goes on in every integrator.
TEST(States, TissueGoesUnderAnInsertedNeedle) {
  for (const Integrator integrator : test::every_integrator()) {
    Simulation s = on_its_bottom(integrator);
    NeedleOptions o;
    o.rupture.force = 0.01, o.tip.cutting = 0.005, o.spacing = 2e-3, o.zone = 6e-3;
    const auto needle = std::make_shared<Needle>(o, down(0.47 * kSize, 0.52 * kSize, 0.3));
    s.attach(needle);
    while (s.time() < 0.04) test::must_step(s);
    ASSERT_GT(needle->inserted_length(), 2e-3) << word_of(integrator);
    std::vector<std::uint32_t> gone;
    const TetMesh& mesh = s.mesh();
    for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
      Vec3d middle{};
      for (const std::uint32_t v : mesh.tets[t]) middle += mesh.vertices[v] * 0.25;
      if (middle.z > 0.7 * kSize && std::abs(middle.x - 0.47 * kSize) < 6e-3) gone.push_back(t);
    }
    ASSERT_GT(gone.size(), 10U);
    s.remove_tets(gone);
    while (s.time() < 0.06) test::must_step(s);
    EXPECT_TRUE(std::isfinite(norm(needle->force())));
  }
}

}  // namespace
}  // namespace glisson::state_test
