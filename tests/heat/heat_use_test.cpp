// Heat as a program uses it: layers and ice in series, states that go back, steps that end at corners, and refusals by name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "glisson/heat/heat_simulation.h"
#include "support/bodies.h"

namespace glisson {
namespace {

TetMesh rod(int cells) { return box_mesh({.cells = {cells, 1, 1}, .size = {0.04, 0.005, 0.005}}); }

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

// Two layers conduct in series: the temperature between them is that of two resistances, at rest, to the last digits.
TEST(HeatUse, LayersConductInSeries) {
  TetMesh mesh = rod(8);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) mesh.regions.push_back(t < mesh.tets.size() / 2 ? 0 : 1);
  ThermalTissue fat;
  fat.conductivity = 0.2;
  HeatSimulation s(mesh, {{0, ThermalTissue{}}, {1, fat}}, {.longest_step = 1e7});
  s.hold("x_min", [](double) { return 40.0; });
  s.hold("x_max", [](double) { return 5.0; });
  ASSERT_EQ(s.advance_to(1e7).status, HeatStatus::ok);
  const double between = 40.0 - 35.0 * (1.0 / 0.5) / (1.0 / 0.5 + 1.0 / 0.2);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (std::abs(mesh.vertices[v].x - 0.02) < 1e-9) {
      EXPECT_NEAR(s.temperature()[v], between, 1e-6);
    }
  }
}

// Ice beside tissue at rest: k jumps by four within a cell, and ∫ k dT is linear along the rod to the last digits all the same.
TEST(HeatUse, IceAndTissueConductInSeries) {
  const TetMesh mesh = rod(7);
  const ThermalTissue t;
  HeatSimulation s(mesh, {{0, t}}, {.longest_step = 1e7});
  s.hold("x_min", [](double) { return -100.0; });
  s.hold("x_max", [](double) { return 37.0; });
  ASSERT_EQ(s.advance_to(1e8).status, HeatStatus::ok);
  const double cold = thermal_state(t, -100.0).conducted, warm = thermal_state(t, 37.0).conducted;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    EXPECT_NEAR(thermal_state(t, s.temperature()[v]).conducted, cold + (warm - cold) * mesh.vertices[v].x / 0.04,
                1e-6 * (warm - cold));
  }
}

// A state that is given back goes on with the same bytes.
TEST(HeatUse, StatesGoBack) {
  HeatSimulation s(rod(10), {{0, ThermalTissue{}}});
  s.hold("x_min", [](double) { return -80.0; });
  ASSERT_EQ(s.advance_to(20.0).status, HeatStatus::ok);
  const HeatState then = s.state();
  ASSERT_EQ(s.advance_to(60.0).status, HeatStatus::ok);
  const std::vector<double> first(s.temperature().begin(), s.temperature().end());
  s.load_state(then);
  EXPECT_EQ(s.time(), 20.0);
  ASSERT_EQ(s.advance_to(60.0).status, HeatStatus::ok);
  EXPECT_EQ(std::vector<double>(s.temperature().begin(), s.temperature().end()), first);
  EXPECT_THAT(refusal([&] {
                HeatSimulation(rod(3), {{0, ThermalTissue{}}}).load_state(then);
              }),
              ::testing::HasSubstr("of 44 vertices, this mesh has 16"));
}

// Any number of threads gives the same bytes: bodies of several blocks of vertices with obtuse tets, of one tissue and of two.
TEST(HeatUse, ThreadsGiveTheSameBytes) {
  for (const int tissues : {1, 2}) {
    std::vector<double> first;
    for (const int threads : {1, 2, 3, 5}) {
      std::mt19937 random(7);
      TetMesh mesh = test::jittered_box({14, 15, 16}, 0.003, 0.25, random);
      std::map<int, ThermalTissue> all{{0, ThermalTissue{.perfusion = 1e-3}}};
      if (tissues == 2) {
        all[1] = {.conductivity = 0.2, .freezing_ends = -4.0};
        for (std::size_t t = 0; t < mesh.tets.size(); ++t) mesh.regions.push_back(t < mesh.tets.size() / 2 ? 0 : 1);
      }
      HeatSimulation s(mesh, all, {.threads = threads});
      s.hold("x_min", [](double) { return -60.0; });
      s.add_line_source({{0.02, 0.02, 0.01}, {0.02, 0.02, 0.03}, [](double) { return -300.0; }});
      ASSERT_EQ(s.advance_to(20.0).status, HeatStatus::ok);
      std::vector<double> end = s.state().temperature;
      end.push_back(s.ledger().blood), end.push_back(s.state().limited_share);
      if (first.empty()) first = end;
      EXPECT_GT(s.mesh().vertices.size(), 3000U);
      EXPECT_GT(s.frozen_volume(), 0.0);
      EXPECT_EQ(end, first) << tissues << " tissues, " << threads << " threads";
    }
  }
}

