// Tools that are pushed, or led by a hand through a device, meet a body as they meet a spring: what is pushed comes to rest
// where the tissue carries the push, and the hand gets no energy that it did not give.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "glisson/instruments/contact.h"
#include "glisson/instruments/tool_motion.h"
#include "glisson/simulation/simulation.h"
#include "support/must_step.h"

namespace glisson {
namespace {

constexpr Pose kAbove{{0.02, 0.02, 0.0205}, identity<double>()};

/// A slab held at its bottom, and a ball half a millimetre above its middle.
struct Slab {
  TetMesh mesh = box_mesh({.cells = {8, 8, 4}, .size = {0.04, 0.04, 0.02}});
  Simulation body;
  std::shared_ptr<ContactTool> ball;

  explicit Slab(std::shared_ptr<ToolDriver> driver) : body(mesh, {{0, tissue()}}, options()) {
    body.fix(mesh.vertex_sets.at("z_min"));
    ball = std::make_shared<ContactTool>(ContactOptions{.shape = Ball{0.008}, .friction = 0.3}, std::move(driver));
    body.attach(ball);
  }
  static Tissue tissue() {
    Tissue t;
    t.youngs_modulus = 5000;
    t.poisson_ratio = 0.4;
    return t;
  }
  static SimulationOptions options() {
    SimulationOptions o;
    o.damping_rate = 40;
    o.precision = Precision::double_precision;
    return o;
  }
  void until(double time) {
    while (body.time() < time) ASSERT_EQ(body.step().status, StepStatus::ok);
  }
};

// A push of 0.3 N comes to rest where the tissue carries it, to a thousandth, for a hand of 50 g and for one of a gram.
TEST(DriverInTissue, PushIsCarried) {
  double depths[2];
  for (int i = 0; i < 2; ++i) {
    PushMotion push;
    push.force = [](double t) { return 0.3 * std::min(1.0, t / 0.2); };
    push.mass = i == 0 ? 0.05 : 0.001;
    Slab slab(std::make_shared<PushDriver>(kAbove, push));
    slab.until(1.5);
    EXPECT_NEAR(-slab.ball->forces().total().z, 0.3, 3e-4);
    EXPECT_GT(slab.ball->depth(), 1e-3);
    depths[i] = slab.ball->depth();
  }
  EXPECT_NEAR(depths[0], depths[1], 1e-3 * depths[0]) << "where it rests does not depend on the mass";
}

/// A device of 1 kHz with a mass and a damper, under a hand that pushes, holds the ball.
struct Device {
  HandCoupling coupling;
  std::shared_ptr<HandDriver> driver;
  Slab slab;
  double z = kAbove.position.z, v = 0.0;
  double taken = 0.0, lowest = 0.0;  ///< by the port and the device's damper, at least [J]
  double force = 0.0;

  explicit Device(const HandCoupling& c) : coupling(c), driver(std::make_shared<HandDriver>(kAbove, c)), slab(driver) {}

  void period(double hand) {
    driver->set_target({{kAbove.position.x, kAbove.position.y, z}, identity<double>()});
    force = driver->device_force().z;
    const double before = z, until = slab.body.time() + coupling.period;
    while (slab.body.time() + 0.5 * slab.body.step_size() < until) test::must_step(slab.body);
    constexpr int kSteps = 200;
    for (int k = 0; k < kSteps; ++k) {
      const double dt = coupling.period / kSteps;
      v = (0.05 * v + dt * (hand + force)) / (0.05 + dt * coupling.device_damping);
      z += dt * v;
    }
    const double moved = z - before;
    taken += -force * moved + coupling.device_damping * moved * moved / coupling.period;
    lowest = std::min(lowest, taken);
  }
};

// A hand that presses and lets go, twice, through the stiffest coupling that is allowed: at no time have port and device's
// damper given more than they took, and a steady push is felt as what it is.
TEST(DriverInTissue, HandGetsNoEnergyThatItDidNotGive) {
  HandCoupling coupling;
  coupling.stiffness = largest_passive_stiffness(coupling);
  Device device(coupling);
  for (int k = 0; k < 3000; ++k) device.period(k % 1000 < 600 ? -0.4 : 0.1);
  EXPECT_GE(device.lowest, -1e-9);
  EXPECT_GT(device.taken, 1e-5) << "the hand did press";
  for (int k = 0; k < 1500; ++k) device.period(-0.4);
  EXPECT_NEAR(device.force, 0.4, 0.004);
  EXPECT_NEAR(-device.slab.ball->forces().total().z, 0.4, 0.004);
}

// A run that goes on from a checkpoint, driver and all, has the bytes of the run that went through.
TEST(DriverInTissue, ContinuesFromACheckpoint) {
  PushMotion push;
  push.force = [](double t) { return 0.3 * std::min(1.0, t / 0.05); };
  Slab through(std::make_shared<PushDriver>(kAbove, push));
  through.until(0.1);
  std::stringstream file;
  through.body.save(file);
  through.until(0.2);
  Slab on(std::make_shared<PushDriver>(kAbove, push));
  on.body.load(file);
  on.until(0.2);
  EXPECT_EQ(through.body.state_hash(), on.body.state_hash());
  EXPECT_EQ(through.ball->depth(), on.ball->depth());
}

}  // namespace
}  // namespace glisson
