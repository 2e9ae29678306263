// Orders of error in space and time on unstructured tets, blood in a cylinder, and fronts at steps of a minute.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "glisson/heat/heat_simulation.h"
#include "support/bodies.h"

namespace glisson {
namespace {

// Steady temperatures of a cylinder with blood and metabolism whose wall is held, T_f + (T_w − T_f) I₀(m r)/I₀(m R)
// [CarslawJaeger1959]: of second order on the axis, extrapolated from two meshes within 0.01 % of the difference. The wedges of a cylinder are
// obtuse; the limiter leaves them alone, as no extreme comes of them.
TEST(HeatOrders, CylinderWithBlood) {
  ThermalTissue t;
  t.perfusion = 5e-3, t.metabolic_heat = 4200.0;
  const double radius = 0.02, m = std::sqrt(t.perfusion * t.blood_heat_capacity / t.conductivity),
               far = 37.0 + t.metabolic_heat / (t.perfusion * t.blood_heat_capacity);
  const auto on_axis = [&](int cells) {
    HeatSimulation s(
        cylinder_mesh({.radius = radius, .height = radius / cells, .radial_cells = cells, .axial_cells = 1}), {{0, t}},
        {.step = 1e5});
    s.hold("wall", [](double) { return 10.0; });
    EXPECT_EQ(s.advance_to(1e6).status, HeatStatus::ok);
    EXPECT_LT(s.state().limited_share, 1e-12);
    return s.temperature()[s.mesh().vertex_set("axis").front()];
  };
  const double exact = far + (10.0 - far) / std::cyl_bessel_i(0.0, m * radius);
  const double coarse = on_axis(20), fine = on_axis(40);
  EXPECT_NEAR((coarse - exact) / (fine - exact), 4.0, 0.4);
  EXPECT_NEAR((4.0 * fine - coarse) / 3.0, exact, 1e-4 * std::abs(exact - 10.0));
}

/// Mean square error over the volume of a box of moved vertices whose surface is held at e^(−3 α k² t) cos kx cos ky cos kz, k = π/l.
double error_of(int cells, int steps, double jitter) {
  ThermalTissue t;
  t.latent_heat = 0.0;
  const double l = 0.02, k = std::numbers::pi / l, rate = 3.0 * t.conductivity / (t.density * t.specific_heat) * k * k;
  const double end = 0.5 / rate;
  std::mt19937 random(11);
  const TetMesh mesh = test::jittered_box({cells, cells, cells}, l / cells, jitter, random);
  const auto exact = [=](const Vec3d& x, double time) {
    return 30.0 + 10.0 * std::exp(-rate * time) * std::cos(k * x.x) * std::cos(k * x.y) * std::cos(k * x.z);
  };
  HeatSimulation s(mesh, {{0, t}}, {.temperature = 30.0, .step = end / steps});
  std::vector<char> outside(mesh.vertices.size(), 0);
  for (const Triangle& face : boundary_triangles(mesh)) {
    for (const std::uint32_t v : face) outside[v] = 1;
  }
  HeatState state = s.state();
  for (std::uint32_t v = 0; v < outside.size(); ++v) {
    const Vec3d x = mesh.vertices[v];
    state.temperature[v] = exact(x, 0.0);
    if (outside[v] != 0) s.hold(std::span(&v, 1), [=](double time) { return exact(x, time); });
  }
  std::vector<double> volume(outside.size(), 0.0);
  for (std::size_t tet = 0; tet < mesh.tets.size(); ++tet) {
    for (const std::uint32_t v : mesh.tets[tet]) volume[v] += six_rest_volume(mesh, tet) / 24.0;
  }
  for (std::size_t v = 0; v < volume.size(); ++v)
    state.heat[v] = volume[v] * thermal_state(t, state.temperature[v]).heat;
  s.load_state(state);
  EXPECT_EQ(s.advance_to(end).status, HeatStatus::ok);
  double sum = 0.0, whole = 0.0;
  for (std::size_t v = 0; v < volume.size(); ++v) {
    const double off = s.temperature()[v] - exact(mesh.vertices[v], end);
    sum += volume[v] * off * off, whole += volume[v];
  }
  return std::sqrt(sum / whole);
}

// Without phase change the error over the volume is of second order in space and of first in time: a quarter where cells are half as
// wide and steps a quarter as long, on regular boxes and on boxes whose vertices were moved.
TEST(HeatOrders, SecondInSpaceFirstInTime) {
  for (const double jitter : {0.0, 0.2}) {
    const double coarse = error_of(4, 8, jitter), middle = error_of(8, 32, jitter), fine = error_of(16, 128, jitter);
    RecordProperty("errors_" + std::to_string(jitter),
                   std::to_string(coarse) + ", " + std::to_string(middle) + ", " + std::to_string(fine));
    EXPECT_GT(coarse / middle, 2.4) << jitter;
    EXPECT_GT(middle / fine, 3.5) << jitter;
  }
}

// A front on cells of 1.5 mm at steps of a minute, through which it crosses whole rows of vertices, is within 3 % of Neumann's.
TEST(HeatOrders, StepsOfAMinute) {
  ThermalTissue t;
  t.freezing_begins = -1.0, t.freezing_ends = -1.2;
  const double alpha = t.frozen_conductivity / (t.density * t.frozen_specific_heat);
  for (const auto& [wall, root] : {std::pair(-40.0, 0.27226), std::pair(-140.0, 0.50541), std::pair(-196.0, 0.58476)}) {
    HeatSimulation s(box_mesh({.cells = {80, 1, 1}, .size = {0.12, 0.0015, 0.0015}}), {{0, t}}, {.step = 60.0});
    s.hold("x_min", [at = wall](double) { return at; });
    ASSERT_EQ(s.advance_to(600.0).status, HeatStatus::ok);
    EXPECT_LE(s.steps(), 12U) << "one that does not converge is made in halves";
    const double exact = 2.0 * root * std::sqrt(alpha * 600.0), front = s.frozen_volume() / 2.25e-6;
    RecordProperty("wall_" + std::to_string(static_cast<int>(wall)), std::to_string(100.0 * (front / exact - 1.0)));
    EXPECT_NEAR(front, exact, 0.03 * exact) << wall;
  }
}

}  // namespace
}  // namespace glisson
