// A body that stores and loses energy never holds more than was put into it; one that does is found out, with the time.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "glisson/simulation/energy_watch.h"
#include "support/must_step.h"

namespace glisson::energy_watch_test {
namespace {

using Of = EnergyGain::Of;

Energies ledger(double tools, double kinetic, double elastic) {
  Energies e;
  e.work_tools = tools, e.kinetic = kinetic, e.elastic = elastic;
  return e;
}

// Paid is what was there, all work that was done on the body, none that it did, and all that changes brought or took.
TEST(EnergyWatch, CountsWhatWasPaid) {
  EnergyWatch watch;
  Energies e;
  e.initial = -0.5;
  watch.see(0.0, e);
  e.work_tools = 2.0, e.work_loads = -1.0;
  watch.see(1.0, e);
  e.work_tools = 1.5, e.work_loads = 0.5;  // given back by the body; paid by the load
  watch.see(2.0, e);
  e.changed = -0.25, e.removed = 0.125;
  watch.see(3.0, e);
  EXPECT_DOUBLE_EQ(watch.gain().paid, 0.5 + 2.0 + 1.5 + 0.25 + 0.125);
  EXPECT_FALSE(watch.gain().any());
}

// Each of the three energies has its bound, 1 or 2 % beyond what a conservative body may hold, and the time is that of the first look.
TEST(EnergyWatch, SaysWhatWasMoreAndSinceWhen) {
  const auto seen = [](const Energies& e, std::optional<double> stored = {}) {
    EnergyWatch watch;
    watch.see(0.5, ledger(1.0, 0.9, 0.1));
    watch.see(1.5, e, stored);
    watch.see(2.5, e, stored);
    return watch.gain();
  };
  EXPECT_EQ(seen(ledger(1.0, 1.009, -0.009), 1.019).of, Of::none);
  EXPECT_EQ(seen(ledger(1.0, 1.011, 0.0)).of, Of::kinetic);
  EXPECT_EQ(seen(ledger(1.0, 0.5, -0.011)).of, Of::elastic);
  EXPECT_EQ(seen(ledger(1.0, 0.0, 1.0), 1.021).of, Of::stored);
  EXPECT_EQ(seen(ledger(1.0, 1.011, 0.0)).began, 1.5);
  EXPECT_DOUBLE_EQ(seen(ledger(1.0, 3.0, -2.0)).most, 3.0);
  EXPECT_EQ(seen(ledger(1.0, 0.5, 0.5)).began, -1.0);
}

// Beyond ten times the paid energy it runs away, kinetic or elastic.
TEST(EnergyWatch, KnowsARunaway) {
  for (const Energies& e : {ledger(1.0, 10.1, 0.0), ledger(1.0, 0.0, -10.1)}) {
    EnergyWatch watch;
    watch.see(0.0, ledger(1.0, 9.9, -9.9));
    EXPECT_FALSE(watch.runs_away());
    watch.see(1.0, e);
    EXPECT_TRUE(watch.runs_away());
  }
}

// Where nothing was paid, what is below the energy of a micro-strain is rounding.
TEST(EnergyWatch, RoundingIsNoGain) {
  Tissue tissue;
  tissue.youngs_modulus = 3000.0, tissue.poisson_ratio = 0.0;
  const Simulation body(box_mesh({.cells = {2, 2, 2}, .size = {0.1, 0.1, 0.1}}), {{0, tissue}});
  const double negligible = negligible_energy(body);
  EXPECT_NEAR(negligible, 0.5 * 3000.0 * 1e-3 * 1e-12, 1e-18);  // ½ E V ε²
  EnergyWatch watch(negligible);
  watch.see(0.0, ledger(0.0, 0.9 * negligible, 0.0));
  EXPECT_FALSE(watch.gain().any());
  watch.see(0.0, ledger(0.0, 1.1 * negligible, 0.0));
  EXPECT_TRUE(watch.gain().any());
}

Tissue small_tissue() {
  Tissue t;
  t.youngs_modulus = 3000.0, t.poisson_ratio = 0.3;
  return t;
}

/// A cube that is let go from a stretch, watched each step. @param stored  whether W(u) is looked at: at 0.9 h* it may be some percent
/// above what was paid, while the kinetic energy v(t−h/2)·v(t+h/2) of the highest modes is negative
EnergyGain let_go(const Tissue& tissue, const SimulationOptions& options, int steps, bool stored = false) {
  Simulation body(box_mesh({.cells = {2, 2, 3}, .size = {0.02, 0.02, 0.03}}), {{0, tissue}}, options);
  body.fix("z_min");
  std::vector<Vec3d> u, none(body.mesh().vertices.size());
  for (const Vec3d& x : body.mesh().vertices) u.push_back({0.02 * x.z, 0.0, 0.03 * x.z});
  body.set_state(u, none);
  EnergyWatch watch(negligible_energy(body));
  for (int i = 0; i < steps && !watch.runs_away(); ++i) {
    if (!body.step().made()) break;
    watch.see(body.force_time(), body.energies(), stored ? body.stored_energy() : std::nullopt);
  }
  return watch.gain();
}

// Stable steps of laws with an energy never hold more, in either precision and by every integrator that keeps inertia.
TEST(EnergyWatch, IsSilentForBodiesWithAnEnergy) {
  const Tissue small = small_tissue();
  Tissue turned = small, relaxing = small, rubber = small;
  turned.kinematics = Kinematics::corotational;
  relaxing.kinematics = Kinematics::corotational, relaxing.maxwell = {{0.5, 1e-6}};
  rubber.hyperelastic = NeoHookean{.mu = 1200.0, .bulk_modulus = 5000.0};
  for (const Tissue& tissue : {small, turned, relaxing, rubber}) {
    for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
      const EnergyGain gain = let_go(tissue, {.precision = precision}, 1000);
      EXPECT_FALSE(gain.any()) << word_of(gain.of) << " from " << gain.began << " s on, " << gain.most;
      EXPECT_GT(gain.most, 0.3) << "of the paid energy was seen to move";
    }
  }
  EXPECT_FALSE(let_go(small, {.integrator = Integrator::implicit, .step = 1e-3}, 200).any());
}

// Steps above the stable one are found out in the first hundredth of a second, long before numbers overflow.
TEST(EnergyWatch, FindsStepsThatAreUnstable) {
  const Tissue tissue = small_tissue();
  const double stable =
      Simulation(box_mesh({.cells = {2, 2, 3}, .size = {0.02, 0.02, 0.03}}), {{0, tissue}}, {}).stable_step();
  const EnergyGain gain = let_go(tissue, {.step = 1.3 * stable, .enforce_stability = false}, 3000, true);
  EXPECT_TRUE(gain.any());
  EXPECT_LT(gain.began, 0.2);
  EXPECT_GT(gain.most, EnergyWatch::kRunaway);
}

}  // namespace
}  // namespace glisson::energy_watch_test
