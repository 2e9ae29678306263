// Energy that comes from nothing is said, with its time; where it is a law's fault the run goes on, where it has no bound it ends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "scene/scene_text.h"

namespace glisson::energy_gain_test {
namespace {

using ::testing::HasSubstr;
using End = RunSummary::End;

const std::atomic<bool> kGoOn{false};

/// A soft cube after a pulse; nothing acts on it from 0.12 s on. @param force  the load
Variant pulse(const std::string& tissue, const std::string& force = "[0.18, 0, -0.6]") {
  const std::string text = R"([mesh]
kind = "box"
cells = [3, 3, 4]
size_m = [0.04, 0.04, 0.04]
[[fixed]]
set = "z_min"
[[load]]
set = "z_max"
force_N = )" + force + R"(
times_s = [0, 0.1, 0.12]
factors = [0, 1, 0]
[output]
frames = 5
sample_rate_hz = 200
[motion]
duration_s = 3
[tissue]
youngs_modulus_Pa = 3000
poisson_ratio = 0.3
)" + tissue;
  return test::parse(text).variants.at(0);
}
RunSummary run(const Variant& v) {
  RunObserver nobody;
  return run_variant(v, {}, nobody, kGoOn);
}
RunSummary after_pulse(const std::string& tissue, const std::string& force = "[0.18, 0, -0.6]") {
  return run(pulse(tissue, force));
}

std::string said(const RunSummary& s) {
  const EnergyGain& gain = *s.energy_gain;
  return std::string(meaning_of(gain.of)) + " from " + std::to_string(gain.began) + " s on, " +
         std::to_string(gain.most);
}

// A branch a thousand times faster than the motion takes energy, whatever the kinematics and the part that relaxes. (With Cauchy's
// deviator corotational tissue gained 0.2 J in 1.8 s, and St Venant–Kirchhoff's, pushed half as much, 0.02 J in 2.6 s.)
TEST(EnergyGain, FastBranchesTakeEnergy) {
  for (const auto& [kinematics, force] :
       {std::pair{"small", "[0.18, 0, -0.6]"}, {"corotational", "[0.18, 0, -0.6]"}, {"green", "[0.09, 0, -0.3]"}}) {
    for (const char* part : {"deviator", "all"}) {
      SCOPED_TRACE(std::string(kinematics) + " " + part);
      const RunSummary s = after_pulse(std::string("kinematics = \"") + kinematics + "\"\nmaxwell_part = \"" + part +
                                           "\"\nmaxwell = [{ share = 0.5, time_s = 1e-6 }]\n",
                                       force);
      EXPECT_EQ(s.end, End::finished) << s.trouble;
      ASSERT_TRUE(s.energy_gain.has_value());
      EXPECT_FALSE(s.energy_gain->any()) << said(s);
      EXPECT_GT(s.energy_gain->paid, 1e-3);
      EXPECT_LT(s.energies.kinetic + s.energies.elastic, s.energy_gain->paid);
    }
  }
}

// The secant step law pays more than was put in: said, with the time and the way out. Its energy form does not.
TEST(EnergyGain, SecantLawIsSaid) {
  const std::string step = "law = { kind = \"step\", threshold = 0.05, above_Pa = 9000 }\n";
  const RunSummary s = after_pulse(step);
  EXPECT_EQ(s.end, End::finished);
  ASSERT_TRUE(s.energy_gain && s.energy_gain->any());
  EXPECT_NEAR(s.energy_gain->began, 0.15, 0.1);
  EXPECT_GT(s.energy_gain->most, 2.0);
  EXPECT_NEAR(s.energy_gain->paid, 1.25e-3, 0.05e-3) << "the load's positive work";

  const std::string smooth =
      "law = { kind = \"step\", threshold = 0.05, above_Pa = 9000, width = 0.1 }\nlaw_form = \"energy\"\n";
  const RunSummary of_energy = after_pulse(smooth);
  EXPECT_FALSE(of_energy.energy_gain->any()) << said(of_energy);
}

// Energy without a bound ends the run with a status of its own.
TEST(EnergyGain, ARunawayEnds) {
  Variant v = pulse("");
  v.simulation.step = 1.02 * BuiltVariant(v, {}).simulation.stable_step();
  v.simulation.enforce_stability = false;
  const RunSummary s = run(v);
  EXPECT_EQ(s.end, End::stopped_energy) << word_of(s.end) << ": " << s.trouble;
  EXPECT_THAT(s.trouble, HasSubstr("ten times the energy that was put into it"));
  EXPECT_TRUE(std::isfinite(s.energies.kinetic));
  EXPECT_GT(s.energy_gain->most, 10.0);
}

// Without a ledger nothing is judged.
TEST(EnergyGain, NeedsTheLedger) {
  Variant v = test::parse(test::kSmallScene).variants.at(0);
  v.simulation.track_energies = false;
  EXPECT_FALSE(run(v).energy_gain.has_value());
}

}  // namespace
}  // namespace glisson::energy_gain_test
