// Heat follows a body that moves, is cut, or loses tets: conduction by the shape that it has, heat with the material.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "glisson/heat/heat_simulation.h"

namespace glisson::heat_body_test {
namespace {

ThermalTissue plain() {
  ThermalTissue t;
  t.perfusion = 0.0, t.metabolic_heat = 0.0;
  return t;
}

/// Steady difference of temperature between the ends of a bar that is held at one end, in a shape that is `stretch` times as long and
/// `aside` times as wide as at rest. @param heats  adds what heats it
template <class Heats>
double rise(double stretch, double aside, const Heats& heats) {
  const TetMesh mesh = box_mesh({.cells = {8, 2, 2}, .size = {0.08, 0.02, 0.02}});
  HeatSimulation s(mesh, {{0, plain()}}, {.temperature = 20.0, .longest_step = 1e5, .tolerance = 0.5});
  s.hold("x_min", [](double) { return 20.0; });
  heats(s);
  std::vector<Vec3d> x = mesh.vertices;
  for (Vec3d& p : x) p = {stretch * p.x, aside * p.y, aside * p.z};
  s.set_positions(x);
  s.advance_to(1e8);
  EXPECT_LT(std::abs(s.ledger().imbalance()), 1e-9 * std::abs(s.ledger().held));
  return s.temperature()[mesh.vertex_sets.at("x_max").front()] - 20.0;
}

// A flux q through the end of a bar warms it by q L/k, with the length and the section that the bar has: linear, and so exact on any mesh.
// Heat of p per volume at rest warms it by p V L/(2 k A) of a length L and section A, up to what lumping does to the mesh.
TEST(HeatBody, ConductsInTheShapeThatTheBodyHas) {
  const auto flux = [](HeatSimulation& s) { s.add_flux("x_max", [](double) { return 100.0; }); };
  const double expected = 100.0 * 0.08 / plain().conductivity;
  EXPECT_NEAR(rise(1.0, 1.0, flux), expected, 1e-6 * expected);
  EXPECT_NEAR(rise(2.0, 1.0, flux), 2.0 * expected, 1e-6 * expected);
  EXPECT_NEAR(rise(1.0, 3.0, flux), expected, 1e-6 * expected);
  const auto source = [](HeatSimulation& s) { s.add_source(0, [](double) { return 3000.0; }); };
  const double of_source = 3000.0 * 0.08 * 0.08 / (2.0 * plain().conductivity);
  EXPECT_NEAR(rise(1.0, 1.0, source), of_source, 0.01 * of_source);
  EXPECT_NEAR(rise(2.0, 1.0, source), 2.0 * of_source, 0.02 * of_source);
  EXPECT_NEAR(rise(1.0, 2.0, source), 0.25 * of_source, 0.005 * of_source);
}

// A cut right across a bar stops all heat: each half keeps its own, and what was one vertex has two temperatures.
TEST(HeatBody, FacesOfACutAreInsulated) {
  TetMesh mesh = box_mesh({.cells = {2, 1, 1}, .size = {0.02, 0.01, 0.01}});
  HeatSimulation s(mesh, {{0, plain()}}, {.temperature = 20.0});
  s.hold("x_min", [](double) { return 40.0; });
  s.advance_to(5.0);
  const std::vector<double> before(s.temperature().begin(), s.temperature().end());
  const double stored = s.ledger().stored;
  std::vector<std::uint32_t> origins;
  std::vector<std::uint32_t> copy(mesh.vertices.size(), 0);
  for (std::uint32_t v = 0; v < before.size(); ++v) {
    if (std::abs(mesh.vertices[v].x - 0.01) > 1e-9) continue;
    copy[v] = static_cast<std::uint32_t>(before.size() + origins.size());
    origins.push_back(v);
  }
  for (const std::uint32_t v : origins) mesh.vertices.push_back(Vec3d(mesh.vertices[v]));
  for (Tet& t : mesh.tets) {
    double middle = 0.0;
    for (const std::uint32_t v : t) middle += 0.25 * mesh.vertices[v].x;
    for (std::uint32_t& v : t) {
      if (middle > 0.01 && v < before.size() && copy[v] != 0) v = copy[v];
    }
  }
  s.change_mesh(mesh, origins);
  EXPECT_NEAR(s.ledger().stored, stored, 1e-12 * stored);
  for (std::size_t k = 0; k < origins.size(); ++k) EXPECT_EQ(s.temperature()[before.size() + k], before[origins[k]]);
  s.advance_to(4000.0);
  double far = 0.0, half = 0.0;  // mean of the half that nothing holds: as it was
  for (std::size_t v = 0; v < s.temperature().size(); ++v) {
    const double x = s.mesh().vertices[v].x;
    const bool beyond = x > 0.011 || v >= before.size();
    if (beyond)
      far += s.temperature()[v], half += 1.0;
    else
      EXPECT_NEAR(s.temperature()[v], 40.0, 0.01);
  }
  EXPECT_LT(far / half, 39.0);
  EXPECT_LT(std::abs(s.ledger().imbalance()), 1e-10 * std::abs(s.ledger().stored));
  std::stringstream file;
  s.save(file);
  s.load(file);
}

// Tets that are removed take their heat along: as much as their volume has at 20 °C, which is counted from the begin of freezing.
TEST(HeatBody, RemovedTetsTakeTheirHeat) {
  TetMesh mesh = box_mesh({.cells = {4, 2, 2}, .size = {0.04, 0.02, 0.02}});
  const ThermalTissue tissue = plain();
  HeatSimulation s(mesh, {{0, tissue}}, {.temperature = 20.0});
  s.add_convection("x_max", 50.0, [](double) { return 5.0; });
  s.add_line_source(
      {.from = {0.015, 0.01, 0.01}, .to = {0.025, 0.01, 0.01}, .power_per_length = [](double) { return 5.0; }});
  const double whole = volume(mesh);
  std::erase_if(mesh.tets, [&](const Tet& t) {
    double middle = 0.0;
    for (const std::uint32_t v : t) middle += 0.25 * mesh.vertices[v].x;
    return middle > 0.03;
  });
  s.change_mesh(mesh, {});
  const double heat = tissue.density * tissue.specific_heat * (20.0 - tissue.freezing_begins) * (whole - volume(mesh));
  EXPECT_NEAR(s.ledger().removed, -heat, 1e-9 * heat);
  s.advance_to(200.0);  // the surface that took heat is gone, the line is there still
  EXPECT_EQ(s.ledger().surface, 0.0);
  EXPECT_NEAR(s.ledger().sources, 5.0 * 0.01 * 200.0, 1e-9);
  EXPECT_LT(std::abs(s.ledger().imbalance()), 1e-10 * heat);
  EXPECT_THROW(s.set_positions(std::vector<Vec3d>(3)), std::invalid_argument);
  EXPECT_THROW(s.change_mesh(TetMesh{}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace glisson::heat_body_test
