// What a program attaches to a body acts as a load or a support of the same meaning would, and the books stay exact.
#include "glisson/simulation/interaction.h"

#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>

#include "glisson/simulation/simulation.h"

namespace glisson {
namespace {

/// A force on a vertex, a spring to where it rests, or a hold; what it gave in the last step is kept.
struct Probe final : Interaction {
  std::uint32_t vertex = 0;
  Vec3d force{};
  double spring = 0.0;  // [N/m]
  bool holds = false;
  double lightest = 1.0;  // [kg]
  int changes = 0;
  Vec3d given{};

  void attached(const BodyView& body, double) override { lightest = body.masses[vertex]; }
  void body_changed(const BodyView&, std::span<const std::uint32_t>) override { ++changes; }
  std::span<const std::uint32_t> reach(double, double) override { return {&vertex, 1}; }
  void add_forces(const InteractionStep& step) override {
    ActiveVertex& w = step.vertices[step.place_of[vertex]];
    w.elastic += force - w.displacement * spring;
  }
  void declare(const InteractionStep& step, StepRows& rows, int round) override {
    if (holds && round == 0) rows.hold(step.place_of[vertex], {});
  }
  void solved(const InteractionStep& step, const StepRows& rows) override {
    if (holds) given = rows.holding_impulse(0) * (1.0 / step.h);
  }
  double squared_frequency() const override { return spring / lightest; }
};

TetMesh block() { return box_mesh({.cells = {4, 2, 2}, .size = {0.04, 0.02, 0.02}}); }
std::uint32_t middle(const TetMesh& mesh) {
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (norm(mesh.vertices[v] - Vec3d{0.02, 0.01, 0.02}) < 1e-9) return v;
  }
  throw std::logic_error("the block has no vertex there");
}

Simulation body(const SimulationOptions& options = {}) {
  TetMesh mesh = block();
  Tissue tissue;
  tissue.youngs_modulus = 3600;
  tissue.poisson_ratio = 0.4;
  Simulation s(mesh, {{0, tissue}}, options);
  s.fix(mesh.vertex_sets.at("z_min"));
  return s;
}

std::shared_ptr<Probe> probe() {
  auto p = std::make_shared<Probe>();
  p->vertex = middle(block());
  return p;
}

void advance(Simulation& s, int steps) {
  for (int i = 0; i < steps; ++i) ASSERT_EQ(s.step().status, StepStatus::ok);
}

// A force that an interaction adds moves the body as a load of the same size; it is booked as elastic, so that the
// balance of energies is exact: rounding of some 400 sums.
TEST(Interaction, ForceActsAsALoad) {
  Simulation a = body(), b = body();
  auto p = probe();
  p->force = {0.001, 0.0, -0.002};
  a.attach(p);
  b.add_load(std::vector{p->vertex}, p->force);
  advance(a, 400), advance(b, 400);
  EXPECT_NEAR(norm(a.displacement()[p->vertex] - b.displacement()[p->vertex]), 0.0, 1e-15);
  EXPECT_GT(norm(a.displacement()[p->vertex]), 1e-5);
  EXPECT_NEAR(a.energies().imbalance(), 0.0, 1e-12 * a.energies().kinetic + 1e-18);
}

// An impulse that stops a vertex is the force a support would need, and does no work.
TEST(Interaction, HoldingIsASupport) {
  SimulationOptions options;
  options.gravity = {0, 0, -9.81};
  Simulation a = body(options), b = body(options);
  auto p = probe();
  p->holds = true;
  a.attach(p);
  const ConstraintId support = b.fix(std::vector{p->vertex});
  advance(a, 300), advance(b, 300);
  EXPECT_EQ(a.state_hash(), b.state_hash());
  EXPECT_NEAR(norm(p->given - b.force(support).total()), 0.0, 1e-12 * norm(p->given));
  EXPECT_GT(norm(p->given), 1e-5);
  EXPECT_NEAR(a.energies().work_tools, 0.0, 1e-18);
}

/// Pushes on the vertices near a point that moves along the block, and keeps no others.
struct Roving final : Interaction {
  TetMesh mesh = block();
  bool lets_go = true;
  std::vector<std::uint32_t> near;
  std::size_t most_active = 0;
  void attached(const BodyView&, double) override {}
  void body_changed(const BodyView&, std::span<const std::uint32_t>) override {}
  std::span<const std::uint32_t> reach(double time, double) override {
    near.clear();
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      if (std::abs(mesh.vertices[v].x - 2.0 * time) < 0.006) near.push_back(v);
    }
    return near;
  }
  std::optional<std::span<const std::uint32_t>> keeps() override {
    if (!lets_go) return {};
    return near;
  }
  void add_forces(const InteractionStep& step) override {
    most_active = std::max(most_active, step.vertices.size());
    for (const std::uint32_t v : near) step.vertices[step.place_of[v]].elastic.z -= 0.001;
  }
};

