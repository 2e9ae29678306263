// The coupling to a device of 1 kHz gives the hand no energy that the hand or the tissue did not put in, in every setting
// that it accepts; and one that it refuses does.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "glisson/archive.h"
#include "glisson/instruments/tool_motion.h"

namespace glisson {
namespace {

constexpr double kStep = 1e-4;    // of the tool [s]
constexpr int kDeviceSteps = 20;  // of the device, in each of the tool's

/// A device of a mass with a damper, held by a hand that pushes; it meets a wall of a spring through the tool. The device
/// moves in continuous time, its force is held for a period.
struct Bench {
  HandCoupling coupling;
  double wall = 1000.0;       // [N/m], from x = 0 downwards
  double device_mass = 0.05;  // [kg]
  HandDriver driver;
  double x = 0.005, v = 0.0;  // of the device [m, m/s]
  double from_hand = 0.0;     // work of the hand [J]
  double from_device = 0.0;   // what the port took in, exactly: −Σ F Δx [J]
  double lowest = 0.0;        // least of what the port took in beyond what it stores [J]
  double fastest = 0.0;
  double force = 0.0, answer = 0.0;

  Bench(const HandCoupling& c, double wall_stiffness, const HandCoupling& accepted)
      : coupling(c), wall(wall_stiffness), driver({{0, 0, 0.005}, identity<double>()}, accepted) {}
  explicit Bench(const HandCoupling& c, double wall_stiffness) : Bench(c, wall_stiffness, c) {}

  double wall_force(double y) const { return y < 0.0 ? -wall * y : 0.0; }

