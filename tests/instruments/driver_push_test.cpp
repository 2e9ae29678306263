// A pushed tool moves as its mass, its damper and what it meets say, and contact however stiff does not throw it back.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "glisson/archive.h"
#include "glisson/instruments/tool_motion.h"

namespace glisson::driver_push_test {
namespace {

constexpr double kStep = 1e-4;  // [s]

PushMotion push_of(double force) {
  PushMotion push;
  push.force = [force](double) { return force; };
  return push;
}

/// A driver against a spring and dashpot to ground that answer along z and know the pose of the last step, as the tissue.
struct Bench {
  PushDriver driver;
  double stiffness = 0.0, dashpot = 0.0, gap = 0.0;
  double time = 0.0, depth = 0.0, answer = 0.0;

  void step() {
    depth = -driver.advance(time, kStep, {{0, 0, answer}, {}}).position.z;
    const double pressed = std::max(0.0, depth - gap);
    answer = pressed > 0.0 ? std::max(0.0, stiffness * pressed - dashpot * driver.velocity().z) : 0.0;
    time += kStep;
  }
};

// In free space: x = (F/c)(t − (m/c)(1 − e^(−ct/m))). The scheme is of first order: 0.5 h c/m = 0.5 % of the transient.
TEST(PushDriver, FreeFlightAgainstADamper) {
  Bench bench{.driver = PushDriver({}, push_of(0.2))};
  const double m = 0.05, c = 5.0, f = 0.2;
  for (int i = 0; i < 1000; ++i) {
    bench.step();
    const double exact = f / c * (bench.time - m / c * (1.0 - std::exp(-c * bench.time / m)));
    EXPECT_NEAR(bench.depth, exact, f / c * kStep) << i;
  }
}

// Against a spring k: m ẍ + c ẋ + k x = F, the damped oscillation x = F/k (1 − e^(−δt)(cos ωt + δ/ω sin ωt)). First order
// in h: error below F/k ω h.
TEST(PushDriver, SwingsOnASpringAsTheFormulaSays) {
  const double m = 0.05, c = 1.0, k = 500.0, f = 1.0;
  PushMotion push = push_of(f);
  push.damping = c;
  Bench bench{.driver = PushDriver({}, push), .stiffness = k};
  const double decay = 0.5 * c / m, omega = std::sqrt(k / m - decay * decay);
  for (int i = 0; i < 12000; ++i) {
    bench.step();
    const double t = bench.time;
    const double exact =
        f / k * (1.0 - std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t)));
    EXPECT_NEAR(bench.depth, exact, f / k * omega * kStep) << i;
  }
  EXPECT_NEAR(bench.depth, f / k, 1e-4 * f / k);
}

// Springs up to 10⁹ N/m, a thousand times what the mass alone would bear (4 m/h² = 2·10⁷ at 50 g, 4·10⁵ at 1 g), with and
// without a dashpot and a gap to hit: the tool comes to rest where F = k x, and never presses with more than a bound:
// the impact of a mass at speed v on a spring gives v √(k m), on a contact stiffer than the step can see m v/h.
TEST(PushDriver, StiffContactIsStable) {
  for (const double mass : {0.001, 0.05}) {
    for (double k = 1e2; k < 2e9; k *= 10.0) {
      for (const double gap : {0.0, 0.002}) {
        PushMotion push = push_of(1.0);
        push.mass = mass;
        Bench bench{.driver = PushDriver({}, push), .stiffness = k, .dashpot = 0.5 * std::sqrt(k * mass), .gap = gap};
        bench.dashpot = std::min(bench.dashpot, 0.5 * mass / kStep);
        double deepest = 0.0;
        for (int i = 0; i < 40000; ++i) {
          bench.step();
          deepest = std::max(deepest, bench.depth - gap);
        }
        const double speed = 0.2;  // F/c, the most it reaches
        EXPECT_LE(deepest, 2.0 / k + speed * std::max(kStep, 2.0 * std::sqrt(mass / k))) << k << " " << gap;
        EXPECT_NEAR(bench.depth - gap, 1.0 / k, 0.02 / k + 1e-7) << k << " " << gap << " " << mass;
      }
    }
  }
}

// Tissue that is dragged along is a mass of its own that answers a step late. Half the tool's is borne as what it is; ten
// times the tool's, which would swing up without bound, slows the tool and no more.
TEST(PushDriver, BearsACompanion) {
  for (const double companion : {0.005, 0.1}) {
    PushMotion push = push_of(1.0);
    push.mass = 0.01;
    PushDriver driver({}, push);
    double answer = 0.0, before = 0.0, fastest = 0.0;
    for (int i = 0; i < 20000; ++i) {
      driver.advance(i * kStep, kStep, {{0, 0, answer}, {}});
      const double v = -driver.velocity().z;
      answer = companion * (v - before) / kStep;  // upwards, while the companion is sped up
      before = v;
      fastest = std::max(fastest, std::abs(v));
    }
    EXPECT_LE(fastest, 1.001 * 1.0 / 5.0) << "F/c";
    if (companion < push.mass) {
      EXPECT_NEAR(before, 0.2, 1e-3);
    }
  }
}

// On rails the tool keeps to its direction; free, it gives way sideways by f/c a second.
TEST(PushDriver, KeepsToItsRails) {
  PushMotion push = push_of(0.0);
  PushDriver rails({}, push);
  push.guided = false;
  PushDriver free({}, push);
  Pose on_rails, off;
  for (int i = 0; i < 10000; ++i) {
    on_rails = rails.advance(i * kStep, kStep, {{0.5, 0, 0}, {}});
    off = free.advance(i * kStep, kStep, {{0.5, 0, 0}, {}});
  }
  EXPECT_EQ(on_rails.position.x, 0.0);
  EXPECT_NEAR(off.position.x, 0.5 / 5.0 * (1.0 - 0.01), 1e-4);
}

// A stop holds the tool and takes its speed.
TEST(PushDriver, EndsAtItsStop) {
  PushMotion push = push_of(1.0);
  push.stop = 0.01;
  PushDriver driver({}, push);
  Pose pose;
  for (int i = 0; i < 5000; ++i) pose = driver.advance(i * kStep, kStep, {});
  EXPECT_NEAR(pose.position.z, -0.01, 1e-15);
  EXPECT_EQ(driver.velocity(), (Vec3d{}));
}

// A driver taken back to its past goes on to the same bits.
TEST(PushDriver, ContinuesFromItsPast) {
  Bench a{.driver = PushDriver({}, push_of(1.0)), .stiffness = 1e7};
  for (int i = 0; i < 777; ++i) a.step();
  PushDriver b({}, push_of(1.0));
  ASSERT_NO_THROW(restore(b, archived(a.driver)));
  const Wrench answer{{0, 0, a.answer}, {}};
  EXPECT_EQ(a.driver.advance(a.time, kStep, answer).position, b.advance(a.time, kStep, answer).position);
  EXPECT_THROW(restore(b, std::string(24, 0)), std::runtime_error);
}

// Options that make no tool are refused.
TEST(PushDriver, RefusesWhatIsNone) {
  EXPECT_THROW(PushDriver({}, {}), std::invalid_argument);
  PushMotion push = push_of(1.0);
  push.mass = 0.0;
  EXPECT_THROW(PushDriver({}, push), std::invalid_argument);
}

}  // namespace
}  // namespace glisson::driver_push_test