// Vertices that an interaction has left move on as they would if they were still active, but for rounding; those of a support
// stay active. Two or three of the block's five layers of nine vertices are near the point, and nine vertices are held.
TEST(Interaction, VerticesThatItHasLeftAreLetGo) {
  Simulation a = body(), b = body();
  const auto lets_go = std::make_shared<Roving>(), keeps = std::make_shared<Roving>();
  keeps->lets_go = false;
  a.attach(lets_go), b.attach(keeps);
  std::stringstream file;
  while (a.time() < 0.02) {
    advance(a, 1), advance(b, 1);
    if (file.str().empty() && a.time() > 0.01) a.save(file);
  }
  const std::size_t held = block().vertex_sets.at("z_min").size(), all = block().vertices.size();
  EXPECT_EQ(keeps->most_active, all);
  EXPECT_LE(lets_go->most_active, held + 2 * 9);
  double most = 0.0, apart = 0.0;
  for (std::size_t v = 0; v < all; ++v) {
    most = std::max(most, norm(b.displacement()[v]));
    apart = std::max(apart, norm(a.displacement()[v] - b.displacement()[v]));
  }
  EXPECT_LE(apart, 1e-5 * most);  // forces in single precision
  EXPECT_GT(most, 1e-4);
  Simulation continued = body();
  continued.attach(std::make_shared<Roving>());
  continued.load(file);
  while (continued.time() < 0.02) advance(continued, 1);
  EXPECT_EQ(continued.state_hash(), a.state_hash());
}

// A support feels what an interaction pushes it with, in `load`.
TEST(Interaction, SupportsBearIt) {
  Simulation s = body();
  auto p = std::make_shared<Probe>();
  p->vertex = 0;  // held
  p->holds = true;
  struct Push final : Interaction {
    void attached(const BodyView&, double) override {}
    void body_changed(const BodyView&, std::span<const std::uint32_t>) override {}
    std::uint32_t vertex = 0;
    std::span<const std::uint32_t> reach(double, double) override { return {&vertex, 1}; }
    void declare(const InteractionStep& step, StepRows& rows, int round) override {
      if (round == 0) rows.push(step.place_of[0], Vec3d{0, 0, -0.5} * step.h);
    }
  };
  s.attach(std::make_shared<Push>());
  const TetMesh mesh = block();
  advance(s, 3);
  EXPECT_NEAR(s.force({0}).load.z, 0.5, 1e-12);
  EXPECT_EQ(norm(s.displacement()[0]), 0.0);
}

// A spring a thousand times stiffer than the tissue shortens the step to what it bears: 2/ω of the spring on its vertex, and
// the body stays where it is instead of blowing up.
TEST(Interaction, StiffSpringShortensTheStep) {
  Simulation s = body();
  const double before = s.stable_step();
  auto p = probe();
  p->spring = 1e5;
  p->force = {0, 0, -0.01};
  s.attach(p);
  const double spring_alone = 2.0 / std::sqrt(p->squared_frequency());
  EXPECT_LT(s.stable_step(), std::min(before, spring_alone));
  EXPECT_GT(s.stable_step(), 0.9 * spring_alone);
  EXPECT_LE(s.step_size(), s.stable_step());
  advance(s, 5000);
  // the spring swings by its static stretch, seen larger by 1/√(1 − (ωh/2)²) = 2.3 at 0.9 of the stable step
  EXPECT_LT(norm(s.displacement()[p->vertex]), 4 * 0.01 / p->spring);
}

