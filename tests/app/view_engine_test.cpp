// The live engine keeps what its readers and writers rely on, and a tool led by hand meets what the scene's motion meets.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <random>
#include <thread>

#include "app/program.h"
#include "glisson/io.h"
#include "view/engine/engine.h"
#include "view/protocol/command_bytes.h"
#include "view/thread/latest.h"
#include "view/thread/ring.h"

namespace glisson::view {
namespace {

using namespace std::chrono_literals;

Variant variant_of(const std::string& text) { return parse_scene(text, "view.toml", ".").variants.front(); }

MeshLoader no_files() {
  return [](const MeshFile& file) -> TetMesh { throw std::runtime_error(file.path.string() + ": no mesh files here"); };
}

/// Reads what an engine tells, as the server does.
struct Watcher {
  explicit Watcher(Engine& watched) : engine(watched) {}
  /// Looks until `enough` says so; a minute at most: how long it takes is the machine's affair, not the contract's.
  template <class Enough>
  bool until(Enough enough) {
    for (int i = 0; i < 60000; ++i) {
      if (const Snapshot* state = engine.latest()) last = *state;
      for (ForceSample sample; engine.next_sample(sample);) samples.push_back(sample);
      if (enough()) return true;
      std::this_thread::sleep_for(1ms);
    }
    return false;
  }
  Engine& engine;
  Snapshot last;
  std::vector<ForceSample> samples;
};

Command place(float depth, std::uint32_t sequence) {
  return {.kind = CommandKind::place, .sequence = sequence, .values = {depth, 0.0f, 0.0f}};
}

// While nobody looks the engine makes no steps, whatever the clock does; when somebody does, it goes on from there.
TEST(LiveEngine, MakesNoStepsUnwatched) {
  Engine engine(variant_of(test::small_scene()), no_files());
  Watcher watcher(engine);
  engine.start();
  ASSERT_TRUE(watcher.until([&] { return watcher.last.frame > 20; }));
  engine.set_watched(false);
  std::this_thread::sleep_for(100ms);  // a turn may be under way
  engine.post(place(0.0f, 1));         // a command brings the state up to date
  ASSERT_TRUE(watcher.until([&] { return watcher.last.echo == 1; }));
  const std::uint64_t frames = watcher.last.frame;
  const double time = watcher.last.time;
  std::this_thread::sleep_for(500ms);
  engine.post(place(0.0f, 2));
  ASSERT_TRUE(watcher.until([&] { return watcher.last.echo == 2; }));
  EXPECT_EQ(watcher.last.frame, frames);
  EXPECT_EQ(watcher.last.time, time);
  EXPECT_FALSE(watcher.last.paused);
  engine.set_watched(true);
  EXPECT_TRUE(watcher.until([&] { return watcher.last.time > time; }));
  EXPECT_LT(watcher.last.time, time + 0.3) << "the time that passed is not made up for";
  engine.stop();
}

// A reader of Latest never sees a half-written value and never goes back.
TEST(LiveHandOver, GivesWholeValuesInTheirOrder) {
  struct Pair {
    std::uint64_t a = 0, b = 0;
  };
  Latest<Pair> latest;
  constexpr std::uint64_t kLast = 200000;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kLast; ++i) {
      latest.back() = {i, ~i};
      latest.publish();
    }
  });
  std::uint64_t seen = 0;
  while (seen < kLast) {
    const Pair* pair = latest.take();
    if (pair == nullptr) continue;
    ASSERT_EQ(pair->b, ~pair->a);
    ASSERT_GT(pair->a, seen);
    seen = pair->a;
  }
  writer.join();
  EXPECT_EQ(latest.take(), nullptr);
}

// A ring hands over everything once and in order, and refuses what does not fit.
TEST(LiveHandOver, RingKeepsOrderAndRefusesWhatDoesNotFit) {
  Ring<int, 8> small;
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(small.push(i));
  EXPECT_FALSE(small.push(8));
  int got = -1;
  EXPECT_TRUE(small.pop(got));
  EXPECT_EQ(got, 0);
  EXPECT_TRUE(small.push(8));

  Ring<int, 64> ring;
  constexpr int kLast = 100000;
  std::thread writer([&] {
    for (int i = 0; i < kLast;) i += ring.push(i) ? 1 : 0;
  });
  for (int expected = 0; expected < kLast;) {
    if (!ring.pop(got)) continue;
    ASSERT_EQ(got, expected++);
  }
  writer.join();
}

