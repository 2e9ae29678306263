// Heat in random bodies: no temperature beyond those that were given, a balance exact to rounding, and nothing that is not finite.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "glisson/heat/heat_simulation.h"
#include "support/bodies.h"

namespace glisson {
namespace {

ThermalTissue random_tissue(std::mt19937& random) {
  const auto of = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  ThermalTissue t;
  t.conductivity = of(0.1, 1.0), t.frozen_conductivity = of(0.5, 3.0);
  t.specific_heat = of(1000.0, 4000.0), t.frozen_specific_heat = of(1000.0, 2500.0);
  t.latent_heat = of(0.0, 1.0) < 0.2 ? 0.0 : of(5e4, 3.3e5);
  t.freezing_begins = of(-2.0, 2.0), t.freezing_ends = t.freezing_begins - of(0.02, 10.0);
  t.perfusion = of(0.0, 1.0) < 0.5 ? 0.0 : of(0.0, 0.05), t.blood_temperature = of(30.0, 40.0);
  return t;
}

/// Any temperature at each vertex within bounds, at time 0.
void set_random(HeatSimulation& s, const std::map<int, ThermalTissue>& tissues, double low, double high,
                std::mt19937& random) {
  HeatState state = s.state();
  for (double& t : state.temperature) t = std::uniform_real_distribution<double>(low, high)(random);
  std::fill(state.heat.begin(), state.heat.end(), 0.0);
  for (std::size_t k = 0; k < s.mesh().tets.size(); ++k) {
    const ThermalTissue& tissue = tissues.at(s.mesh().region_of(k));
    for (const std::uint32_t v : s.mesh().tets[k])
      state.heat[v] += six_rest_volume(s.mesh(), k) / 24.0 * thermal_state(tissue, state.temperature[v]).heat;
  }
  s.load_state(std::move(state));
}

class RandomHeat : public ::testing::TestWithParam<int> {};

// Boxes with moved vertices, whose tets are obtuse, of three tissues; faces held, or in air, at any temperatures; a probe; from one temperature
// or from another at each vertex; steps of any length. Without the limiter half of these tests fail.
TEST_P(RandomHeat, StaysBetweenWhatWasGiven) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    std::mt19937 random(static_cast<unsigned>(1000 * GetParam()) + seed);
    const auto of = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
    TetMesh mesh = test::jittered_box({4, 3, 3}, of(0.002, 0.01), 0.25, random);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) mesh.regions.push_back(static_cast<int>(random() % 3));
    std::map<int, ThermalTissue> tissues;
    for (int r = 0; r < 3; ++r) tissues[r] = random_tissue(random);
    HeatOptions o{.temperature = of(-40.0, 45.0), .step = of(0.0, 1.0) < 0.5 ? 0.0 : std::pow(10.0, of(-2.0, 3.0))};
    double low = o.temperature, high = o.temperature;
    const auto seen = [&](double t) { low = std::min(low, t), high = std::max(high, t); };
    for (const auto& [region, t] : tissues) {
      if (t.perfusion > 0.0) seen(t.blood_temperature);
    }
    HeatSimulation s(mesh, tissues, o);
    const double wall = of(-196.0, 100.0), air = of(-100.0, 50.0), later = of(-196.0, 60.0);
    s.hold("x_min", [=](double time) { return time < 50.0 ? wall : later; });
    s.add_convection("z_max", of(1.0, 1000.0), [air](double) { return air; });
    for (const double t : {wall, later, air}) seen(t);
    if (of(0.0, 1.0) < 0.5) {
      const double probe = of(-160.0, 90.0), coefficient = of(0.1, 20.0);
      const Vec3d size = mesh.vertices.back();
      s.add_line_source({.from = size * 0.3,
                         .to = size * 0.6,
                         .temperature = [=](double) { return probe; },
                         .coefficient = [=](double) { return coefficient; }});
      seen(probe);
    }
    if (of(0.0, 1.0) < 0.5) {
      const double from = of(-100.0, 20.0), to = from + of(1.0, 80.0);
      set_random(s, tissues, from, to, random);
      seen(from), seen(to);
    }
    double through = 0.0;
    for (int k = 0; k < 12; ++k) {
      const HeatStep step = s.step();
      ASSERT_EQ(step.status, HeatStatus::ok) << seed << " step " << k << " of " << step.step << " s";
      for (const double t : s.temperature()) {
        ASSERT_GE(t, low - 1e-9) << seed << " step " << k;
        ASSERT_LE(t, high + 1e-9) << seed << " step " << k;
      }
      const HeatLedger l = s.ledger();
      through = std::max(through, std::abs(l.stored) + std::abs(l.held) + std::abs(l.surface) + std::abs(l.blood) +
                                      std::abs(l.sources));
      EXPECT_LE(std::abs(l.imbalance()), 1e-10 * through);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(First, RandomHeat, ::testing::Range(0, 3));
INSTANTIATE_TEST_SUITE_P(All, RandomHeat, ::testing::Range(3, 100));  // verify

}  // namespace
}  // namespace glisson
