// Vessels: the law of their walls against the exact solution of Graetz, regions of blood against a closed form, flow that stops.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "glisson/heat/heat_simulation.h"
#include "glisson/heat/vessel_wall.h"

namespace glisson {
namespace {

/// Mean Nusselt number of laminar flow in a tube whose wall is at 0 and whose blood comes in at 1, by marching
///   2 (1 − ρ²) ∂θ/∂ζ = 4/ρ ∂/∂ρ (ρ ∂θ/∂ρ),   ρ = 2 r/D,   ζ = z a/(u D²), 1/Gz at the end
/// Rings of finite volumes, implicit along the tube: of second order across, of first along, extrapolated from two.
double graetz_nusselt(double graetz) {
  const auto mean_at_end = [&](int steps) {
    constexpr int kRings = 1000;
    const double dr = 1.0 / kRings, dz = 1.0 / graetz / steps;  // along in u D²/a, so that the end is at 1/Gz
    std::vector<double> theta(kRings, 1.0), lower(kRings), diagonal(kRings), upper(kRings);
    for (int s = 0; s < steps; ++s) {
      for (int k = 0; k < kRings; ++k) {
        const double r = (k + 0.5) * dr, capacity = 2.0 * (1.0 - r * r) * r * dr / dz;  // 2 u (1 − ρ²) ρ
        const double in = k * dr / dr, out = k + 1 < kRings ? (k + 1) * dr / dr : 2.0 / dr;
        lower[k] = -4.0 * in, upper[k] = k + 1 < kRings ? -4.0 * out : 0.0;  // a/R² = 4 a/D²
        diagonal[k] = capacity + 4.0 * (in + out);
        theta[k] *= capacity;
      }
      for (int k = 1; k < kRings; ++k) {
        const double f = lower[k] / diagonal[k - 1];
        diagonal[k] -= f * upper[k - 1], theta[k] -= f * theta[k - 1];
      }
      theta[kRings - 1] /= diagonal[kRings - 1];
      for (int k = kRings - 2; k >= 0; --k) theta[k] = (theta[k] - upper[k] * theta[k + 1]) / diagonal[k];
    }
    double sum = 0.0;
    for (int k = 0; k < kRings; ++k) {
      const double r = (k + 0.5) * dr;
      sum += 4.0 * (1.0 - r * r) * r * dr * theta[k];
    }
    return sum;
  };
  const double mean = 2.0 * mean_at_end(2000) - mean_at_end(1000);
  // what blood loses, u ρ c π D²/4 d(mean) = −h π D mean dz: ln(1/mean) = 4 Nu/Gz
  return 0.25 * graetz * std::log(1.0 / mean);
}

// The law of the wall is the solution of Graetz within 1 % for vessels of any length, and 3.66 far down.
TEST(Vessel, LawOfTheWallIsThatOfGraetz) {
  for (const double graetz : {1.0, 10.0, 50.0, 200.0, 1000.0, 10000.0}) {
    const double exact = graetz_nusselt(graetz), law = laminar_nusselt(graetz);
    RecordProperty("graetz_" + std::to_string(static_cast<int>(graetz)),
                   std::to_string(exact) + ", law " + std::to_string(law));
    EXPECT_NEAR(law, exact, 0.011 * exact) << graetz;
  }
  EXPECT_DOUBLE_EQ(laminar_nusselt(0.0), 3.66);
  VesselWall portal{.diameter = 0.012, .speed = 0.15};
  EXPECT_NEAR(wall_coefficient(portal), 3.66 * 0.52 / 0.012, 1e-9);
  portal.length = 0.03;
  EXPECT_NEAR(wall_coefficient(portal), laminar_nusselt(0.15 * 0.012 * 0.012 * 3.6e6 / (0.52 * 0.03)) * 0.52 / 0.012,
              1e-9);
  portal.speed = 0.0;
  EXPECT_EQ(wall_coefficient(portal), 0.0);
  portal.speed = 1.5;
  EXPECT_THROW(wall_coefficient(portal), std::invalid_argument) << "turbulent";
}

/// A slab of tissue of 20 mm beside a vessel of 10 mm, across x.
TetMesh slab_beside_a_vessel(int cells) {
  const int all = 3 * cells / 2;
  TetMesh mesh = box_mesh({.cells = {all, 1, 1}, .size = {0.03, 0.002, 0.002}});
  for (const Tet& t : mesh.tets) {
    double x = 0.0;
    for (const std::uint32_t v : t) x += 0.25 * mesh.vertices[v].x;
    mesh.regions.push_back(x < 0.02 ? 0 : 1);
  }
  mesh.region_names = {{0, "tissue"}, {1, "vein"}};
  return mesh;
}

// Tissue whose far face is held at −40 °C loses (T_b − T_f)/(1/h + l/k) a square metre out of the vessel: exactly, as the temperature is
// linear. The region of the vessel is no tissue: it takes no heat, does not freeze, and is as warm as its blood.
TEST(Vessel, WallWithACoefficient) {
  ThermalTissue t;
  t.latent_heat = 0.0, t.frozen_conductivity = t.conductivity, t.frozen_specific_heat = t.specific_heat;
  const double h = 200.0, area = 4e-6;
  HeatSimulation s(slab_beside_a_vessel(8), {{0, t}}, {.step = 1e5, .hollow = {1}});
  s.hold("x_min", [](double) { return -40.0; });
  s.add_vessel(
      1, [=](double) { return h; }, [](double) { return 36.0; });
  ASSERT_EQ(s.advance_to(2e6).status, HeatStatus::ok);
  const double before = s.ledger().surface;
  ASSERT_EQ(s.advance_to(2.1e6).status, HeatStatus::ok);
  const double flux = 76.0 / (1.0 / h + 0.02 / t.conductivity);
  EXPECT_NEAR((s.ledger().surface - before) / 1e5 / area, flux, 1e-6 * flux);
  EXPECT_LT(std::abs(s.ledger().imbalance()), 1e-10 * std::abs(s.ledger().surface));
  double wall = 0.0, blood = 0.0;
  for (std::size_t v = 0; v < s.mesh().vertices.size(); ++v) {
    const double x = s.mesh().vertices[v].x;
    if (std::abs(x - 0.02) < 1e-9) wall = s.temperature()[v];
    if (x > 0.029) blood = s.temperature()[v];
  }
  EXPECT_NEAR(wall, 36.0 - flux / h, 1e-6);
  EXPECT_EQ(blood, 36.0);
  EXPECT_NEAR(s.volume_below(100.0), 0.02 * area, 1e-12) << "of tissue alone";
}

// Flow that stops for a minute, as when a vessel is clamped: the wall gives no heat meanwhile, to the last bit.
TEST(Vessel, FlowThatStops) {
  HeatSimulation s(slab_beside_a_vessel(8), {{0, ThermalTissue{}}}, {.hollow = {1}});
  s.hold("x_min", [](double) { return -40.0; });
  s.add_vessel(1, {[](double time) { return time > 60.0 && time <= 120.0 ? 0.0 : 150.0; }, CornerTimes({60.0, 120.0})},
               [](double) { return 37.0; });
  ASSERT_EQ(s.advance_to(60.0).status, HeatStatus::ok);
  const double before = s.ledger().surface;
  ASSERT_EQ(s.advance_to(120.0).status, HeatStatus::ok);
  EXPECT_EQ(s.ledger().surface, before);
  ASSERT_EQ(s.advance_to(180.0).status, HeatStatus::ok);
  EXPECT_GT(s.ledger().surface, before);
}

TEST(Vessel, IsNamedWhereItCannotBe) {
  const TetMesh mesh = slab_beside_a_vessel(4);
  EXPECT_THROW(HeatSimulation(mesh, {{0, ThermalTissue{}}}), std::invalid_argument) << "no tissue, not hollow";
  HeatSimulation s(mesh, {{0, ThermalTissue{}}}, {.hollow = {1}});
  const auto one = [](double) { return 1.0; };
  EXPECT_THROW(s.add_vessel(0, one, one), std::invalid_argument);
  EXPECT_THROW(s.add_source(1, one), std::invalid_argument);
}

}  // namespace
}  // namespace glisson