// Every command survives its bytes; any other bytes are refused or are the bytes of the command they give.
TEST(LiveCommand, BytesAreReadBackOrRefused) {
  for (std::uint8_t kind = 1; kind <= 19; ++kind) {
    Command command{
        .kind = static_cast<CommandKind>(kind), .tool = 2, .sequence = 77, .index = 1, .values = {0.5f, 0.25f, 1.0f}};
    const std::string bytes = encode_command(command);
    ASSERT_LE(bytes.size(), kLongestCommand);
    const auto back = decode_command({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    ASSERT_TRUE(std::holds_alternative<Command>(back)) << int(kind);
    EXPECT_EQ(encode_command(std::get<Command>(back)), bytes);
  }
  std::mt19937 random(7);
  std::size_t read = 0;
  for (int i = 0; i < 200000; ++i) {
    std::vector<std::uint8_t> bytes(random() % 40);
    for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(random());
    if (bytes.size() > 3 && i % 2 == 0) {  // half of them look like messages
      bytes[0] = static_cast<std::uint8_t>(random() % 16);
      bytes[2] = bytes[3] = 0;
    }
    const auto got = decode_command(bytes);
    if (const auto* why = std::get_if<std::string>(&got)) {
      EXPECT_FALSE(why->empty());
    }
    if (const auto* place = std::get_if<BadPlace>(&got)) {
      EXPECT_FALSE(place->why.empty());
    }
    if (!std::holds_alternative<Command>(got)) continue;
    ++read;
    EXPECT_EQ(encode_command(std::get<Command>(got)), std::string(bytes.begin(), bytes.end()));
    for (const float x : std::get<Command>(got).values) EXPECT_TRUE(std::isfinite(x));
  }
  EXPECT_GT(read, 1000u) << "the other half of the test never ran";
}

// A tool led by hand gathers speed, keeps within it, and stops where it is told without going past.
TEST(LivePath, GoesThereWithinItsSpeed) {
  constexpr double kSpeed = 0.02, kRamp = 0.004, kFrameS = 0.001;
  LivePath way(kSpeed, kRamp, {});
  way.set_target({0.0, 0.0, -0.01});
  Vec3d before = way.at(0.0);
  double fastest = 0.0, deepest = 0.0;
  for (int i = 0; i < 1000; ++i) {
    way.plan(i * kFrameS, kFrameS);
    const Vec3d at = way.at((i + 1) * kFrameS);
    fastest = std::max(fastest, norm(at - before) / kFrameS);
    deepest = std::max(deepest, -at.z);
    before = at;
  }
  EXPECT_NEAR(before.z, -0.01, 1e-12);
  EXPECT_LE(deepest, 0.01 + 1e-12);
  EXPECT_NEAR(fastest, kSpeed, 1e-9);
}

// The force of a tool pushed by hand is that of the scene's own press to the same depth.
//
// Both come to rest at the same depth in an elastic, damped body, so they end in the same equilibrium; 1 % is far above
// what 2 s of damping at 20/s leave of the motion, exp(−20), and far below any other depth's force.
TEST(LiveEngine, PushByHandGivesTheScenesForce) {
  std::string text = test::small_scene();
  text.insert(text.find("depth_mm = 1"), "hold_s = 1\n");
  const Variant variant = variant_of(text);
  struct Last : RunObserver {
    void on_sample(const Sample& sample) override { last = sample; }
    Sample last;
  } run;
  run_variant(variant, no_files(), run, std::atomic<bool>{false});
  const double expected = -run.last.instruments.front().force.z;
  ASSERT_GT(std::abs(expected), 0.01);

  Engine engine(variant, no_files());
  engine.start();
  Watcher watcher(engine);
  ASSERT_TRUE(engine.post(place(0.001f, 5)));
  ASSERT_TRUE(watcher.until([&] { return watcher.last.time > 1.0 && watcher.last.echo == 5; }));
  EXPECT_NEAR(watcher.last.tools.front().depth, 0.001, 1e-8);
  EXPECT_NEAR(-watcher.last.tools.front().force.z, expected, 0.01 * std::abs(expected));
  EXPECT_NEAR(watcher.samples.back().force[0], expected, 0.01 * std::abs(expected));
  engine.stop();
}

// A palpation is played: the finger goes where the scene's run takes it, found on the same body, and meets it at each point.
TEST(LiveEngine, PlaysAPalpation) {
  const Variant variant = variant_of(R"([mesh]
kind = "box"
cells = [4, 4, 2]
size_m = [0.04, 0.04, 0.02]
[tissue]
youngs_modulus_Pa = 3600
poisson_ratio = 0.4
[motion]
damping_rate_per_s = 20
[[fixed]]
set = "z_min"
[[instrument]]
kind = "ball"
name = "finger"
tip_m = [0.02, 0.02, 0.03]
direction = [0, 0, -1]
radius_mm = 8
[instrument.motion]
kind = "palpation"
columns = 2
rows = 1
spacing_mm = 16
indentation_mm = 3
velocity_mm_s = 100
)");
  LiveBody body(variant, no_files());
  ASSERT_TRUE(body.tools().front().can_play);
  const std::shared_ptr<ToolDriver> scene = make_driver(variant.instruments.front(), body.built().simulation.mesh());
  LivePath& way = body.way(0);
  way.play();
  double deepest = 0.0;
  for (double t = 0.0; t < *scene->end(); t += kFrame) {
    way.plan(t, kFrame);
    const Vec3d expected = scene->advance(t + kFrame, 0.0, {}).position - scene->start().position;
    ASSERT_LT(norm(way.at(t + kFrame) - expected), 1e-9) << t;
    deepest = std::max(deepest, -expected.z);
    while (body.built().simulation.time() < t + kFrame) ASSERT_TRUE(body.built().simulation.step().made());
  }
  EXPECT_NEAR(deepest, 0.010 + 0.003, 1e-6) << "from 10 mm above the surface to 3 mm below it [m]";
  way.plan(*scene->end() + kFrame, kFrame);
  EXPECT_FALSE(way.playing()) << "it has ended";

  Engine engine(variant, no_files());
  engine.start();
  Watcher watcher(engine);
  engine.post({.kind = CommandKind::play, .sequence = 1});
  ASSERT_TRUE(watcher.until([&] { return watcher.last.echo == 1 && watcher.last.time > *scene->end(); }));
  engine.stop();
  const auto pressed =
      std::max_element(watcher.samples.begin(), watcher.samples.end(),
                       [](const ForceSample& a, const ForceSample& b) { return a.force[0] < b.force[0]; });
  EXPECT_GT(pressed->force[0], 0.05f) << "the finger meets the block [N]";
}

// Pause holds the clock, a step moves it by a frame, reset takes it back, and a tissue made stiffer under the tool answers
// more strongly, without a return to rest.
TEST(LiveEngine, ObeysPauseStepResetAndParameters) {
  Variant variant = variant_of(test::small_scene());
  variant.simulation.step = 1e-4;  // several to a frame, and below h* of the stiffer tissue
  Engine engine(variant, no_files());
  engine.start();
  Watcher watcher(engine);
  engine.post({.kind = CommandKind::pause, .sequence = 1, .index = 1});
  ASSERT_TRUE(watcher.until([&] { return watcher.last.paused; }));
  const double held = watcher.last.time;
  engine.post({.kind = CommandKind::step, .sequence = 2});
  ASSERT_TRUE(watcher.until([&] { return watcher.last.echo == 2 && watcher.last.time > held; }));
  EXPECT_NEAR(watcher.last.time, held + kFrame, 0.6 * kFrame);  // to within half a step

  engine.post({.kind = CommandKind::pause, .sequence = 3, .index = 0});
  engine.post(place(0.001f, 4));
  ASSERT_TRUE(watcher.until([&] { return watcher.last.time > 0.6 && watcher.last.echo == 4; }));
  const double soft = -watcher.last.tools.front().force.z;
  engine.post({.kind = CommandKind::parameter, .sequence = 5, .index = 0, .values = {7200.0f, 0.0f, 0.0f}});
  const double then = watcher.last.time;
  ASSERT_TRUE(watcher.until([&] { return watcher.last.echo == 5 && watcher.last.time > then + 0.6; }));
  EXPECT_EQ(watcher.last.epoch, 0u);
  EXPECT_NEAR(watcher.last.tools.front().depth, 0.001, 1e-8) << "the tool stays where it is";
  // Twice E, the same depth: twice the force of a linear tissue at rest; 2 % for what still swings.
  EXPECT_NEAR(-watcher.last.tools.front().force.z / soft, 2.0, 0.04);

  engine.post({.kind = CommandKind::reset, .sequence = 6});
  ASSERT_TRUE(watcher.until([&] { return watcher.last.epoch == 1 && watcher.last.time > 0.01; }));
  EXPECT_NEAR(watcher.last.tools.front().depth, 0.0, 1e-12);
  EXPECT_EQ(watcher.last.parameters.front(), 7200.0) << "a reset keeps what was set";
  engine.stop();
}

// Many resets at once are one: the next one undoes the one before, and the engine is not to be held by them.
TEST(LiveEngine, ManyResetsAreOne) {
  Engine engine(variant_of(test::small_scene()), no_files());
  for (std::uint32_t i = 1; i <= 900; ++i) engine.post({.kind = CommandKind::reset, .sequence = i});
  engine.start();
  Watcher watcher(engine);
  ASSERT_TRUE(watcher.until([&] { return watcher.last.echo == 900; }));
  EXPECT_EQ(watcher.last.epoch, 1u);
  engine.stop();
}

// What a hand pulls follows it, with the force that its spring tells; let go, the body comes back.
TEST(LiveEngine, GrabPullsTheSurfaceAndLetsGo) {
  Engine engine(variant_of(test::small_scene()), no_files());
  ASSERT_TRUE(engine.can_grab());
  engine.start();
  Watcher watcher(engine);
  ASSERT_TRUE(watcher.until([&] { return watcher.last.shape != nullptr; }));
  const std::vector<Vec3d>& rest = watcher.last.shape->mesh.vertices;
  std::uint32_t vertex = 0;  // in the middle of a side: free to move
  for (std::uint32_t v = 0; v < rest.size(); ++v) {
    if (norm(rest[v] - Vec3d{0.02, 0.01, 0.01}) < 1e-9) vertex = v;
  }
  const Vec3d to = rest[vertex] + Vec3d{0.004, 0.0, 0.0};
  engine.post({.kind = CommandKind::grab,
               .sequence = 1,
               .index = vertex,
               .values = {static_cast<float>(to.x), static_cast<float>(to.y), static_cast<float>(to.z)}});
  ASSERT_TRUE(watcher.until([&] { return watcher.last.grabbing && watcher.last.time > 0.5; }));
  const double drawn = watcher.last.displacement[vertex].x;
  EXPECT_GT(drawn, 0.0005);
  EXPECT_LT(drawn, 0.004) << "the spring gives";
  EXPECT_GT(watcher.last.grab_force.x, 0.0);
  engine.post({.kind = CommandKind::let_go, .sequence = 2});
  const double then = watcher.last.time;
  ASSERT_TRUE(watcher.until([&] { return !watcher.last.grabbing && watcher.last.time > then + 1.0; }));
  EXPECT_LT(std::abs(watcher.last.displacement[vertex].x), 0.05 * drawn);
  engine.stop();
}

// A patch that is bonded to the hand goes exactly where the hand goes, at the hand's bounded speed, on either side of a
// vertex; its force is what holds the body there: more than that of a spring, which gives.
TEST(LiveEngine, ABondedPatchGoesWhereTheHandGoes) {
  const std::atomic<bool> stop{false};
  const Vec3d way{0.003, -0.001, 0.0};
  const auto drawn = [&](GrabSpring::Hold how) {
    auto body = std::make_unique<LiveBody>(variant_of(test::small_scene()), no_files());
    const Simulation& simulation = body->built().simulation;
    std::vector<std::uint32_t> patch;  // across the middle of a side, free to move
    for (std::uint32_t v = 0; v < simulation.mesh().vertices.size(); ++v) {
      const Vec3d& x = simulation.mesh().vertices[v];
      if (std::abs(x.x - 0.02) < 1e-9 && std::abs(x.z - 0.01) < 1e-9) patch.push_back(v);
    }
    EXPECT_GT(patch.size(), 2u);
    body->grab()->hold(patch, simulation.displacement(), simulation.masses(), 50.0, how);
    double fastest = 0.0;
    for (int frame = 1; frame <= 500; ++frame) {
      body->grab()->draw(way * std::min(1.0, frame / 10.0), kFrame);
      app::advance_to(body->built(), OnInversion::go_on, frame * kFrame, stop);
      fastest = std::max(fastest, norm(simulation.velocity()[patch.front()]));
    }
    if (how == GrabSpring::Hold::bonded) {
      for (const std::uint32_t v : patch) EXPECT_NEAR(norm(simulation.displacement()[v] - way), 0.0, 1e-12) << v;
      const double even = norm(way) / 0.01;  // the way of ten frames; the last step of a frame may be shorter
      EXPECT_LE(fastest, even * (1.0 + 1e-9)) << "no blow";
      EXPECT_GE(fastest, 0.5 * even);
    }
    return body->grab()->force();
  };
  const Vec3d bonded = drawn(GrabSpring::Hold::bonded), sprung = drawn(GrabSpring::Hold::springs);
  EXPECT_GT(bonded.x, sprung.x);
  EXPECT_LT(bonded.y, sprung.y);
  EXPECT_LT(bonded.y, 0.0);
}

// A parameter that cannot be is told, and the body there is goes on.
TEST(LiveEngine, KeepsTheBodyWhereAnotherCannotBe) {
  Variant variant = variant_of(test::small_scene());
  const BuiltVariant soft(variant, no_files());
  variant.simulation.step =
      0.9 * soft.simulation.stable_step();  // too long where ν = 0.49: λ + 2 μ is eight times as large
  Engine engine(variant, no_files());
  engine.start();
  Watcher watcher(engine);
  engine.post({.kind = CommandKind::parameter, .sequence = 1, .index = 1, .values = {0.49f, 0.0f, 0.0f}});
  ASSERT_TRUE(watcher.until([&] { return !watcher.last.notice.empty(); }));
  EXPECT_EQ(watcher.last.epoch, 0u);
  const double then = watcher.last.time;
  EXPECT_TRUE(watcher.until([&] { return watcher.last.time > then + 0.01; }));
  engine.stop();
}

}  // namespace
}  // namespace glisson::view
