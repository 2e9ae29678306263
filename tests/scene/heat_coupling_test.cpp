// heat_coupling_test.cpp — a scene with [heat.ice]: the body freezes in the shape that it has, and heat follows the body.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <sstream>

#include "glisson/scene/advice.h"
#include "glisson/scene/heat_run.h"
#include "scene/scene_text.h"
#include "support/must_step.h"

namespace glisson {
namespace heat_coupling_test {

using test::parse;
using ::testing::HasSubstr;

const std::string kScene = R"([mesh]
kind = "box"
cells = [4, 2, 2]
size_m = [0.04, 0.02, 0.02]
[tissue]
youngs_modulus_Pa = 4000
[motion]
integrator = "quasi_static"
[[fixed]]
set = "x_min"
[heat]
temperature_C = 20
duration_s = 40
[heat.ice]
every_s = 2
[[heat.tissue]]
preset = "agar"
[[heat.boundary]]
set = "x_min"
temperature_C = -60
[[heat.sensor]]
name = "near"
point_m = [0.012, 0.01, 0.01]
[[heat.sensor]]
name = "far"
point_m = [0.035, 0.01, 0.01]
)";
const std::string kPull = "[[load]]\nset = \"x_max\"\ntraction_Pa = [400, 0, 0]\nramp_s = 1\n";

BuiltVariant built(const std::string& text) { return build_variant(parse(text).variants.at(0), {}); }

void to(BuiltVariant& b, double time) {
  b.simulation.set_step_end(time);
  while (b.simulation.time() + 0.5 * b.simulation.step_size() < time) test::must_step(b.simulation);
}

std::vector<double> temperatures(const BuiltVariant& b) {
  const auto t = b.heat->heat().simulation.temperature();
  return {t.begin(), t.end()};
}

// A body that nothing moves has the temperatures of heat alone with the same ends of steps, to the last bit; its tets have the ice of
// their vertices.
TEST(HeatCoupling, HeatOfABodyAtRestIsThatOfHeatAlone) {
  BuiltVariant b = built(kScene);
  to(b, 40.0);
  BuiltHeat alone(parse(kScene).variants.at(0), {});
  for (int k = 1; k <= 20; ++k) alone.simulation.advance_to(2.0 * k);
  EXPECT_EQ(temperatures(b),
            std::vector<double>(alone.simulation.temperature().begin(), alone.simulation.temperature().end()));
  const std::vector<double> frozen = alone.simulation.frozen_share();
  EXPECT_GT(b.heat->ice()->frozen_tets(), 10U);
  for (std::uint32_t t = 0; t < b.simulation.mesh().tets.size(); ++t) {
    double mean = 0.0;
    for (const std::uint32_t v : b.simulation.mesh().tets[t]) mean += 0.25 * frozen[v];
    EXPECT_NEAR(b.heat->ice()->share(t), mean, 1.0 / 256.0) << t;
  }
}

// A bar that is drawn is longer and thinner, and gets cold later at its end; what froze first is strained less than what froze last.
TEST(HeatCoupling, ConductionFollowsTheBody) {
  BuiltVariant rest = built(kScene), drawn = built(kScene + kPull);
  to(rest, 40.0), to(drawn, 40.0);
  const double at_rest = rest.heat->heat().read().temperatures[1], longer = drawn.heat->heat().read().temperatures[1];
  EXPECT_GT(longer, at_rest + 0.1);
  EXPECT_LT(at_rest, 15.0);
  const HeatLedger ledger = drawn.heat->heat().simulation.ledger();
  EXPECT_LT(std::abs(ledger.imbalance()), 1e-9 * std::abs(ledger.stored));
  EXPECT_LT(std::abs(drawn.simulation.energies().imbalance()), 1e-8 * drawn.simulation.energies().work_loads);
}

// Cuts and removals are followed: heat of removed tets is booked, sensors in them are lost, the balance closes.
TEST(HeatCoupling, FollowsChangesOfTheMesh) {
  BuiltVariant b = built(kScene);
  to(b, 10.0);
  std::vector<std::uint32_t> end;
  for (std::uint32_t t = 0; t < b.simulation.mesh().tets.size(); ++t) {
    double x = 0.0;
    for (const std::uint32_t v : b.simulation.mesh().tets[t]) x += 0.25 * b.simulation.mesh().vertices[v].x;
    if (x > 0.03) end.push_back(t);
  }
  b.simulation.remove_tets(end);
  EXPECT_FALSE(std::isnan(b.heat->heat().read().temperatures[1]));
  EXPECT_TRUE(std::isnan(b.heat->heat().read().temperatures[2]));
  const HeatLedger ledger = b.heat->heat().simulation.ledger();
  EXPECT_LT(ledger.removed, -0.2 * 4180.0 * 1000.0 * 15.0 * 16e-6);
  EXPECT_LT(std::abs(ledger.imbalance()), 1e-10 * std::abs(ledger.removed));
  to(b, 20.0);
  EXPECT_EQ(b.heat->trouble(), "");
  EXPECT_LT(std::abs(b.heat->heat().simulation.ledger().imbalance()), 1e-9 * std::abs(ledger.removed));
}

// From a state in memory, one before a removal too, and from a checkpoint, it goes on with the same bytes.
TEST(HeatCoupling, GoesOnFromAState) {
  BuiltVariant b = built(kScene + kPull);
  to(b, 11.0);
  std::stringstream file;
  b.simulation.save(file);
  const State state = b.simulation.save_state();
  to(b, 30.0);
  const std::vector<double> end = temperatures(b);
  const std::uint64_t hash = b.simulation.state_hash();
  b.simulation.load_state(state);
  to(b, 30.0);
  EXPECT_EQ(temperatures(b), end);
  EXPECT_EQ(b.simulation.state_hash(), hash);
  b.simulation.remove_tets(std::vector<std::uint32_t>{90, 91, 92});
  to(b, 34.0);
  b.simulation.load_state(state);
  to(b, 30.0);
  EXPECT_EQ(temperatures(b), end);
  EXPECT_EQ(b.simulation.state_hash(), hash);
  BuiltVariant other = built(kScene + kPull);
  other.simulation.load(file);
  to(other, 30.0);
  EXPECT_EQ(temperatures(other), end);
  EXPECT_EQ(other.simulation.state_hash(), hash);
}

struct Seen final : RunObserver {
  void on_sample(const Sample& s) override { last = s; }
  void on_end(const RunSummary& s) override { summary = s; }
  Sample last;
  RunSummary summary;
};

// Where ice asks for shorter steps than are given the run ends, and says what to do.
TEST(HeatCoupling, EndsWhereIceCannotBeBorne) {
  std::string given = kScene;
  given.replace(given.find("integrator = \"quasi_static\""), 27, "step_s = 1e-3");
  Seen seen;
  const std::atomic<bool> stop = false;
  run_variant(parse(given).variants.at(0), {}, seen, stop);
  EXPECT_EQ(seen.summary.end, RunSummary::End::stopped_unstable);
  EXPECT_THAT(seen.summary.trouble, HasSubstr("integrator = \"implicit\""));
  EXPECT_LT(seen.summary.time_s, 39.0);
  EXPECT_GE(seen.summary.time_s, 2.0);
  std::string said;
  for (const Advice& advice : advise(parse(given).variants.at(0), {})) said += advice.rule + ": " + advice.text + "\n";
  EXPECT_THAT(said, HasSubstr("freezing: ice that is 100 times as stiff"));
}

// Without the table a scene of heat stays one of heat alone; mistakes in it are named.
TEST(HeatCoupling, IsAskedForByItsTable) {
  std::string alone = kScene;
  alone.erase(alone.find("[heat.ice]\nevery_s = 2\n"), 23);
  EXPECT_THAT([&] { built(alone); }, testing::ThrowsMessage<SceneError>(HasSubstr("[heat.ice]")));
  EXPECT_THAT([&] { parse(kScene + "[heat.ice.more]\n"); }, testing::ThrowsMessage<SceneError>(HasSubstr("more")));
  std::string soft = kScene;
  soft.replace(soft.find("every_s = 2"), 11, "factor = 0.5");
  EXPECT_THAT([&] { parse(soft); }, testing::ThrowsMessage<SceneError>(HasSubstr("factor")));
}

}  // namespace heat_coupling_test
}  // namespace glisson
