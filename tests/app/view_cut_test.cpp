// A stroke of the hand's blade parts the body there and nowhere else, keeps its motion, and no stroke holds the engine up.
#include <chrono>
#include <cmath>
#include <random>
#include <thread>

#include "app/program.h"
#include "view/engine/engine.h"
#include "view/state/surface.h"

namespace glisson::view {
namespace {

using namespace std::chrono_literals;

/// A block 20 × 20 × 30 mm, held below, its top pulled by a tool.
Variant block() {
  return parse_scene(R"([mesh]
kind = "box"
cells = [4, 4, 6]
size_m = [0.02, 0.02, 0.03]
[tissue]
youngs_modulus_Pa = 3600
poisson_ratio = 0.4
[motion]
damping_rate_per_s = 20
[[fixed]]
set = "z_min"
[[tool]]
set = "z_max"
direction = [0, 0, -1]
velocity_mm_s = 100
depth_mm = 8
)",
                     "view.toml", ".")
      .variants.front();
}

/// A blade along y that reaches past the block on both sides.
BladeEdge blade(double x, double z) { return {{x, -0.01, z}, {x, 0.03, z}}; }

Command cut(const BladeEdge& edge, bool begins) {
  const auto f = [](double x) { return static_cast<float>(x); };
  return {.kind = CommandKind::cut,
          .index = begins ? 1u : 0u,
          .values = {f(edge.from.x), f(edge.from.y), f(edge.from.z), f(edge.to.x), f(edge.to.y), f(edge.to.z)}};
}

template <class Enough>
bool until(Engine& engine, Snapshot& last, Enough enough) {
  for (int i = 0; i < 60000; ++i) {
    if (const Snapshot* state = engine.latest()) last = *state;
    if (enough()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return false;
}

/// Works off all that waits. @return how many pieces
int work_off(LiveBody& body) {
  int pieces = 0;
  while (body.cut()->waits()) {
    body.work_on_cut(HandCut::Clock::now());
    ++pieces;
    std::this_thread::sleep_for(10us);
  }
  return pieces;
}

Vec3d momentum(const Simulation& simulation) {
  Vec3d sum{};
  for (std::size_t v = 0; v < simulation.masses().size(); ++v) sum += simulation.velocity()[v] * simulation.masses()[v];
  return sum;
}

// A block that is pulled and cut through is in two pieces, and the tool's force is gone; undo and reset make it whole.
TEST(LiveCut, PartsABlockUnderAPull) {
  Engine engine(block(), {});
  ASSERT_EQ(engine.why_no_cut(), "");
  engine.start();
  Snapshot last;
  engine.post({.kind = CommandKind::place, .sequence = 1, .values = {-0.002f, 0.0f, 0.0f}});
  ASSERT_TRUE(until(engine, last, [&] { return last.echo == 1 && last.time > 1.0; }));
  const double pulled = last.tools.front().force.z;
  ASSERT_GT(pulled, 0.05);
  EXPECT_EQ(Surface(last.shape).pieces(), 1u);
  const std::uint32_t before = last.shape_number;

  engine.post(cut(blade(-0.005, 0.0162), true));
  for (std::uint32_t i = 1; i <= 15; ++i) {
    Command command = cut(blade(-0.005 + 0.002 * i, 0.0162), false);
    command.sequence = i + 1;
    engine.post(command);
  }
  ASSERT_TRUE(until(engine, last, [&] { return last.echo == 16; }));
  const double done = last.time;
  ASSERT_TRUE(until(engine, last, [&] { return last.shape_number > before && last.time > done + 2.0; }));
  EXPECT_EQ(Surface(last.shape).pieces(), 2u);
  // The section is 4 cm²; what is pulled is waisted by some 4 % across, which the cut's area at rest is free of.
  EXPECT_NEAR(last.cut_area, 4e-4, 0.02 * 4e-4);
  // Only what still swings is left: 2 s of damping at 20/s take it to exp(−20).
  EXPECT_LT(norm(last.tools.front().force), 1e-4 * pulled);

  // Undone, the block is whole again and pulled as before, at the time of the stroke.
  engine.post({.kind = CommandKind::undo, .sequence = 20});
  ASSERT_TRUE(until(engine, last, [&] { return last.epoch == 1; }));
  EXPECT_LT(last.time, done);
  EXPECT_EQ(Surface(last.shape).pieces(), 1u);
  EXPECT_EQ(last.cut_area, 0.0);
  const double undone = last.time;
  ASSERT_TRUE(until(engine, last, [&] { return last.time > undone + 0.2; }));
  EXPECT_NEAR(last.tools.front().force.z, pulled, 1e-3 * pulled);

  engine.post({.kind = CommandKind::reset, .sequence = 21});
  ASSERT_TRUE(until(engine, last, [&] { return last.epoch == 2; }));
  EXPECT_EQ(Surface(last.shape).pieces(), 1u);
  EXPECT_EQ(last.cut_area, 0.0);
  engine.stop();
}

// A stroke of sixteen commands waits for its pieces; the number that comes back is that of a stroke which is cut. The section
// is 4 cm², and what a block at rest has cut of itself is that to 2 %.
TEST(LiveCut, IsEchoedWhenItIsDone) {
  Engine engine(block(), {});
  engine.start();
  for (std::uint32_t i = 0; i < 16; ++i) {
    Command command = cut(blade(-0.005 + 0.002 * i, 0.0162), i == 0);
    command.sequence = i + 1;
    ASSERT_TRUE(engine.post(command));
  }
  Snapshot last;
  ASSERT_TRUE(until(engine, last, [&] { return last.echo == 16; }));
  EXPECT_NEAR(last.cut_area, 4e-4, 0.02 * 4e-4);
  engine.stop();
}

// A cut gives the body no push. Vertices are moved onto it, to points whose velocity is interpolated between vertices: exact
// where it is linear, so that what is left is rounding in single precision.
TEST(LiveCut, KeepsMomentum) {
  LiveBody body(block(), {});
  Simulation& simulation = body.built().simulation;
  std::vector<Vec3d> velocity;
  for (const Vec3d& x : simulation.mesh().vertices) velocity.push_back({2.0 * x.z, -x.z, x.z});
  simulation.set_state(std::vector<Vec3d>(velocity.size()), velocity);
  const Vec3d before = momentum(simulation);
  ASSERT_GT(norm(before), 1e-5);
  body.cut()->begin(blade(-0.005, 0.0162));
  body.cut()->draw(blade(0.025, 0.0171));
  work_off(body);
  EXPECT_GT(body.cut()->area(), 3e-4);
  EXPECT_LT(norm(momentum(simulation) - before), 1e-6 * norm(before));
}

// A stroke beside the body, one without length and one as long as numbers may be leave a body that moves on.
TEST(LiveCut, BearsStrokesThatMeetNothing) {
  LiveBody body(block(), {});
  const std::size_t key = body.shape_key();
  body.cut()->draw(blade(0.01, 0.01));  // without a beginning
  EXPECT_FALSE(body.cut()->waits());
  body.cut()->begin(blade(1.0, 0.01));
  body.cut()->draw(blade(2.0, 0.01));
  body.cut()->begin({{0.01, 0.01, 0.01}, {0.01, 0.01, 0.01}});
  body.cut()->draw({{0.02, 0.02, 0.02}, {0.02, 0.02, 0.02}});
  body.cut()->begin(blade(0.01, 0.01));
  for (int i = 0; i < 5; ++i) body.cut()->draw(blade(0.01, 0.01));
  work_off(body);
  EXPECT_EQ(body.shape_key(), key);
  body.cut()->begin({{-100.0, -100.0, 0.0162}, {-100.0, 100.0, 0.0162}});
  body.cut()->draw({{100.0, -100.0, 0.0162}, {100.0, 100.0, 0.0162}});
  work_off(body);
  EXPECT_EQ(Surface(body.shape()).pieces(), 2u) << "in one sweep through all of it";
}

// A million points wait in little room; all strokes over, the body is finite and every tet there still.
TEST(LiveCut, BearsAMillionPoints) {
  LiveBody body(block(), {});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(-0.005, 0.035);
  body.cut()->begin(blade(at(random), at(random)));
  for (int i = 0; i < 1'000'000; ++i) body.cut()->draw(blade(at(random), at(random)));
  for (int i = 0; i < 1000; ++i) body.cut()->begin(blade(at(random), at(random)));
  EXPECT_LE(work_off(body) / 10'000, 10) << "pieces and the waits between them";
  for (int frame = 0; frame < 50; ++frame)
    app::advance_to(body.built(), OnInversion::go_on, 0.001 * (frame + 1), std::atomic<bool>{false});
  EXPECT_EQ(body.built().simulation.present_mesh().tets.size(), 4u * 4u * 6u * 6u);
  for (const Vec3d& u : body.built().simulation.displacement()) ASSERT_TRUE(std::isfinite(norm(u)));
}

// What a hand holds it holds on both sides of a cut, without a jump of its force; the steps stay stable.
TEST(LiveCut, LeavesTheHandItsHold) {
  LiveBody body(block(), {});
  Simulation& simulation = body.built().simulation;
  std::vector<std::uint32_t> patch;
  for (std::uint32_t v = 0; v < simulation.mesh().vertices.size(); ++v) {
    if (norm(simulation.mesh().vertices[v] - Vec3d{0.02, 0.01, 0.015}) < 0.0071) patch.push_back(v);
  }
  ASSERT_GT(patch.size(), 5u);
  body.grab()->hold(patch, simulation.displacement(), simulation.masses(), 100.0);
  body.grab()->draw({0.003, 0.0, 0.0}, 0.001);
  const std::atomic<bool> stop{false};
  app::advance_to(body.built(), OnInversion::go_on, 0.5, stop);
  const double before = body.grab()->force().x;
  ASSERT_GT(before, 0.05);
  body.cut()->begin(blade(-0.005, 0.0162));
  body.cut()->draw(blade(0.03, 0.0162));
  work_off(body);
  app::advance_to(body.built(), OnInversion::go_on, simulation.time() + 2.0 * simulation.step_size(), stop);
  EXPECT_NEAR(body.grab()->force().x, before, 0.05 * before);
  app::advance_to(body.built(), OnInversion::go_on, simulation.time() + 0.5, stop);
  EXPECT_GT(body.grab()->force().x, 0.0);
  for (const Vec3d& u : simulation.displacement()) ASSERT_LT(norm(u), 0.02);
}

// A ball about a vertex takes what hangs together with it, not what lies on the other side of a cut.
TEST(LiveCut, AHandTakesOneSideOfACut) {
  LiveBody body(block(), {});
  body.cut()->begin(blade(-0.005, 0.015));
  body.cut()->draw(blade(0.025, 0.015));
  work_off(body);
  const Simulation& simulation = body.built().simulation;
  const std::vector<Vec3d> x = simulation.positions();
  std::uint32_t vertex = 0;
  for (std::uint32_t v = 0; v < x.size(); ++v) {
    if (norm(x[v] - Vec3d{0.02, 0.01, 0.02}) < norm(x[vertex] - Vec3d{0.02, 0.01, 0.02})) vertex = v;
  }
  const std::vector<std::uint32_t> patch = patch_around(simulation.mesh(), x, vertex, 0.012);
  double lowest = 1.0, nearest = 1.0;
  for (const std::uint32_t v : patch) lowest = std::min(lowest, x[v].z);
  for (const Vec3d& y : x) {
    if (norm(y - x[vertex]) < 0.012) nearest = std::min(nearest, y.z);
  }
  EXPECT_GT(patch.size(), 10u);
  EXPECT_LT(nearest, 0.012);
  EXPECT_GT(lowest, 0.012);
}

}  // namespace
}  // namespace glisson::view
