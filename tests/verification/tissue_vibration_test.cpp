// A body of a conservative law that vibrates freely keeps its energy.
//
// The explicit scheme is symplectic: its energy does not drift, but swings by some (h/h*)² as the motion passes from
// long waves to short ones. A fortieth of h* leaves the law alone to be seen.
// Kinetic energy is the scheme's own, ½ Σ m v(t − h/2)·v(t + h/2); elastic energy is that of the law, not the work
// the simulation has counted.
#include <gtest/gtest.h>

#include <algorithm>

#include "element/tissue_operator.h"
#include "material/every_tissue.h"
#include "support/bodies.h"

namespace glisson {
namespace {

std::vector<Tissue> conservative_tissues() {
  std::vector<Tissue> all = test::hyperelastic_tissues();
  for (const Tissue& t : test::carriers()) {
    if (!t.hyperelastic) all.push_back(t);
  }
  for (const Tissue& t : test::fibre_tissues()) all.push_back(t);
  for (Tissue t : test::carriers()) {
    t.volume_change = VolumeChange::average_nodal, t.law = ConstantLaw{}, t.law_form = LawForm::secant;
    t.name += " nodal";
    all.push_back(t);
  }
  return all;
}

/// A bar held at one end, let go bent and stretched by some 15 %.
struct Drift {
  double swing, drift;  ///< over the energy at the start
};
Drift drift_of(const Tissue& tissue, int steps) {
  const TetMesh mesh = box_mesh({.cells = {1, 1, 3}, .size = {0.01, 0.01, 0.03}, .split = BoxSplit::alternating});
  const Body body = build_body(mesh, {{0, tissue}});
  const TissueOperator op(body);
  SimulationOptions options = test::in_double();
  options.step = 0.025 * Simulation(mesh, {{0, tissue}}, options).stable_step();
  Simulation simulation(mesh, {{0, tissue}}, options);
  simulation.fix(mesh.vertex_sets.at("z_min"));
  std::vector<Vec3d> u;
  for (const Vec3d& x : mesh.vertices) u.push_back({2.0 * x.z * x.z, -0.05 * x.z, 0.1 * x.z + 0.1 * x.x * x.z / 0.01});
  simulation.set_state(u, std::vector<Vec3d>(u.size()));
  double first = 0.0, last = 0.0, low = 1e300, high = 0.0;
  const int tenth = steps / 10;
  for (int n = 0; n < steps; ++n) {
    u.assign(simulation.displacement().begin(), simulation.displacement().end());
    EXPECT_EQ(simulation.step().status, StepStatus::ok);
    const double energy = simulation.energies().kinetic + op.energy(u);
    low = std::min(low, energy), high = std::max(high, energy);
    if (n < tenth) first += energy / tenth;
    if (n >= steps - tenth) last += energy / tenth;
  }
  return {(high - low) / first, (last - first) / first};
}

class FreeVibration : public testing::TestWithParam<Tissue> {};

// Means over the first and the last tenth of 60,000 steps, some 480 periods of the shortest waves, differ by less than
// 1e-4. 6e-5 was measured at most, and some ten times as much at four times the step: it is the scheme's, not the law's.
TEST_P(FreeVibration, KeepsItsEnergy) {  // long
  const Drift d = drift_of(GetParam(), 60000);
  RecordProperty("drift", std::to_string(1e6 * d.drift) + "e-6, swing " + std::to_string(1e6 * d.swing) + "e-6");
  EXPECT_LT(std::abs(d.drift), 1e-4);
  EXPECT_LT(d.swing, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Conservative, FreeVibration, testing::ValuesIn(conservative_tissues()), [](const auto& p) {
  std::string name = p.param.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

// A secant law is not conservative, and the same test sees it.
TEST(FreeVibrationOfASecantLaw, Drifts) {  // long
  Tissue t;
  t.youngs_modulus = 3000.0, t.law = LinearLaw{4000.0};
  const Drift d = drift_of(t, 60000);
  RecordProperty("drift_percent", std::to_string(100.0 * d.drift));
  EXPECT_GT(std::abs(d.drift), 1e-3);
}

}  // namespace
}  // namespace glisson
