// What tissue has been through: doses against closed forms, times below isotherms, freezings, and death, which ends perfusion for good.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "glisson/heat/heat_simulation.h"

namespace glisson {
namespace {

TetMesh small_box() { return box_mesh({.cells = {2, 2, 2}, .size = {0.01, 0.01, 0.01}}); }

/// All of a body at a course of temperatures.
HeatSimulation driven(TimeFunction<double> course, const ThermalTissue& tissue, HeatOptions options) {
  options.temperature = course(0.0);
  HeatSimulation s(small_box(), {{0, tissue}}, options);
  std::vector<std::uint32_t> all(s.mesh().vertices.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
  s.hold(all, std::move(course));
  return s;
}

// CEM43 of constant temperatures is time by R^(43 − T); of a linear course it is the integral, through both corners.
TEST(HeatDeath, EquivalentTimeIsItsIntegral) {
  EXPECT_NEAR(cem43(43.0, 43.0, 60.0), 1.0, 1e-12);
  EXPECT_NEAR(cem43(46.0, 46.0, 600.0), 10.0 * 8.0, 1e-10);
  EXPECT_NEAR(cem43(41.0, 41.0, 600.0), 10.0 / 16.0, 1e-12);
  EXPECT_EQ(cem43(20.0, 38.9, 600.0), 0.0);
  for (const auto& [from, to] : {std::pair(30.0, 50.0), std::pair(47.0, 36.0), std::pair(40.0, 42.0)}) {
    constexpr int kParts = 200000;
    double sum = 0.0;
    for (int k = 0; k < kParts; ++k) {
      const double t = std::lerp(from, to, (k + 0.5) / kParts);
      if (t > 39.0) sum += std::pow(t > 43.0 ? 2.0 : 4.0, t - 43.0) * 300.0 / 60.0 / kParts;
    }
    EXPECT_NEAR(cem43(from, to, 300.0), sum, 1e-4 * sum) << from << " to " << to;
  }
}

// A simulation's dose does not depend on its steps: half an hour at 44 °C, and a ramp, against their closed forms.
TEST(HeatDeath, DosesOfARun) {
  ThermalTissue t;
  t.death = TissueDeath{};
  for (const double step : {5.0, 60.0}) {
    HeatSimulation s = driven([](double) { return 44.0; }, t, {.step = step});
    ASSERT_EQ(s.advance_to(1800.0).status, HeatStatus::ok);
    const double rate = std::exp(226.7847 - 6.28e5 / (8.31446261815324 * 317.15));
    EXPECT_NEAR(s.state().history.cem43[4], 60.0, 1e-9);
    EXPECT_NEAR(s.state().history.damage[4], rate * 1800.0, 1e-9 * rate * 1800.0);
  }
  HeatSimulation s = driven([](double time) { return 37.0 + time / 60.0; }, t, {.step = 20.0});
  ASSERT_EQ(s.advance_to(600.0).status, HeatStatus::ok);
  // ∫ 2^(T − 43) dT/(1 K/min) from 43 to 47 and ∫ 4^(T − 43) dT from 39 to 43
  EXPECT_NEAR(s.state().history.cem43[0], 15.0 / std::log(2.0) + (1.0 - std::pow(4.0, -4.0)) / std::log(4.0), 1e-9);
}

// Times below isotherms and numbers of freezings of a saw: two cycles between 20 and −60 °C at 1 K/s.
TEST(HeatDeath, TimesBelowAndFreezings) {
  const auto saw = [](double time) {
    const double in = std::fmod(time, 160.0);
    return in <= 80.0 ? 20.0 - in : -60.0 + (in - 80.0);
  };
  HeatSimulation s = driven({saw, CornerTimes({80.0, 160.0, 240.0})}, ThermalTissue{}, {.step = 7.0});
  ASSERT_EQ(s.advance_to(320.0).status, HeatStatus::ok);
  const HeatHistory& h = s.state().history;
  ASSERT_EQ(h.below.size(), 3U);
  EXPECT_NEAR(h.below[0][3], 2 * 120.0, 1e-9);  // 0 °C
  EXPECT_NEAR(h.below[1][3], 2 * 80.0, 1e-9);   // −20 °C
  EXPECT_NEAR(h.below[2][3], 2 * 40.0, 1e-9);   // −40 °C
  EXPECT_EQ(h.freezings[3], 2U);
  EXPECT_NEAR(h.coldest[3], -60.0, 1e-12);
  EXPECT_EQ(s.dead_volume(), 0.0) << "this tissue does not die";
}

// Tissue dies of cold once it has been below a temperature for a time, and its volume counts from then on, thawed or not.
TEST(HeatDeath, DiesOfColdAfterItsTime) {
  ThermalTissue t;
  t.death = TissueDeath{.cold = -20.0, .cold_time = 30.0};
  HeatSimulation s =
      driven({[](double time) { return time <= 40.0 ? -30.0 : 37.0; }, CornerTimes({40.0})}, t, {.step = 1.0});
  ASSERT_EQ(s.advance_to(29.0).status, HeatStatus::ok);
  EXPECT_EQ(s.dead_volume(), 0.0);
  ASSERT_EQ(s.advance_to(31.0).status, HeatStatus::ok);
  EXPECT_NEAR(s.dead_volume(), 1e-6, 1e-18);
  ASSERT_EQ(s.advance_to(100.0).status, HeatStatus::ok);
  EXPECT_NEAR(s.dead_volume(0), 1e-6, 1e-18);
  EXPECT_EQ(s.frozen_volume(), 0.0);
  EXPECT_EQ(s.dead_volume(7), 0.0);
}

// Heat kills at Ω = 1, which comes the sooner the hotter: by the closed form of a constant temperature.
TEST(HeatDeath, DiesOfHeatAtItsDamage) {
  ThermalTissue t;
  t.death = TissueDeath{};
  for (const double hot : {52.0, 56.0}) {
    const double time = 1.0 / std::exp(226.7847 - 6.28e5 / (8.31446261815324 * (hot + 273.15)));
    HeatSimulation s = driven([hot](double) { return hot; }, t, {.step = time / 100.0});
    ASSERT_EQ(s.advance_to(0.985 * time).status, HeatStatus::ok);
    EXPECT_EQ(s.dead_volume(), 0.0) << hot;
    ASSERT_EQ(s.advance_to(1.015 * time).status, HeatStatus::ok);
    EXPECT_GT(s.dead_volume(), 0.0) << hot;
  }
}

// Perfusion comes back where tissue thaws that lives, and stays away where it has died: the steady state without blood follows.
TEST(HeatDeath, DeadTissueHasNoBlood) {
  for (const bool dies : {false, true}) {
    ThermalTissue t;
    t.perfusion = 0.01;
    if (dies) t.death = TissueDeath{};
    HeatSimulation s(small_box(), {{0, t}}, {.temperature = 37.0});
    s.add_source(0, {[](double time) { return time <= 200.0 ? -4e6 : 0.0; }, CornerTimes({200.0})});
    s.add_convection("x_min", 50.0, [](double) { return 20.0; });
    ASSERT_EQ(s.advance_to(200.0).status, HeatStatus::ok);
    ASSERT_LT(s.temperature()[13], -40.0);
    const double blood = s.ledger().blood;
    ASSERT_EQ(s.advance_to(40000.0).status, HeatStatus::ok);
    if (dies) {
      EXPECT_EQ(s.ledger().blood, blood);
      EXPECT_NEAR(s.temperature()[13], 20.0, 0.1);
    } else {
      EXPECT_GT(s.ledger().blood, blood + 100.0);
      EXPECT_GT(s.temperature()[13], 33.0);
    }
    EXPECT_LT(std::abs(s.ledger().imbalance()), 1e-10 * std::abs(s.ledger().sources));
  }
}

// A saved state goes on with the same bytes in a simulation that was made anew, dead tissue included; foreign and cut bytes are refused
// and change nothing.
TEST(HeatDeath, SavesAndLoads) {
  const auto made = [] {
    ThermalTissue t;
    t.perfusion = 0.01, t.death = TissueDeath{};
    HeatSimulation s(small_box(), {{0, t}});
    s.hold("x_min", {[](double time) { return time <= 60.0 ? -120.0 : 30.0; }, CornerTimes({60.0})});
    return s;
  };
  HeatSimulation first = made();
  ASSERT_EQ(first.advance_to(70.0).status, HeatStatus::ok);
  std::ostringstream out;
  first.save(out);
  ASSERT_EQ(first.advance_to(200.0).status, HeatStatus::ok);
  HeatSimulation second = made();
  std::istringstream in(out.str());
  second.load(in);
  EXPECT_EQ(second.time(), 70.0);
  EXPECT_GT(second.dead_volume(), 0.0);
  ASSERT_EQ(second.advance_to(200.0).status, HeatStatus::ok);
  EXPECT_EQ(second.state().temperature, first.state().temperature);
  EXPECT_EQ(second.state().history, first.state().history);
  const auto refused = [&](const std::string& bytes) {
    std::istringstream forged(bytes);
    const HeatState before = second.state();
    try {
      second.load(forged);
      return false;
    } catch (const std::runtime_error&) {
      return second.state().temperature == before.temperature && second.time() == before.time;
    }
  };
  EXPECT_TRUE(refused("not one"));
  for (std::size_t cut = 0; cut < out.str().size(); cut += 97) EXPECT_TRUE(refused(out.str().substr(0, cut))) << cut;
  std::ostringstream other;
  HeatSimulation(box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.01, 0.01}}), {{0, ThermalTissue{}}}).save(other);
  EXPECT_TRUE(refused(other.str()));
}

}  // namespace
}  // namespace glisson