// work() counts what was done, with seconds where it was asked for them.
TEST(HeatUse, CountsItsWork) {
  HeatSimulation s(rod(10), {{0, ThermalTissue{}}});
  s.hold("x_min", [](double) { return -80.0; });
  ASSERT_EQ(s.advance_to(5.0).status, HeatStatus::ok);
  EXPECT_GE(s.work().steps, s.steps());
  EXPECT_GT(s.work().iterations, s.work().steps);
  EXPECT_GE(s.work().products, s.work().linear_iterations);
  EXPECT_EQ(s.work().solve_seconds, 0.0);
}

// Steps end where a function of time says that it has a corner: a pulse of power gives its energy to rounding.
TEST(HeatUse, StepsEndAtCorners) {
  HeatSimulation s(rod(10), {{0, ThermalTissue{}}});
  s.add_line_source({{0.01, 0.002, 0.002},
                     {0.03, 0.002, 0.002},
                     {[](double t) { return t <= 7.3 ? 50.0 : 0.0; }, CornerTimes({7.3})}});
  ASSERT_EQ(s.advance_to(30.0).status, HeatStatus::ok);
  EXPECT_NEAR(s.ledger().sources, 50.0 * 0.02 * 7.3, 1e-9);
  EXPECT_NEAR(s.ledger().imbalance(), 0.0, 1e-9);
}

// The volume below an isotherm of a linear field is that of the box's part, wherever it cuts tets.
TEST(HeatUse, VolumeBelowAnIsotherm) {
  const TetMesh mesh = box_mesh({.cells = {3, 4, 2}, .size = {0.03, 0.02, 0.01}});
  HeatSimulation s(mesh, {{0, ThermalTissue{}}});
  HeatState state = s.state();
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) state.temperature[v] = 1000.0 * mesh.vertices[v].x + 10.0;
  s.load_state(state);
  for (const double level : {5.0, 10.0, 13.7, 20.0, 28.3, 39.9, 41.0}) {
    EXPECT_NEAR(s.volume_below(level), 0.02 * 0.01 * std::clamp((level - 10.0) * 1e-3, 0.0, 0.03), 1e-18) << level;
  }
}

// What overflows ends with a status, and the state is as before.
TEST(HeatUse, EndsWhereNumbersDo) {
  for (const double power : {1e308, -1e305}) {
    for (const double step : {0.0, 1.0}) {
      HeatSimulation s(rod(4), {{0, ThermalTissue{}}}, {.step = step});
      s.add_line_source({{0.01, 0.002, 0.002}, {0.03, 0.002, 0.002}, [power](double) { return power; }});
      while (s.steps() < 50 && s.step().status == HeatStatus::ok) continue;
      EXPECT_LT(s.steps(), 50U);
      for (const double t : s.temperature()) EXPECT_TRUE(std::isfinite(t));
      for (const double e : s.state().heat) EXPECT_TRUE(std::isfinite(e));
    }
  }
}

TEST(HeatUse, RefusesByName) {
  using ::testing::HasSubstr;
  const auto of = [](const ThermalTissue& t) { HeatSimulation(rod(2), {{0, t}}); };
  ThermalTissue t;
  t.freezing_ends = 3.0;
  EXPECT_THAT(refusal([&] { of(t); }), HasSubstr("freezing_ends"));
  t = {}, t.conductivity = 0.0;
  EXPECT_THAT(refusal([&] { of(t); }), HasSubstr("thermal tissue of region 0: conductivity [W/(m K)] = 0"));
  EXPECT_THAT(refusal([] {
                HeatSimulation(rod(2), {{0, ThermalTissue{}}}, {.temperature = 310.0});
              }),
              HasSubstr("not in K"));
  EXPECT_THAT(refusal([] {
                HeatSimulation(rod(2), {{1, ThermalTissue{}}});
              }),
              HasSubstr("region 0 of the mesh has no thermal tissue"));
  HeatSimulation s(rod(2), {{0, ThermalTissue{}}});
  EXPECT_THAT(refusal([&] {
                s.add_line_source({{0, 0, 0}, {0.2, 0, 0}, [](double) { return 1.0; }});
              }),
              HasSubstr("leaves the body at ("));
  EXPECT_THAT(refusal([&] { s.hold("nowhere", [](double) { return 1.0; }); }), HasSubstr("nowhere"));
  EXPECT_THAT(refusal([&] { s.add_convection("x_min", -1.0, [](double) { return 1.0; }); }),
              HasSubstr("-1 W/(m² K) is out of range"));
  s.hold("x_min", [](double) { return std::nan(""); });
  EXPECT_THAT(refusal([&] { s.step(); }), HasSubstr("held temperature at 0.01 s is not finite"));
}

}  // namespace
}  // namespace glisson
