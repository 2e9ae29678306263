// Whatever is done to a live body, and in whatever order, its numbers stay finite and its picture within ten body sizes: a piece
// that was cut free and thrown flies on for ever where nothing damps it, and is drawn at the rim.
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>
#include <thread>

#include "app/program.h"
#include "view/engine/engine.h"
#include "view/engine/live_body.h"
#include "view/protocol/messages.h"
#include "view/state/surface.h"

namespace glisson::view {
namespace {

// A cube of 4 cm without damping, led at two vertices in the middle of its top.
constexpr const char* kCube = R"(title = "a cube"
[mesh]
kind = "box"
cells = [3, 3, 3]
size_m = [0.04, 0.04, 0.04]
[sets.press]
vertices = [58, 59]
[tissue]
youngs_modulus_Pa = 3600
poisson_ratio = 0.4
viscosity_Pa_s = 1
[[fixed]]
set = "z_min"
[[tool]]
set = "press"
direction = [0, 0, -1]
velocity_mm_s = 20
depth_mm = 8
)";

/// A live body and its newest state, turned by hand.
struct Storm {
  Storm() : engine(parse_scene(kCube, "cube.toml", ".").variants.front(), {}) {}
  void act(CommandKind kind, std::uint32_t index = 0, std::array<float, 6> values = {}) {
    engine.post({.kind = kind, .sequence = ++sequence, .index = index, .values = values});
  }
  /// Turns until that holds of the newest state, a minute at most: pieces of a cut wait for the clock.
  bool until(const std::function<bool()>& holds) {
    for (int i = 0; i < 60000; ++i) {
      turn();
      if (last.shape && holds()) return true;
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
    return false;
  }
  void turn() {
    engine.turn();
    if (const Snapshot* state = engine.latest()) last = *state;
  }
  /// A blade through all of the cube at a height.
  void sever(float z) {
    for (int i = 0; i <= 4; ++i) {
      const float x = -0.01f + 0.015f * static_cast<float>(i);
      act(CommandKind::cut, i == 0 ? 1 : 0, {x, -0.01f, z, x, 0.05f, z});
    }
  }
  /// The largest component of a displacement in the frame that a page would get [m].
  double reach() const {
    const Surface surface(last.shape);
    const std::string frame = frame_message(last, surface, 1);
    float value = 0.0f;
    std::memcpy(&value, frame.data() + 52, 4);
    return static_cast<double>(value);
  }
  double farthest() const {
    double most = 0.0;
    for (const Vec3d& u : last.displacement) most = std::max(most, norm(u));
    return most;
  }
  double rim() const { return 10.0 * diagonal(last.shape->mesh); }

  Engine engine;
  Snapshot last;
  std::uint32_t sequence = 0;
};

// A vertex 10.8 m away on a body of 4 cm is drawn at the rim, in its direction, and the page is told; what is near is drawn where
// it is.
TEST(ViewStorm, APieceThatIsFarAwayIsDrawnAtTheRim) {
  Storm storm;
  ASSERT_TRUE(storm.until([] { return true; }));
  const Surface surface(storm.last.shape);
  const std::uint32_t thrown = surface.mesh_vertex(0);
  storm.last.displacement[thrown] = {0.01, 0.0, 0.0};
  EXPECT_FALSE(surface.strays(storm.last));
  EXPECT_NEAR(storm.reach(), 0.01, 1e-8);
  storm.last.displacement[thrown] = {0.0, -10.8, 0.0};
  EXPECT_TRUE(surface.strays(storm.last));
  EXPECT_NEAR(storm.reach(), storm.rim(), 1e-6 * storm.rim());
}

// Any acts in any order, at the ends of their ranges as often as within.
TEST(ViewStorm, NumbersStayFiniteAndThePictureBounded) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937 random(seed);
    const auto between = [&](double a, double b) {
      return static_cast<float>(std::uniform_real_distribution<double>(a, b)(random));
    };
    const auto place = [&] { return between(-0.05, 0.1); };
    Storm storm;
    for (int turn = 0; turn < 1200; ++turn) {
      storm.turn();
      if (!storm.last.shape || turn % 4 != 0) continue;
      const auto drawn = 1 + random() % 14;
      const auto kind = drawn == 14 ? CommandKind::undo : static_cast<CommandKind>(drawn);
      const auto vertices = static_cast<std::uint32_t>(storm.last.shape->mesh.vertices.size());
      if (kind == CommandKind::cut) {
        if (random() % 8 == 0) storm.sever(between(0.005, 0.035));
        continue;
      }
      if ((kind == CommandKind::reset || kind == CommandKind::play) && random() % 16 != 0) continue;
      const auto& parameters = storm.engine.parameters();
      const auto index =
          static_cast<std::uint32_t>(random() % (kind == CommandKind::parameter ? parameters.size() : vertices));
      std::array<float, 6> values{place(), place(), place()};
      if (kind == CommandKind::speed) values[0] = std::pow(10.0f, between(-3.0, 1.0));
      if (kind == CommandKind::parameter)
        values[0] = static_cast<float>(random() % 2 == 0 ? parameters[index].least : parameters[index].most);
      storm.act(kind, kind == CommandKind::pause ? (random() % 8 == 0 ? 1 : 0) : index, values);
      for (const Vec3d& u : storm.last.displacement) ASSERT_TRUE(std::isfinite(norm(u))) << "seed " << seed;
      ASSERT_LE(storm.reach(), storm.rim() * (1.0 + 1e-6)) << "seed " << seed << ", turn " << turn;
    }
  }
}

}  // namespace
}  // namespace glisson::view
