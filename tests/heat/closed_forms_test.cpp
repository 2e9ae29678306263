// Heat in tetrahedra against closed forms: freezing fronts of Neumann and of a line sink, blood in a slab, a cooling ball.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "glisson/heat/heat_simulation.h"

namespace glisson {
namespace {

constexpr double kPi = std::numbers::pi;

/// Freezes at −1 °C, within 0.05 K; no blood, no metabolism. A range of 7 K moves fronts by 3 to 5 %, 0.2 K by 0.15 %.
ThermalTissue sharp() {
  ThermalTissue t;
  t.freezing_begins = -1.0, t.freezing_ends = -1.05;
  return t;
}

/// λ of the front s = 2 λ √(α_s t) when half a space at 37 °C is brought to a temperature at its face [Neumann]; by bisection.
double neumann_root(double wall, const ThermalTissue& t) {
  const double ice = t.frozen_conductivity / (t.density * t.frozen_specific_heat),
               tissue = t.conductivity / (t.density * t.specific_heat), ratio = std::sqrt(ice / tissue);
  const double front = t.freezing_begins;
  const auto balance = [&](double l) {
    const double from_ice = t.frozen_conductivity * (front - wall) * std::exp(-l * l) / (std::sqrt(ice) * std::erf(l)),
                 from_tissue = t.conductivity * (37.0 - front) * std::exp(-l * l * ratio * ratio) /
                               (std::sqrt(tissue) * std::erfc(l * ratio));
    return (from_ice - from_tissue) / std::sqrt(kPi) - t.density * t.latent_heat * l * std::sqrt(ice);
  };
  double low = 1e-6, high = 3.0;
  for (int i = 0; i < 200; ++i) (balance(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
  return low;
}

/// Mean of a front over the square root of time, in which it is constant, from 300 to 600 s: while a row of vertices freezes the front
/// on a mesh stands still, so that one time alone says as much of the row as of the front.
template <class Front>
double mean_front(HeatSimulation& s, Front front) {
  EXPECT_EQ(s.advance_to(300.0).status, HeatStatus::ok);
  double sum = 0.0;
  constexpr int kTimes = 60;
  for (int k = 1; k <= kTimes; ++k) {
    EXPECT_EQ(s.advance_to(300.0 + 300.0 * k / kTimes).status, HeatStatus::ok);
    sum += front() / std::sqrt(s.time()) / kTimes;
  }
  return sum * std::sqrt(600.0);
}

// Half a space that freezes from its face: the roots are those computed elsewhere, the front is within 0.5 % (0.15 to 0.36 found), of an
// order of at least one in the width of the cells with the tolerance as it, and the balance of heat exact to rounding.
TEST(HeatClosedForms, NeumannFront) {
  const std::map<double, double> roots{{-40.0, 0.27226}, {-80.0, 0.38887}, {-140.0, 0.50541}, {-196.0, 0.58476}};
  for (const auto& [wall, known] : roots) {
    const ThermalTissue t = sharp();
    const double root = neumann_root(wall, t), ice = t.frozen_conductivity / (t.density * t.frozen_specific_heat);
    EXPECT_NEAR(root, known, 1e-5);
    const double exact = 2.0 * root * std::sqrt(ice * 600.0);
    double coarse = 1.0;
    for (const int cells : {40, 160}) {
      HeatSimulation s(box_mesh({.cells = {cells, 1, 1}, .size = {0.12, 0.12 / cells, 0.12 / cells}}), {{0, t}},
                       {.tolerance = 4.0 / cells});
      s.hold("x_min", [at = wall](double) { return at; });
      const double front = mean_front(s, [&] { return s.frozen_volume() / std::pow(0.12 / cells, 2); });
      const double error = front / exact - 1.0;
      RecordProperty("wall_" + std::to_string(static_cast<int>(wall)) + "_cells_" + std::to_string(cells) + "_percent",
                     std::to_string(100.0 * error));
      EXPECT_LT(std::abs(s.ledger().imbalance()), 1e-10 * std::abs(s.ledger().held));
      EXPECT_GE(coarse / error, cells > 40 ? 4.0 : -1e3) << wall;
      coarse = error;
    }
    EXPECT_LT(std::abs(coarse), 0.005) << wall;
  }
}

/// Radius of the front around a line that takes a power per length out of an infinite body at 37 °C [m]  [CarslawJaeger1959, §11.6]
double line_front(double power, double time, const ThermalTissue& t) {
  const double ice = t.frozen_conductivity / (t.density * t.frozen_specific_heat),
               tissue = t.conductivity / (t.density * t.specific_heat);
  const auto balance = [&](double l) {
    const double x = l * l * ice / tissue;
    return power / (4.0 * kPi) * std::exp(-l * l) +
           t.conductivity * (37.0 - t.freezing_begins) * std::exp(-x) / std::expint(-x) -
           l * l * ice * t.density * t.latent_heat;
  };
  double low = 1e-4, high = 3.0;
  for (int i = 0; i < 200; ++i) (balance(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
  return 2.0 * low * std::sqrt(ice * time);
}

// A line that takes heat out of an infinite body: within 1 %.
TEST(HeatClosedForms, LineSinkFront) {  // verify
  const std::map<double, double> known{{200.0, 6.81e-3}, {500.0, 12.793e-3}, {1000.0, 18.762e-3}};
  const double height = 2e-3;
  for (const auto& [power, radius] : known) {
    const double exact = line_front(power, 600.0, sharp());
    EXPECT_NEAR(exact, radius, 1e-5);
    HeatSimulation s(
        cylinder_mesh(
            {.radius = exact + 0.036, .height = height, .radial_cells = 32, .axial_cells = 1, .grading = 6.0}),
        {{0, sharp()}}, {.tolerance = 0.1});
    s.add_line_source({{0, 0, 0}, {0, 0, height}, [p = power](double) { return -p; }});
    const double front = mean_front(s, [&] { return std::sqrt(s.frozen_volume() / (kPi * height)); });
    RecordProperty("line_" + std::to_string(static_cast<int>(power)) + "_percent",
                   std::to_string(100.0 * (front / exact - 1.0)));
    EXPECT_NEAR(front, exact, 0.01 * exact) << power;
    EXPECT_NEAR(s.ledger().sources, -power * height * 600.0, 1e-9 * power);
    EXPECT_LT(std::abs(s.ledger().imbalance()), 1e-10 * power * height * 600.0);
  }
}

// Steady temperatures of a slab with blood and metabolism, (T₀ − T_f) cosh m(l − x)/cosh m l + T_f, m² = w ρ_b c_b/k: of second order, and
// extrapolated from two meshes within a thousandth of the difference between its ends.
TEST(HeatClosedForms, SlabWithBlood) {
  ThermalTissue t;
  t.perfusion = 5e-3, t.metabolic_heat = 4200.0;
  const double l = 0.04, m = std::sqrt(t.perfusion * t.blood_heat_capacity / t.conductivity),
               far = 37.0 + t.metabolic_heat / (t.perfusion * t.blood_heat_capacity);
  const auto at_quarter = [&](int cells) {
    HeatSimulation s(box_mesh({.cells = {cells, 1, 1}, .size = {l, 0.002, 0.002}}), {{0, t}}, {.longest_step = 1e5});
    s.hold("x_min", [](double) { return 10.0; });
    EXPECT_EQ(s.advance_to(2e5).status, HeatStatus::ok);
    for (std::size_t i = 0; i < s.mesh().vertices.size(); ++i) {
      if (std::abs(s.mesh().vertices[i].x - 0.25 * l) < 1e-9) return s.temperature()[i];
    }
    return 0.0;
  };
  const double exact = far + (10.0 - far) * std::cosh(0.75 * m * l) / std::cosh(m * l);
  const double coarse = at_quarter(20), middle = at_quarter(40), fine = at_quarter(80);
  EXPECT_NEAR((coarse - exact) / (middle - exact), 4.0, 0.1);
  EXPECT_NEAR((middle - exact) / (fine - exact), 4.0, 0.1);
  EXPECT_NEAR((4.0 * fine - middle) / 3.0, exact, 1e-5 * (far - 10.0));
}

// A slab that cools in air, at a Biot number of 1 and a Fourier number of ½, Σ 4 sin β/(2β + sin 2β) e^(−β² Fo) cos(β x/l), β tan β = Bi:
// of first order in time, of second in space, extrapolated within 0.01 % of the difference to the air.         [CarslawJaeger1959]
TEST(HeatClosedForms, SlabInAir) {
  ThermalTissue t;
  t.latent_heat = 0.0;
  const double l = 0.02, h = t.conductivity / l, alpha = t.conductivity / (t.density * t.specific_heat),
               end = 0.5 * l * l / alpha;
  const auto middle = [&](int cells, int steps) {
    HeatSimulation s(box_mesh({.cells = {cells, 1, 1}, .size = {l, l / cells, l / cells}}), {{0, t}},
                     {.step = end / steps});
    s.add_convection("x_max", h, [](double) { return 5.0; });
    EXPECT_EQ(s.advance_to(end).status, HeatStatus::ok);
    return s.temperature()[0];
  };
  double sum = 0.0;
  for (int n = 0; n < 30; ++n) {
    double low = n * kPi, high = (n + 0.5) * kPi - 1e-12;
    for (int i = 0; i < 100; ++i)
      (0.5 * (low + high) * std::tan(0.5 * (low + high)) < 1.0 ? low : high) = 0.5 * (low + high);
    sum += 4.0 * std::sin(low) / (2.0 * low + std::sin(2.0 * low)) * std::exp(-0.5 * low * low);
  }
  const double exact = 5.0 + 32.0 * sum;
  const auto in_time = [&](int cells) { return 2.0 * middle(cells, 400) - middle(cells, 200); };
  EXPECT_NEAR((middle(10, 50) - in_time(10)) / (middle(10, 100) - in_time(10)), 2.0, 0.05) << "first order in time";
  const double coarse = in_time(10), fine = in_time(20);
  EXPECT_NEAR((coarse - exact) / (fine - exact), 4.0, 0.3) << "second order in space";
  EXPECT_NEAR((4.0 * fine - coarse) / 3.0, exact, 1e-4 * 32.0);
}

}  // namespace
}  // namespace glisson
