// Heat of a current and of given patterns against closed forms: coaxial and spherical electrodes, σ that rises with temperature.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "ball.h"
#include "glisson/heat/heat_simulation.h"

namespace glisson {
namespace {

/// Of constant σ, at any temperature between 0 and 100 °C.
ThermalTissue conductor(double sigma) {
  ThermalTissue t;
  t.latent_heat = 0.0, t.freezing_begins = -50.0, t.freezing_ends = -51.0;
  t.electric_conductivity = sigma, t.electric_rise = 0.0;
  return t;
}

struct Current {
  double power = 0.0;    // over that of the closed form, less 1
  double density = 0.0;  // mean error of the heat of a vertex from twice the electrode's radius on, relative
};

/// @param power  of the closed form [W] @param density  of the closed form at a radius [W/m³]
template <class Density>
Current compare(HeatSimulation& s, double inner, double outer, double voltage, double power, const Density& density,
                double (*radius)(const Vec3d&)) {
  RadioFrequency radio;
  radio.voltage = [voltage](double) { return voltage; };
  std::vector<double> volume(s.mesh().vertices.size(), 0.0);
  for (std::uint32_t v = 0; v < volume.size(); ++v) {
    const double r = radius(s.mesh().vertices[v]);
    if (r <= inner * (1.0 + 1e-9)) radio.electrode.push_back(v);
    if (r >= outer * (1.0 - 1e-9)) radio.ground.push_back(v);
  }
  for (std::size_t t = 0; t < s.mesh().tets.size(); ++t) {
    for (const std::uint32_t v : s.mesh().tets[t]) volume[v] += six_rest_volume(s.mesh(), t) / 24.0;
  }
  s.add_radio(radio);
  const std::vector<double> before = s.state().heat;
  const double h = 1e-6;  // so short that nothing is conducted
  EXPECT_EQ(s.step().status, HeatStatus::ok);
  EXPECT_NEAR(s.ledger().sources, h * s.state().radio[0].power, 1e-12 * s.ledger().sources);
  double error = 0.0, whole = 0.0;
  for (std::size_t v = 0; v < before.size(); ++v) {
    const double r = radius(s.mesh().vertices[v]);
    if (r < 2.0 * inner || r > 0.9 * outer) continue;
    const double exact = h * volume[v] * density(r);
    error += std::abs(s.state().heat[v] - before[v] - exact), whole += exact;
  }
  return {s.state().radio[0].power / power - 1.0, error / whole};
}

// Between coaxial cylinders 2 π σ U²/ln(R/r) a metre of heat arises, σ U²/(ρ ln(R/r))² a cubic metre: of second order in the cells.
TEST(Radio, CoaxialElectrodes) {
  const double inner = 0.002, outer = 0.02, sigma = 0.3, height = 0.002, voltage = 25.0, c = std::log(outer / inner);
  const auto off = [&](int cells) {
    HeatSimulation s(cylinder_mesh({.radius = outer, .height = height, .radial_cells = cells, .axial_cells = 1}),
                     {{0, conductor(sigma)}}, {.step = 1e-6});
    return compare(
        s, inner, outer, voltage, 2.0 * std::numbers::pi * sigma * voltage * voltage * height / c,
        [&](double r) { return sigma * std::pow(voltage / (r * c), 2); },
        [](const Vec3d& x) { return std::hypot(x.x, x.y); });
  };
  const Current coarse = off(20), fine = off(40), finer = off(80);
  RecordProperty("power", std::to_string(1e6 * coarse.power) + ", " + std::to_string(1e6 * fine.power) + ", " +
                              std::to_string(1e6 * finer.power) + " millionths");
  RecordProperty("density_percent", std::to_string(100.0 * coarse.density) + ", " +
                                        std::to_string(100.0 * fine.density) + ", " +
                                        std::to_string(100.0 * finer.density));
  EXPECT_GT(coarse.power / fine.power, 3.5);
  EXPECT_GT(fine.power / finer.power, 3.5);
  EXPECT_LT(std::abs(finer.power), 1e-4);
  EXPECT_GT(fine.density / finer.density, 1.8) << "of first order, as slopes are";
  EXPECT_LT(finer.density, 0.015);
}

// Between concentric spheres 4 π σ U² r R/(R − r) arises, σ (U r R/(R − r))²/ρ⁴ a cubic metre.
TEST(Radio, SphericalElectrodes) {
  const double inner = 0.005, outer = 0.02, sigma = 0.3, voltage = 20.0, c = voltage * inner * outer / (outer - inner);
  const auto off = [&](int splits) {
    HeatSimulation s(test::ball_mesh(outer, splits), {{0, conductor(sigma)}}, {.step = 1e-6});
    return compare(
        s, inner, outer, voltage, 4.0 * std::numbers::pi * sigma * c * c * (1.0 / inner - 1.0 / outer),
        [&](double r) { return sigma * c * c / std::pow(r, 4); }, [](const Vec3d& x) { return norm(x); });
  };
  const Current coarse = off(2), fine = off(3), finer = off(4);
  RecordProperty("power_percent", std::to_string(100.0 * coarse.power) + ", " + std::to_string(100.0 * fine.power) +
                                      ", " + std::to_string(100.0 * finer.power));
  RecordProperty("density_percent", std::to_string(100.0 * coarse.density) + ", " +
                                        std::to_string(100.0 * fine.density) + ", " +
                                        std::to_string(100.0 * finer.density));
  EXPECT_GT(coarse.power / fine.power, 3.0);
  EXPECT_LT(std::abs(finer.power), 1e-3);
  EXPECT_GT(fine.density / finer.density, 2.0);
  EXPECT_LT(finer.density, 0.05);
}

// A bar between two plates whose ends are held at T₀ and which is insulated elsewhere, σ = σ₀ (1 + a (T − 37)): in the steady state
//   ∫ k/σ dT from T₀ to the warmest = U²/8                                                         [Kohlrausch1900]
// whatever the bar's shape. Here the warmest is 39 K above the ends; without the rise of σ it would be 26 K.
TEST(Radio, WarmestOfABarWhoseConductivityRises) {
  ThermalTissue t = conductor(0.3);
  t.electric_rise = 0.02;
  const double voltage = 18.5, ends = 37.0;
  const double exact =
      std::expm1(voltage * voltage / 8.0 * t.electric_conductivity * t.electric_rise / t.conductivity) /
      t.electric_rise;
  const auto warmest = [&](int cells) {
    HeatSimulation s(box_mesh({.cells = {cells, 1, 1}, .size = {0.02, 0.002, 0.002}}), {{0, t}}, {.step = 400.0});
    for (const char* set : {"x_min", "x_max"}) s.hold(set, [=](double) { return ends; });
    s.add_radio({s.mesh().vertex_set("x_min"), s.mesh().vertex_set("x_max"), [=](double) { return voltage; }, {}});
    EXPECT_EQ(s.advance_to(40000.0).status, HeatStatus::ok);
    return *std::max_element(s.temperature().begin(), s.temperature().end()) - ends;
  };
  const double coarse = warmest(8), fine = warmest(16);
  RecordProperty("warmest_K",
                 std::to_string(coarse) + ", " + std::to_string(fine) + ", exact " + std::to_string(exact));
  EXPECT_NEAR((coarse - exact) / (fine - exact), 4.0, 0.3);
  EXPECT_NEAR((4.0 * fine - coarse) / 3.0, exact, 1e-3 * exact);
}

// σ (1 + a (T − 37)), none of it in ice, dry above 105 °C.
TEST(Radio, ConductivityOverTemperature) {
  ThermalTissue t;
  t.electric_conductivity = 0.4;
  EXPECT_DOUBLE_EQ(electric_conductivity(t, 37.0), 0.4);
  EXPECT_NEAR(electric_conductivity(t, 87.0), 0.8, 1e-12);
  EXPECT_NEAR(electric_conductivity(t, 120.0), 0.4 * 2.26 * 0.01, 1e-12);
  EXPECT_NEAR(electric_conductivity(t, -30.0), 0.4e-4, 1e-12);
  EXPECT_EQ(electric_conductivity(ThermalTissue{}, 37.0), 0.0);
}

// A given power is met to rounding while resistance falls with warmth, is off when its table says so, and goes on from saved bytes with the
// same bytes, on two threads as on one.
TEST(Radio, PowerOverTimeAndStates) {
  ThermalTissue t = conductor(0.3);
  t.electric_rise = 0.02;
  const auto make = [&](int threads) {
    HeatSimulation s(box_mesh({.cells = {12, 12, 12}, .size = {0.03, 0.03, 0.03}}), {{0, t}}, {.threads = threads});
    s.add_radio({needle_vertices(s.mesh(), {0.015, 0.015, 0.01}, {0.015, 0.015, 0.02}, 0.001),
                 s.mesh().vertex_set("x_min"),
                 {},
                 {[](double time) { return time <= 20.0 ? 8.0 : 0.0; }, CornerTimes({20.0})}});
    return s;
  };
  HeatSimulation s = make(1), on_two = make(2);
  ASSERT_EQ(s.step().status, HeatStatus::ok);
  const double cold = s.state().radio[0].resistance;
  ASSERT_EQ(s.advance_to(10.0).status, HeatStatus::ok);
  std::stringstream bytes;
  s.save(bytes);
  ASSERT_EQ(s.advance_to(20.0).status, HeatStatus::ok);
  EXPECT_LT(s.state().radio[0].resistance, 0.95 * cold);
  EXPECT_NEAR(s.ledger().sources, 160.0, 1e-9);
  ASSERT_EQ(s.advance_to(30.0).status, HeatStatus::ok);
  EXPECT_NEAR(s.ledger().sources, 160.0, 1e-9);
  HeatSimulation other = make(1);
  other.load(bytes);
  ASSERT_EQ(other.advance_to(20.0).status, HeatStatus::ok);
  ASSERT_EQ(other.advance_to(30.0).status, HeatStatus::ok);
  EXPECT_TRUE(std::equal(s.temperature().begin(), s.temperature().end(), other.temperature().begin()));
  ASSERT_EQ(on_two.step().status, HeatStatus::ok);
  for (const double time : {10.0, 20.0, 30.0}) ASSERT_EQ(on_two.advance_to(time).status, HeatStatus::ok);
  EXPECT_TRUE(std::equal(s.temperature().begin(), s.temperature().end(), on_two.temperature().begin()));
}

// A pattern of power: each tet gets its own, times what the table says; the ledger has all of it.
TEST(Radio, GivenPatternOfPower) {
  HeatSimulation s(box_mesh({.cells = {4, 4, 4}, .size = {0.02, 0.02, 0.02}}), {{0, ThermalTissue{}}});
  std::vector<double> pattern;
  double whole = 0.0;
  for (std::size_t t = 0; t < s.mesh().tets.size(); ++t) {
    pattern.push_back(1e5 * static_cast<double>(t % 7));
    whole += pattern.back() * six_rest_volume(s.mesh(), t) / 6.0;
  }
  s.add_source(pattern, {[](double time) { return time <= 5.0 ? 2.0 : 0.0; }, CornerTimes({5.0})});
  ASSERT_EQ(s.advance_to(10.0).status, HeatStatus::ok);
  EXPECT_NEAR(s.ledger().sources, 10.0 * whole, 1e-9 * whole);
  pattern.pop_back();
  EXPECT_THROW(s.add_source(pattern, [](double) { return 1.0; }), std::invalid_argument);
}

TEST(Radio, IsRefusedByName) {
  HeatSimulation s(box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}}), {{0, ThermalTissue{}}});
  const auto some = [](double) { return 10.0; };
  const auto low = s.mesh().vertex_set("x_min"), high = s.mesh().vertex_set("x_max");
  EXPECT_THROW(s.add_radio({low, high, {}, {}}), std::invalid_argument);
  EXPECT_THROW(s.add_radio({low, high, some, some}), std::invalid_argument);
  EXPECT_THROW(s.add_radio({low, low, some, {}}), std::invalid_argument);
  EXPECT_THROW(s.add_radio({low, {}, some, {}}), std::invalid_argument);
  EXPECT_THROW(needle_vertices(s.mesh(), {0.0, 0.0, 0.03}, {0.0, 0.0, 0.05}, 0.001), std::invalid_argument);
  s.add_radio({low, high, {}, some});
  EXPECT_THROW(s.step(), std::invalid_argument) << "tissue without an electric conductivity";
}

}  // namespace
}  // namespace glisson
