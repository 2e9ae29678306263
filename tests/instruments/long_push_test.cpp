// Tools that a force moves, in long steps: where they end and the force there are found together. The tool's own equation of motion,
// the explicit scheme's depths, closed forms, checkpoints.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "instruments/contact_scenes.h"
#include "instruments/needle_scenes.h"

namespace glisson::long_push_test {
namespace {

Tissue tissue() {
  Tissue t;
  t.youngs_modulus = 5000.0, t.poisson_ratio = 0.3;
  return t;
}

PushMotion push_of(double force, double ramp, double mass = 0.05, double damping = 5.0) {
  PushMotion push;
  push.force = [=](double t) { return force * std::clamp(t / ramp, 0.0, 1.0); };
  push.mass = mass, push.damping = damping;
  return push;
}

/// A slab of 4 × 4 × 2 cm whose bottom is held, its top at z = 0, under a tool that is pushed.
struct Pushed {
  Simulation body;
  std::shared_ptr<PushDriver> driver;
  std::shared_ptr<ContactTool> tool;
  ConstraintId bottom;

  Pushed(Integrator integrator, double h, const ContactOptions& c, const PushMotion& push, double viscosity = 0.0,
         unsigned threads = 1)
      : body(box_mesh({.cells = {12, 12, 6}, .size = {0.04, 0.04, 0.02}, .origin = {-0.02, -0.02, -0.02}}),
             {{0, viscous(viscosity)}}, options(integrator, h, threads)),
        driver(std::make_shared<PushDriver>(Pose{{0.001, 0.002, 0.0005}}, push)),
        tool(std::make_shared<ContactTool>(c, driver)), bottom(body.fix("z_min")) {
    body.attach(tool);
  }
  static Tissue viscous(double viscosity) {
    Tissue t = tissue();
    t.viscosity = viscosity;
    return t;
  }
  static SimulationOptions options(Integrator integrator, double h, unsigned threads) {
    SimulationOptions o = test::in_steps_of(integrator, h);
    o.damping_rate = 50.0, o.threads = threads;
    if (integrator == Integrator::semi_implicit) o.step = h;
    return o;
  }
};

ContactOptions ball_of(double friction = 0.0) {
  ContactOptions c;
  c.shape = Ball{0.01}, c.friction = friction;
  return c;
}

class LongPush : public testing::TestWithParam<Integrator> {};

// In every step (m + h c) v⁺ = m v + h (F + f) with F and f at its end, to 2e-4 of F; at rest the tissue bears F, the support takes it,
// the ledger closes, and the depth is the explicit scheme's within 0.6 % (3.54 mm).
TEST_P(LongPush, MovesByTheForceAtTheEndOfTheStep) {  // long
  const double h = 0.01, m = 0.05, c = 5.0, most = 0.2;
  Pushed explicitly(Integrator::central_difference, 0.0, ball_of(), push_of(most, 0.2));
  test::advance_to(explicitly.body, 1.0);
  Pushed p(GetParam(), h, ball_of(), push_of(most, 0.2));
  double v = 0.0, z = p.tool->pose().position.z;
  while (p.body.time() < 1.0 - 1e-9) {
    const StepResult r = p.body.step();
    ASSERT_TRUE(r.made()) << r.message;
    const double now = p.tool->pose().position.z, speed = (now - z) / h,
                 force = -most * std::min(1.0, p.body.time() / 0.2) - p.tool->forces().total().z;
    EXPECT_NEAR((m + h * c) * speed - m * v, h * force, 2e-4 * h * most) << p.body.time();
    z = now, v = speed;
  }
  EXPECT_NEAR(p.tool->forces().total().z, -most, 1e-4 * most);
  EXPECT_NEAR(p.body.force(p.bottom).total().z, most, 1e-3 * most);
  EXPECT_NEAR(p.tool->depth(), explicitly.tool->depth(), 0.006 * explicitly.tool->depth());
  const Energies e = p.body.energies();
  EXPECT_GT(e.work_tools, 1e-4);
  EXPECT_NEAR(e.imbalance(), 0.0, 1e-6 * e.work_tools);
}

INSTANTIATE_TEST_SUITE_P(Integrators, LongPush, testing::Values(Integrator::implicit, Integrator::quasi_static),
                         [](const auto& tested) { return std::string(word_of(tested.param)); });

// A ball that rubs, pushed aslant and free to go aside, against the explicit scheme in short steps: depth within 2 % of the largest in steps of
// 5 ms at all times, 0.6 % at the end.
TEST(LongPush, GoesAsideAsTheExplicitScheme) {  // long
  PushMotion push = push_of(0.2, 0.2);
  push.direction = {1.0, 0.0, -3.0}, push.guided = false;
  Pushed explicitly(Integrator::central_difference, test::kShortStep, ball_of(0.3), push),
      p(Integrator::implicit, 0.005, ball_of(0.3), push);
  double worst = 0.0;
  for (int k = 1; k <= 100; ++k) {
    ASSERT_TRUE(p.body.step().made());
    test::advance_to(explicitly.body, p.body.time() - 1e-9);
    worst = std::max(worst, norm(p.tool->pose().position - explicitly.tool->pose().position));
  }
  const Vec3d start{0.001, 0.002, 0.0005}, end = explicitly.tool->pose().position;
  EXPECT_GT(end.x - start.x, 0.001);
  EXPECT_LT(worst, 0.02 * norm(end - start));
  EXPECT_LT(norm(p.tool->pose().position - end), 0.006 * norm(end - start));
}

// In viscous tissue under `semi_implicit`, in steps of 0.5 ms: the explicit scheme's depth within 2 %; the same bytes on two threads, and
// from a checkpoint.
TEST(LongPush, ActsInViscousTissueUnderSemiImplicit) {  // long
  const auto pushed = [](Integrator integrator, unsigned threads = 1) {
    return Pushed(integrator, 5e-4, ball_of(), push_of(0.2, 0.05), 100.0, threads);
  };
  Pushed explicitly = pushed(Integrator::central_difference), a = pushed(Integrator::semi_implicit),
         two = pushed(Integrator::semi_implicit, 2), loaded = pushed(Integrator::semi_implicit);
  for (int k = 0; k < 100; ++k) ASSERT_TRUE(a.body.step().made() && two.body.step().made());
  std::stringstream file;
  a.body.save(file);
  loaded.body.load(file);
  for (int k = 0; k < 50; ++k) ASSERT_TRUE(a.body.step().made() && two.body.step().made() && loaded.body.step().made());
  test::advance_to(explicitly.body, a.body.time());
  EXPECT_GT(explicitly.tool->depth(), 1e-3);
  EXPECT_NEAR(a.tool->depth(), explicitly.tool->depth(), 0.02 * explicitly.tool->depth());
  EXPECT_EQ(a.body.state_hash(), two.body.state_hash());
  EXPECT_EQ(a.body.state_hash(), loaded.body.state_hash());
  EXPECT_EQ(a.tool->pose().position, loaded.tool->pose().position);
}

// A run that was saved goes on with the same bytes, also where the search has learnt.
TEST(LongPush, ContinuesFromACheckpoint) {
  for (const Integrator integrator : {Integrator::implicit, Integrator::quasi_static}) {
    Pushed a(integrator, 0.02, ball_of(), push_of(0.2, 0.2)), b(integrator, 0.02, ball_of(), push_of(0.2, 0.2));
    for (int k = 0; k < 7; ++k) ASSERT_TRUE(a.body.step().made());
    std::stringstream file;
    a.body.save(file);
    b.body.load(file);
    for (int k = 0; k < 5; ++k) ASSERT_TRUE(a.body.step().made() && b.body.step().made());
    EXPECT_EQ(a.body.state_hash(), b.body.state_hash()) << word_of(integrator);
    EXPECT_EQ(a.tool->pose().position, b.tool->pose().position);
  }
}

// A hand's spring: at rest its force and the tissue's are one, and tool and target are apart by it.
TEST(LongPush, AHandPressesWithItsSpring) {
  Simulation s(box_mesh({.cells = {8, 8, 4}, .size = {0.04, 0.04, 0.02}, .origin = {-0.02, -0.02, -0.02}}),
               {{0, tissue()}}, test::in_steps_of(Integrator::implicit, 0.01));
  s.fix("z_min");
  const auto hand = std::make_shared<HandDriver>(Pose{{0.0, 0.0, 0.0005}});
  const auto tool = std::make_shared<ContactTool>(ball_of(), hand);
  s.attach(tool);
  for (int k = 0; k < 100; ++k) {
    hand->set_target({{0.0, 0.0, 0.0005 - 0.004 * std::min(1.0, k / 30.0)}});
    ASSERT_TRUE(s.step().made());
  }
  const double pressed = tool->forces().total().z;
  EXPECT_LT(pressed, -0.05);
  EXPECT_NEAR(hand->device_force().z, -pressed, 1e-4 * -pressed);
  EXPECT_NEAR((tool->pose().position.z + 0.0035) * 300.0, -pressed, 1e-4 * -pressed);
}

test::Insertion pushed_needle(Integrator integrator, double h, double force) {
  test::Insertion o;
  o.options = test::in_steps_of(integrator, h);
  o.options.damping_rate = 100.0;
  o.push = push_of(force, 0.5);
  o.push->stop = 0.015;
  return o;
}

// A needle whose surface breaks at 0.3 N: pushed with less it does not go in, and lies as deep as under the explicit scheme (0.5 %); with
// more it does, at the same time within 5 ms, and ends at its stop.
TEST(LongPush, ANeedleGoesInByEnoughForce) {  // long
  for (const Integrator integrator : {Integrator::implicit, Integrator::quasi_static}) {
    test::Inserted weak = test::insert(pushed_needle(integrator, 0.01, 0.25)),
                   strong = test::insert(pushed_needle(integrator, 0.01, 0.6)),
                   weak_explicit = test::insert(pushed_needle(Integrator::central_difference, 0.0, 0.25)),
                   strong_explicit = test::insert(pushed_needle(Integrator::central_difference, 0.0, 0.6));
    for (test::Inserted* x : {&weak, &strong, &weak_explicit, &strong_explicit}) test::run_to(*x, 1.0);
    EXPECT_EQ(test::event(*weak.needle, "puncture"), nullptr);
    EXPECT_NEAR(test::pushed(*weak.needle), 0.25, 1e-3);
    EXPECT_NEAR(weak.needle->depth(), weak_explicit.needle->depth(), 0.005 * weak_explicit.needle->depth());
    const InstrumentEvent *in = test::event(*strong.needle, "puncture"),
                          *reference = test::event(*strong_explicit.needle, "puncture");
    ASSERT_TRUE(in != nullptr && reference != nullptr);
    EXPECT_NEAR(in->time, reference->time, 0.005) << word_of(integrator);
    EXPECT_NEAR(in->depth, reference->depth, 1e-4) << word_of(integrator);
    EXPECT_NEAR(strong.needle->depth(), 0.015, 1e-6);
    EXPECT_NEAR(strong_explicit.needle->depth(), 0.015, 1e-6);
  }
}

}  // namespace
}  // namespace glisson::long_push_test
