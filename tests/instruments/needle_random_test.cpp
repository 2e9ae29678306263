// A thousand random punctures and withdrawals on random bodies: nothing is lost, nothing is infinite, and the bytes do not
// depend on the number of threads.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "needle_scenes.h"

namespace glisson {
namespace {

using test::insert;
using test::Inserted;
using test::Insertion;

class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double between(double a, double b) { return a + (b - a) * static_cast<double>(engine_() % 1000001) * 1e-6; }
  bool toss() { return engine_() % 2 == 0; }
  int whole(int a, int b) { return a + static_cast<int>(engine_() % static_cast<unsigned>(b - a + 1)); }

 private:
  std::mt19937 engine_;
};

Insertion random_insertion(unsigned seed) {
  Dice d(seed);
  Insertion o;
  o.mesh = {.radius = d.between(0.01, 0.03),
            .height = d.between(0.01, 0.03),
            .radial_cells = d.whole(2, 4),
            .axial_cells = d.whole(2, 5),
            .grading = d.between(1.0, 4.0)};
  o.youngs_modulus = d.between(1e3, 2e4);
  if (d.toss()) o.maxwell = {{.share = d.between(0.1, 0.8), .time = d.between(0.01, 1.0)}};
  NeedleOptions& n = o.needle;
  n.diameter = d.between(0.3e-3, 2.5e-3);
  n.zone = d.between(1e-3, 6e-3);
  n.spacing = d.between(0.5e-3, 4e-3);
  n.direction = {d.between(-0.4, 0.4), d.between(-0.4, 0.4), -1.0};
  if (d.toss())
    n.rupture = {.force = d.between(0.01, 1.0), .toughness = {}, .membrane_thickness = 1e-4};
  else if (d.toss())
    n.rupture = {.force = {}, .toughness = d.between(1.0, 3000.0), .membrane_thickness = 1e-4};
  else
    n.rupture = {};
  n.tip.cutting = d.between(0.0, 0.3);
  if (d.toss()) {
    o.inner_boundary = d.between(0.2, 0.8) * o.mesh.height;
    n.regions[1] = {.cutting = d.between(0.0, 0.4), .puncture = d.toss() ? d.between(0.0, 0.6) : 0.0};
  }
  const double dynamic = d.between(0.0, 20.0);
  n.friction = {.static_in = dynamic * d.between(1.0, 2.0),
                .static_out = dynamic * d.between(1.0, 2.0),
                .dynamic_in = dynamic,
                .dynamic_out = dynamic,
                .viscous_in = d.between(0.0, 300.0),
                .viscous_out = d.between(0.0, 300.0),
                .stick_speed = 1e-4};
  if (d.toss()) {
    n.youngs_modulus = 200e9;
    n.bevel_share = d.between(0.0, 0.5);
  }
  o.start = {d.between(-0.5, 0.5) * o.mesh.radius, d.between(-0.5, 0.5) * o.mesh.radius,
             o.mesh.height + d.between(1e-4, 1e-3)};
  o.strokes.clear();
  const int strokes = d.whole(1, 4);
  for (int k = 0; k < strokes; ++k) {
    const double down = d.between(-1.2, 0.1) * o.mesh.height, aside = d.between(-2e-3, 2e-3);
    o.strokes.push_back({.to = {aside, -aside, down},
                         .velocity = d.between(0.02, 0.5),
                         .ramp = d.between(0.0, 0.01),
                         .rest = d.between(0.0, 0.02)});
  }
  o.options.damping_rate = d.between(0.0, 50.0);
  o.options.precision = d.whole(0, 7) == 0 ? Precision::double_precision : Precision::single_precision;
  if (d.toss()) {
    n.drawn_membranes = MembraneProcess{.spacing = d.between(5e-4, 5e-3),
                                        .puncture = d.between(0.01, 0.6),
                                        .spread = d.between(0.0, 1.0),
                                        .seed = seed};
  }
  return o;
}

double mass_of(const Simulation& s) { return std::accumulate(s.masses().begin(), s.masses().end(), 0.0); }

/// Runs to the end; what must hold on the way and after it.
std::uint64_t survive(const Insertion& o, unsigned seed) {
  Inserted run = insert(o);
  const double mass = mass_of(run.simulation);
  const auto sets = run.simulation.mesh().vertex_sets;
  while (run.simulation.time() < run.end) {
    const StepStatus status = run.simulation.step().status;
    if (status != StepStatus::ok && status != StepStatus::inverted) {
      ADD_FAILURE() << "seed " << seed << ": status " << static_cast<int>(status) << " at " << run.simulation.time();
      break;
    }
  }
  EXPECT_TRUE(std::isfinite(norm(run.needle->forces().total()))) << seed;
  for (const Vec3d& u : run.simulation.displacement()) EXPECT_TRUE(std::isfinite(norm(u))) << seed;
  EXPECT_EQ(mass_of(run.simulation), mass) << seed;
  EXPECT_EQ(run.simulation.mesh().vertex_sets, sets) << seed;
  return run.simulation.state_hash();
}

class ThousandPunctures : public ::testing::TestWithParam<unsigned> {};

TEST_P(ThousandPunctures, Survive) {  // verify: 1*, 2, 3, 4, 5, 6, 7, 8, 9
  for (unsigned k = 0; k < 50; ++k) {
    const unsigned seed = 50 * GetParam() + k;
    Insertion o = random_insertion(seed);
    o.options.threads = 1;
    const std::uint64_t one = survive(o, seed);
    if (k % 5 != 0) continue;
    o.options.threads = 2;
    EXPECT_EQ(survive(o, seed), one) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ThousandPunctures, ::testing::Range(0U, 20U));

}  // namespace
}  // namespace glisson
