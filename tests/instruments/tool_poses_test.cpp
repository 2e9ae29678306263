// Poses that make no sense, from a device, a driver or a path, never reach a tool: where a program sets one it is refused, in a step
// it is counted and the last good one stays, so that no tool vanishes and the hand's force stays finite.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "glisson/instruments/blade.h"
#include "glisson/instruments/needle.h"
#include "instruments/contact_scenes.h"
#include "support/integrators.h"
#include "support/must_step.h"

namespace glisson::tool_poses {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
constexpr double kTop = 0.02;   ///< of the slab [m]
constexpr double kReach = 0.6;  ///< ten of its diagonals, 0.06 m [m]
constexpr Pose kAbove{{0.02, 0.02, 0.0201}, identity<double>()};

/// Ways to make no sense.
std::vector<std::pair<const char*, Pose>> bad_poses() {
  Pose stretched = kAbove, mirrored = kAbove, turned = kAbove;
  stretched.axes(1, 1) = 1.01, mirrored.axes(2, 2) = -1.0, turned.axes(0, 1) = kNan;
  return {{"nan", {{0.02, kNan, kTop}, identity<double>()}},
          {"inf", {{-kInf, 0.02, kTop}, identity<double>()}},
          {"huge", {{0.02, 0.02, 1e300}, identity<double>()}},
          {"far", {{0.02, 0.02, 0.01 + 1.001 * kReach}, identity<double>()}},
          {"stretched", stretched},
          {"mirrored", mirrored},
          {"nan axes", turned}};
}

/// A slab of 4 × 4 × 2 cm, held at its bottom; its diagonal is 6 cm.
Simulation slab(Integrator integrator) {
  const TetMesh mesh = box_mesh({.cells = {4, 4, 2}, .size = {0.04, 0.04, kTop}});
  SimulationOptions options = test::in_steps_of(integrator, 1e-3);
  options.damping_rate = 20.0;
  Tissue tissue;
  tissue.youngs_modulus = 5000.0, tissue.viscosity = 1.0;
  Simulation s(mesh, {{0, tissue}}, options);
  s.fix("z_min");
  return s;
}

struct Kind {
  const char* name;
  std::shared_ptr<Instrument> (*make)(std::shared_ptr<ToolDriver>);
};
std::shared_ptr<Instrument> make_ball(std::shared_ptr<ToolDriver> driver) {
  return std::make_shared<ContactTool>(ContactOptions{.shape = Ball{0.008}, .friction = 0.3}, std::move(driver));
}
std::shared_ptr<Instrument> make_needle(std::shared_ptr<ToolDriver> driver) {
  NeedleOptions o;
  o.zone = 8e-3, o.spacing = 2e-3, o.rupture.force = 0.02, o.tip.cutting = 0.02;
  return std::make_shared<Needle>(o, std::move(driver));
}
std::shared_ptr<Instrument> make_blade(std::shared_ptr<ToolDriver> driver) {
  BladeOptions o;
  o.edge_from = {0.0, -0.01, 0.0}, o.edge_to = {0.0, 0.01, 0.0}, o.toughness = 20.0;
  return std::make_shared<Blade>(o, std::move(driver));
}
constexpr Kind kKinds[] = {{"ball", make_ball}, {"needle", make_needle}, {"blade", make_blade}};

constexpr double kPressed = 0.02, kBad = 0.025, kGood = 0.03, kEnd = 0.035;  ///< times [s]

/// Down 4 mm in 20 ms, and at rest from there; between kBad and kGood what is given, if anything; then up at 20 mm/s.
struct Press final : ToolDriver {
  std::optional<Pose> bad;
  std::uint64_t given = 0;
  explicit Press(std::optional<Pose> pose) : bad(std::move(pose)) {}
  Pose start() const override { return kAbove; }
  Pose advance(double time, double h, const Wrench&) override {
    const double t = time + h;
    if (bad && t > kBad && t < kGood) {
      ++given;
      return *bad;
    }
    Pose pose = kAbove;
    pose.position.z += -0.2 * std::min(t, kPressed) + 0.02 * std::max(0.0, t - kGood);
    return pose;
  }
};

struct Outcome {
  std::uint64_t hash, rejected, given;
  Vec3d force_in_between, position;
  bool operator==(const Outcome&) const = default;
};

Outcome press(Integrator integrator, const Kind& kind, std::optional<Pose> bad) {
  Simulation s = slab(integrator);
  const auto driver = std::make_shared<Press>(std::move(bad));
  const auto tool = kind.make(driver);
  s.attach(tool);
  Outcome out{};
  while (s.time() < kEnd - 1e-9) {
    test::must_step(s);
    if (s.time() < 0.5 * (kBad + kGood)) out.force_in_between = tool->force();
  }
  return {s.state_hash(), tool->rejected(), driver->given, out.force_in_between, tool->pose().position};
}

class ToolPoses : public testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(Every, ToolPoses, testing::ValuesIn(test::every_integrator()),
                         [](const auto& each) { return std::string(word_of(each.param)); });

// Every instrument under every integrator: while its driver gives poses that make no sense, the tool stays where it is and presses on;
// what comes of it has the bytes of a run in which the driver gave that place. Each such pose is counted.
TEST_P(ToolPoses, TheLastGoodOneStays) {
  for (const Kind& kind : kKinds) {
    const Outcome expected = press(GetParam(), kind, {});
    EXPECT_EQ(expected.rejected, 0U);
    EXPECT_GT(norm(expected.force_in_between), 1e-4) << kind.name;
    for (const auto& [name, pose] : bad_poses()) {
      Outcome out = press(GetParam(), kind, pose);
      EXPECT_GT(out.given, 0U);
      EXPECT_EQ(out.rejected, out.given) << kind.name << ", " << name;
      out.rejected = out.given = 0;
      EXPECT_EQ(out, expected) << kind.name << ", " << name;
    }
  }
}

// A path that leaves ten diagonals of the body takes its tool no farther.
TEST_P(ToolPoses, APathEndsTenDiagonalsAway) {
  Simulation s = slab(GetParam());
  const auto driver =
      std::make_shared<PathDriver>(kAbove, steady_path({.direction = {0.0, 0.0, 1.0}, .velocity = 1e3}));
  const auto tool = make_ball(driver);
  s.attach(tool);
  while (s.time() < 2e-3) test::must_step(s);
  EXPECT_GT(tool->rejected(), 0U);
  EXPECT_LE(norm(tool->pose().position - Vec3d{0.02, 0.02, 0.01}), kReach);
}

// A push whose force is no number for a while holds its tool where it is; after it the tool comes to rest where the tissue
// carries the push, as if nothing had been: 0.05 N to 1 %, which is what an oscillation of 20/s damping leaves after 0.3 s.
TEST_P(ToolPoses, APushWithoutANumberWaits) {
  Simulation s = slab(GetParam());
  PushMotion push;
  push.force = [](double t) { return t > 0.05 && t < 0.06 ? kNan : 0.05 * std::min(1.0, t / 0.04); };
  const auto driver = std::make_shared<PushDriver>(kAbove, push);
  const auto tool = make_ball(driver);
  s.attach(tool);
  double standing = 0.0;
  while (s.time() < 0.4) {
    test::must_step(s);
    ASSERT_TRUE(std::isfinite(norm(tool->force())) && std::isfinite(norm(tool->pose().position)));
    if (s.time() < 0.052) standing = tool->pose().position.z;
    if (s.time() > 0.053 && s.time() < 0.059) {
      EXPECT_NEAR(tool->pose().position.z, standing, 1e-4);
    }
  }
  EXPECT_GT(tool->rejected(), 0U);
  EXPECT_NEAR(-tool->force().z, 0.05, 5e-4);
}

// A start that makes no sense is refused by the instrument or when it is attached, with the way out; nothing has changed then.
TEST_P(ToolPoses, AStartThatMakesNoSenseIsRefused) {
  for (const Kind& kind : kKinds) {
    for (const auto& [name, pose] : bad_poses()) {
      Simulation s = slab(GetParam());
      const auto attach = [&, at = pose] { s.attach(kind.make(test::standing(at))); };
      EXPECT_THROW(attach(), std::invalid_argument) << kind.name << ", " << name;
      test::must_step(s);
    }
  }
}

std::string refusal(HandDriver& hand, const Pose& target) {
  try {
    hand.set_target(target);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

/// A hand that holds a ball on the slab.
struct Held {
  Simulation body;
  std::shared_ptr<HandDriver> hand;
  std::shared_ptr<Instrument> ball;

  explicit Held(Integrator integrator, const HandCoupling& coupling = {})
      : body(slab(integrator)), hand(std::make_shared<HandDriver>(kAbove, coupling)), ball(make_ball(hand)) {
    body.attach(ball);
  }
  void period() {
    const double until = body.time() + 1e-3;
    while (body.time() + 0.5 * body.step_size() < until) test::must_step(body);
  }
};

Pose at_height(double z) { return {{0.02, 0.02, z}, identity<double>()}; }

// A target that makes no sense is refused where it is set, with its value and the allowed range, and not taken where it is offered:
// the last good one stays, the force on the device is its force, and the tool follows later targets.
TEST_P(ToolPoses, AHandKeepsItsLastGoodTarget) {
  Held a(GetParam()), b(GetParam());
  std::uint64_t bad = 0;
  for (int k = 0; k < 40; ++k) {
    const Pose good = at_height(kAbove.position.z - 1e-4 * std::min(k, 20));
    a.hand->set_target(good), b.hand->set_target(good);
    for (const auto& [name, pose] : bad_poses()) {
      const std::string told = refusal(*a.hand, pose);
      EXPECT_TRUE(told.starts_with("set_target: its ")) << name << ": " << told;
      EXPECT_EQ(told.find("0 to 0.6 m, ten diagonals") != std::string::npos, std::string_view(name) == "far") << told;
      EXPECT_FALSE(a.hand->offer_target(pose)) << name;
      EXPECT_EQ(a.ball->rejected(), ++bad);
    }
    EXPECT_EQ(a.hand->device_force(), b.hand->device_force());
    a.period(), b.period();
  }
  EXPECT_EQ(a.body.state_hash(), b.body.state_hash());
  EXPECT_EQ(a.hand->rejected(), bad);
  EXPECT_LT(a.ball->force().z, -1e-3);
  EXPECT_TRUE(a.hand->offer_target(at_height(kTop)));
}

// A device may be told to be slower than a bound: a target farther from the last good one than that in the periods since is refused, so
// that a hand that went on through an outage is found again.
TEST(ToolPosesSpeed, IsBoundedWhereOneSaysSo) {
  HandDriver bounded(kAbove, {.most_speed = 0.5}), free(kAbove);
  const double z = kAbove.position.z;
  EXPECT_TRUE(bounded.offer_target(at_height(z - 0.49e-3)));
  const Vec3d force = bounded.device_force();
  const std::string why = refusal(bounded, at_height(z - 1.0e-3));
  EXPECT_NE(why.find("0.51 m/s from the last good target, where the allowed range is 0 to most_speed = 0.5 m/s"),
            std::string::npos)
      << why;
  EXPECT_FALSE(bounded.offer_target(at_height(z - 1.5e-3)));  // 1.01 mm in two periods
  EXPECT_EQ(bounded.rejected(), 1U);
  EXPECT_EQ(bounded.device_force(), force);
  EXPECT_TRUE(bounded.offer_target(at_height(z - 1.9e-3)));  // 1.41 mm in three
  EXPECT_FALSE(bounded.offer_target(at_height(z - 2.5e-3)));
  EXPECT_TRUE(free.offer_target(at_height(z - 0.1)));
  EXPECT_THROW(HandDriver(kAbove, {.most_speed = 0.0}), std::invalid_argument);
  EXPECT_THROW(HandDriver(kAbove, {.most_speed = kNan}), std::invalid_argument);
  EXPECT_THROW(HandDriver({{kNan, 0.0, 0.0}, identity<double>()}), std::invalid_argument);
}

// Whatever a device sends, a thousand poses with every kind of rubbish among them: the force on the hand is finite and no larger
// than the spring is where the device may be, and the tool presses again on good targets.
TEST_P(ToolPoses, TheForceOnTheHandIsAlwaysFinite) {
  Held held(GetParam());
  std::mt19937 random(20261129);
  std::uniform_real_distribution<double> any(-2.0, 2.0);
  const double rubbish[] = {kNan, kInf, -kInf, 1e300, -1e30, std::numeric_limits<double>::denorm_min(), 0.0, 1e6};
  for (int k = 0; k < 1000; ++k) {
    Pose pose = at_height(kAbove.position.z + 2e-3 * any(random));
    for (int wrong = static_cast<int>(random() % 4); wrong > 0; --wrong) {
      const double x = random() % 2 == 0 ? rubbish[random() % std::size(rubbish)] : any(random);
      const std::size_t where = random() % 12;
      where < 3 ? pose.position[where] = x : pose.axes.m[(where - 3) / 3][where % 3] = x;
    }
    held.hand->offer_target(pose);
    const double force = norm(held.hand->device_force());
    ASSERT_TRUE(std::isfinite(force) && force <= 2.0 * kReach * HandCoupling{}.stiffness) << force;
    if (k % 25 == 0) held.period();
  }
  EXPECT_GT(held.ball->rejected(), 500U);
  for (int k = 0; k < 100; ++k) held.hand->set_target(at_height(kTop - 2e-3)), held.period();
  EXPECT_LT(held.ball->force().z, -1e-2);
}

}  // namespace
}  // namespace glisson::tool_poses
