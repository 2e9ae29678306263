// Readings at places against fields whose values there are known; a probe with a surface and a coefficient against its closed form.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "glisson/heat/heat_places.h"
#include "glisson/heat/heat_simulation.h"

namespace glisson {
namespace {

std::vector<double> field_on(const TetMesh& mesh, const std::function<double(const Vec3d&)>& f) {
  std::vector<double> values;
  for (const Vec3d& x : mesh.vertices) values.push_back(f(x));
  return values;
}

// Linear fields are read exactly: at points, along lines that leave the body on both sides, on planes that lie askew.
TEST(HeatPlaces, LinearFieldsAreExact) {
  const TetMesh mesh = box_mesh({.cells = {3, 4, 2}, .size = {0.03, 0.02, 0.01}});
  const std::vector<double> f = field_on(mesh, [](const Vec3d& x) { return 1000.0 * x.x - 5.0; });
  const std::vector<Vec3d> points{{0.0, 0.0, 0.0}, {0.0123, 0.007, 0.003}, {0.03, 0.02, 0.01}};
  const std::vector<double> read = HeatPoints(mesh, points).read(f);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(read[i], 1000.0 * points[i].x - 5.0, 1e-9);
  const HeatLine line(mesh, {0.0, 0.01, 0.005}, {0.03, 0.01, 0.005});
  for (const double level : {-6.0, 0.0, 3.7, 25.0, 30.0})
    EXPECT_NEAR(line.length_below(f, level), std::clamp(1e-3 * (level + 5.0), 0.0, 0.03), 1e-12) << level;
  EXPECT_NEAR(line.integral(f), 0.03 * 10.0, 1e-12);
  const HeatLine through(mesh, {0.015, -0.02, 0.005}, {0.015, 0.04, 0.005});
  EXPECT_NEAR(through.length_below(f, 100.0), 0.02, 1e-9);
  EXPECT_NEAR(HeatLine(mesh, {0.015, -9000, 0.005}, {0.015, 9000, 0.005}).length_below(f, 100.0), 0.02, 1e-9);
  const HeatPlane across(mesh, {0.011, 0.01, 0.005}, {0.0, 0.0, 2.0});
  EXPECT_NEAR(across.below(f, 5.0).area, 0.01 * 0.02, 1e-15);
  EXPECT_NEAR(across.below(f, 5.0).width, std::hypot(0.01, 0.02), 1e-6);
  const HeatPlane askew(mesh, {0.015, 0.01, 0.005}, {1.0, 1.0, 0.0});
  EXPECT_NEAR(askew.below(f, 100.0).area, 0.01 * std::sqrt(2.0) * 0.02, 1e-12);
  const IsothermExtent extent = isotherm_extent(mesh, f, 12.0);
  EXPECT_NEAR(extent.volume, 0.017 * 0.02 * 0.01, 1e-15);
  EXPECT_NEAR(extent.high.x, 0.017, 1e-12);
  EXPECT_NEAR(extent.high.y - extent.low.y, 0.02, 1e-12);
  EXPECT_EQ(isotherm_extent(mesh, f, -5.0).volume, 0.0);
}

// A ball: area, width and extents of a field of distance, to the second order of its mesh.
TEST(HeatPlaces, BallOfCold) {
  const TetMesh mesh = box_mesh({.cells = {24, 24, 24}, .size = {0.04, 0.04, 0.04}, .origin = {-0.02, -0.02, -0.02}});
  const std::vector<double> f = field_on(mesh, [](const Vec3d& x) { return norm(x); });
  const double r = 0.0137;
  const HeatPlane::Section section = HeatPlane(mesh, {}, {0, 0, 1}).below(f, r);
  EXPECT_NEAR(section.area, std::numbers::pi * r * r, 0.01 * std::numbers::pi * r * r);
  EXPECT_NEAR(section.width, 2.0 * r, 0.005 * 2.0 * r);
  const IsothermExtent extent = isotherm_extent(mesh, f, r);
  EXPECT_NEAR(extent.volume, 4.0 / 3.0 * std::numbers::pi * r * r * r, 0.02 * 4.0 / 3.0 * std::numbers::pi * r * r * r);
  EXPECT_NEAR(extent.high.z - extent.low.z, 2.0 * r, 0.01 * 2.0 * r);
}

TEST(HeatPlaces, RefusesWhatLiesOutside) {
  const TetMesh mesh = box_mesh({.cells = {1, 1, 1}, .size = {0.01, 0.01, 0.01}});
  const std::vector<Vec3d> outside{{0.02, 0.0, 0.0}};
  EXPECT_THROW(HeatPoints(mesh, outside), std::invalid_argument);
  EXPECT_THROW(HeatLine(mesh, {0.02, 0.0, 0.0}, {0.03, 0.0, 0.0}), std::invalid_argument);
  EXPECT_THROW(HeatLine(mesh, {0.005, 0.005, 0.005}, {0.005, 0.005, 0.005}), std::invalid_argument);
  EXPECT_THROW(HeatPlane(mesh, {0.0, 0.0, 0.02}, {0, 0, 1}), std::invalid_argument);
}

// A probe at T_s in a cylinder whose wall is held: at rest it takes (T_s − T_wall)/(1/c + ln(R/r)/(2 π k)) a metre, the nearer the finer
// the cells around it.
TEST(HeatPlaces, ProbeWithACoefficient) {
  const double r = 1.5e-3, wall = 0.03, height = 2e-3, pi = std::numbers::pi;
  ThermalTissue t;
  t.frozen_conductivity = t.conductivity, t.latent_heat = 0.0;
  for (const double c : {0.5, 5.0, 50.0}) {
    double coarse = 1.0;
    for (const int cells : {12, 24}) {
      HeatSimulation s(
          cylinder_mesh({.radius = wall, .height = height, .radial_cells = cells, .axial_cells = 1, .grading = 12.0}),
          {{0, t}}, {.step = 2e5});
      s.hold("wall", [](double) { return 37.0; });
      s.add_line_source({.from = {0, 0, 0},
                         .to = {0, 0, height},
                         .temperature = [](double) { return -100.0; },
                         .coefficient = [c](double) { return c; },
                         .radius = r});
      ASSERT_EQ(s.advance_to(2e6).status, HeatStatus::ok);
      const double taken = s.ledger().sources;
      ASSERT_EQ(s.advance_to(2.2e6).status, HeatStatus::ok);
      const double power = (s.ledger().sources - taken) / 2e5 / height,
                   exact = (-100.0 - 37.0) / (1.0 / c + std::log(wall / r) / (2.0 * pi * t.conductivity));
      EXPECT_LT(std::abs(s.ledger().imbalance()), 1e-10 * std::abs(s.ledger().sources));
      const double error = std::abs(power / exact - 1.0);
      RecordProperty("coefficient_" + std::to_string(c) + "_cells_" + std::to_string(cells), std::to_string(error));
      EXPECT_LT(error, 0.7 * coarse) << c;
      coarse = error;
    }
    EXPECT_LT(coarse, 0.05) << c;
  }
}

// A coefficient of 0 is a probe that is off: what it gave until then stays, to rounding.
TEST(HeatPlaces, ProbeThatIsOffGivesNothing) {
  HeatSimulation s(box_mesh({.cells = {4, 4, 4}, .size = {0.02, 0.02, 0.02}}), {{0, ThermalTissue{}}});
  s.add_line_source({.from = {0.01, 0.01, 0.005},
                     .to = {0.01, 0.01, 0.015},
                     .temperature = [](double) { return -150.0; },
                     .coefficient = {[](double time) { return time <= 60.0 ? 8.0 : 0.0; }, CornerTimes({60.0})}});
  ASSERT_EQ(s.advance_to(60.0).status, HeatStatus::ok);
  const double taken = s.ledger().sources;
  EXPECT_LT(taken, -50.0);
  ASSERT_EQ(s.advance_to(300.0).status, HeatStatus::ok);
  EXPECT_EQ(s.ledger().sources, taken);
  EXPECT_THROW(s.add_line_source({.from = {0.01, 0.01, 0.005}, .to = {0.01, 0.01, 0.015}}), std::invalid_argument);
  EXPECT_THROW(
      s.add_line_source(
          {.from = {0.01, 0.01, 0.005}, .to = {0.01, 0.01, 0.015}, .temperature = [](double) { return -150.0; }}),
      std::invalid_argument);
}

}  // namespace
}  // namespace glisson