// A spring that goes slack may be stiff again at the next step, as a torn membrane that whips back: an automatic step grows by
// 1.5 % a step at most, while the stable step, which a given one is held against, is the present one.
TEST(Interaction, StepGrowsBackSlowly) {
  Simulation s = body();
  const double alone = s.step_size();
  auto p = probe();
  p->spring = 1e5;
  s.attach(p);
  advance(s, 10);
  p->spring = 1.0;
  advance(s, 1);
  EXPECT_GT(s.stable_step(), alone);
  double step = s.step_size();
  EXPECT_LT(step, 0.1 * alone);
  int steps = 0;
  for (; step < 0.95 * alone && steps < 1000; ++steps) {
    advance(s, 1);
    EXPECT_LE(s.step_size(), 1.0151 * step);
    step = s.step_size();
  }
  EXPECT_LT(steps, 400);
}

// A given step that such a spring does not bear is not made, with a status.
TEST(Interaction, GivenStepAboveIsRefused) {
  SimulationOptions options;
  options.step = 1e-3;
  Simulation s = body(options);
  auto p = probe();
  p->spring = 1e5;
  s.attach(p);
  EXPECT_EQ(s.step().status, StepStatus::step_too_large);
}

TEST(Interaction, HearsOfChanges) {
  Simulation s = body();
  auto p = probe();
  s.attach(p);
  s.remove_tets(std::vector<std::uint32_t>{0});
  EXPECT_EQ(p->changes, 1);
  advance(s, 1);
}

// A run goes on from a checkpoint with the same bytes though its vertices at hand came by and by.
TEST(Interaction, CheckpointKeepsTheVerticesAtHand) {
  const auto made = [](std::shared_ptr<Probe> p) {
    Simulation s = body();
    p->force = {0.001, 0.0, -0.002};
    s.attach(std::move(p));
    return s;
  };
  Simulation a = made(probe());
  advance(a, 50);
  std::stringstream file;
  a.save(file);
  advance(a, 50);
  Simulation b = made(probe());
  b.load(file);
  advance(b, 50);
  EXPECT_EQ(a.state_hash(), b.state_hash());
}

TEST(Interaction, ImplicitIntegratorsRefuse) {
  for (const Integrator i : {Integrator::implicit, Integrator::quasi_static}) {
    SimulationOptions options;
    options.integrator = i;
    Simulation s = body(options);
    EXPECT_THROW(s.attach(probe()), std::invalid_argument);
  }
  EXPECT_THROW(body().attach(nullptr), std::invalid_argument);
}

// What an interaction knows of its past is of one body: a second one is refused, and so is the same body again. One that was
// refused, or is a copy, is free.
TEST(Interaction, ActsOnOneSimulation) {
  const auto p = probe();
  Simulation a = body(), b = body(), still = body({.integrator = Integrator::quasi_static});
  EXPECT_THROW(still.attach(p), std::invalid_argument);
  a.attach(p);
  for (Simulation* s : {&a, &b}) {
    try {
      s->attach(p);
      FAIL() << "attached twice";
    } catch (const std::invalid_argument& refused) {
      EXPECT_NE(std::string(refused.what()).find("acts on a simulation already"), std::string::npos) << refused.what();
    }
  }
  b.attach(std::make_shared<Probe>(*p));
  Simulation once = body();
  once.attach(probe());
  advance(a, 20), advance(b, 20), advance(once, 20);
  EXPECT_EQ(a.state_hash(), once.state_hash()) << "the refused one acts once";
  EXPECT_EQ(b.state_hash(), once.state_hash());
}

}  // namespace
}  // namespace glisson