  /// One period under a force of the hand.
  void period(double hand) {
    driver.set_target({{0, 0, x}, identity<double>()});
    force = driver.device_force().z;
    const double before = x;
    const int steps = static_cast<int>(std::lround(coupling.period / kStep));
    for (int i = 0; i < steps; ++i) {
      answer = wall_force(driver.advance(0.0, kStep, {{0, 0, answer}, {}}).position.z);
      for (int k = 0; k < kDeviceSteps; ++k) {
        const double dt = kStep / kDeviceSteps;
        v = (device_mass * v + dt * (hand + force)) / (device_mass + dt * coupling.device_damping);
        x += dt * v;
        from_hand += hand * dt * v;
      }
    }
    from_device -= force * (x - before);
    fastest = std::max(fastest, std::abs(v));
  }
  /// Energy in the wall, the tool and the coupling, as a program outside would count it [J].
  double stored(double y) const {
    const double speed = driver.velocity().z, pressed = std::min(0.0, y);
    return 0.5 * wall * pressed * pressed + 0.5 * coupling.mass * speed * speed;
  }
};

HandCoupling coupling_of(double damping, double device_damping, double mass) {
  HandCoupling c{.stiffness = 1.0, .damping = damping, .mass = mass, .device_damping = device_damping};
  c.stiffness = largest_passive_stiffness(c);
  return c;
}

// With the tool held fast the bound is the one of a sampled wall, b ≥ kT/2; with a loose tool it is lower.
TEST(HandDriver, BoundIsThatOfASampledWall) {
  HandCoupling c{.stiffness = 1.0, .damping = 1e6, .mass = 0.02, .period = 0.001, .device_damping = 0.25};
  EXPECT_NEAR(largest_passive_stiffness(c), 2.0 * 0.25 / 0.001, 1e-3);
  c.damping = 1.0;
  const double k = largest_passive_stiffness(c), a = 0.5 * k * c.period;
  EXPECT_LT(k, 500.0);
  EXPECT_NEAR((c.device_damping - a) * c.damping, a * a, 1e-12) << "(b − kT/2) c = (kT/2)²";
}

// The port's own books: what a sampled device gives, −Σ F Δx, is known exactly from its samples, whatever it does between.
// For random pushes of the hand at the largest stiffness allowed, over dampings, masses, devices and walls from nothing to
// rigid: what came in and what the device's own damper takes is never less than nothing. Without the device's damper in the
// sum the observer goes below zero; that is the energy the held force makes.
TEST(HandDriver, PassivityObserverNeverFindsEnergyMade) {
  int watched = 0;
  for (const double damping : {0.2, 1.0, 5.0, 50.0}) {
    for (const double device_damping : {0.01, 0.1, 1.0}) {
      for (const double mass : {0.005, 0.05}) {
        for (const double wall : {0.0, 100.0, 5e3, 2e5}) {
          if (wall * kStep * kStep > mass) continue;  // stiffer than the tool's mass bears in a step, with any driver
          Bench bench(coupling_of(damping, device_damping, mass), wall);
          std::mt19937_64 random(static_cast<unsigned>(watched));
          std::uniform_real_distribution<double> push(-2.0, 1.6);
          double hand = 0.0, taken = 0.0, lowest = 0.0;
          for (int k = 0; k < 4000; ++k) {
            if (k % (1 + static_cast<int>(random() % 40)) == 0) hand = push(random);
            const double before = bench.x;
            bench.period(hand);
            const double moved = bench.x - before;
            taken += device_damping * moved * moved / bench.coupling.period;  // the least its damper takes
            lowest = std::min(lowest, bench.from_device + taken);
          }
          EXPECT_GE(lowest, -1e-9) << damping << " " << device_damping << " " << mass << " " << wall;
          ++watched;
        }
      }
    }
  }
  EXPECT_GT(watched, 80);
}

/// A device of a given damping leans on a stiff wall through a spring of `stiffness`: its largest speed in the twentieth second
/// over that in the first.
double swing_after(double stiffness, double device_damping) {
  HandCoupling c{.stiffness = stiffness, .damping = 5.0, .mass = 0.02, .device_damping = device_damping};
  HandCoupling told = c;
  told.device_damping = 10.0;  // so that any stiffness is accepted
  Bench bench(c, 2e4, told);
  bench.x = -0.01;
  double first = 0.0;
  for (int k = 0; k < 20000; ++k) {
    if (k == 19000) bench.fastest = 0.0;
    bench.period(-1.0);
    if (k == 1000) first = bench.fastest;
  }
  return bench.fastest / first;
}

// The bound is not an idle one. A device that leans on a wall comes to rest with half the largest stiffness (of its damper
// half is left, e^(−(b − kT/2) t/2m) = e^(−4.75) in 19 s, seen at the peaks), keeps within its swing at the largest, and swings up
// with one and a half times as much, until it leaves the wall.
TEST(HandDriver, BoundIsTight) {
  const double most = largest_passive_stiffness({.damping = 5.0, .device_damping = 0.05});
  EXPECT_LT(swing_after(0.5 * most, 0.05), 2.0 * std::exp(-4.75));
  EXPECT_LT(swing_after(most, 0.05), 1.0);
  EXPECT_GT(swing_after(1.5 * most, 0.05), 1.1);
}

// The spring is felt as what it is: in rest the device carries k (y − x), and the tool what the tissue pushes with.
TEST(HandDriver, FeelsTheWall) {
  const HandCoupling c;
  Bench bench(c, 400.0);
  for (int k = 0; k < 6000; ++k) bench.period(-0.5);
  EXPECT_NEAR(bench.force, 0.5, 1e-4);
  EXPECT_NEAR(bench.x, -0.5 / 400.0 - 0.5 / c.stiffness, 1e-6) << "two springs in a row";
}

// What is not passive is refused, with the largest stiffness that is.
TEST(HandDriver, RefusesWhatIsNotPassive) {
  HandCoupling c;
  c.stiffness = 1.01 * largest_passive_stiffness(c);
  try {
    HandDriver driver({}, c);
    FAIL() << "it was accepted";
  } catch (const std::invalid_argument& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("not passive"), std::string::npos) << text;
    EXPECT_NE(text.find("at most 449"), std::string::npos) << text;
  }
  c.stiffness *= 0.98;
  EXPECT_NO_THROW(HandDriver({}, c));
  c.device_damping = 0.0;
  EXPECT_THROW(HandDriver({}, c), std::invalid_argument)
      << "a sampled spring is unstable with a device without damping";
  EXPECT_THROW(HandDriver({}, {.stiffness = -1.0}), std::invalid_argument);
}

// A driver taken back to its past goes on to the same bits.
TEST(HandDriver, ContinuesFromItsPast) {
  HandDriver a({}), b({});
  a.set_target({{0.01, 0.002, -0.03}, identity<double>()});
  for (int i = 0; i < 100; ++i) a.advance(0, kStep, {{0.1, 0, 0}, {}});
  ASSERT_NO_THROW(restore(b, archived(a)));
  EXPECT_EQ(a.advance(0, kStep, {}).position, b.advance(0, kStep, {}).position);
  EXPECT_EQ(a.device_force(), b.device_force());
  EXPECT_THROW(restore(b, std::string(16, 0)), std::runtime_error);
}

}  // namespace
}  // namespace glisson
