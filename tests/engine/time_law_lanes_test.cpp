// Branches whose times follow the deformation in lanes: a body is what its material point is, a law that does nothing leaves
// the plain branches, the stable step holds however fast a branch becomes, and a run goes on from a checkpoint with its bytes.
#include <gtest/gtest.h>

#include <sstream>

#include "engine/engine_run.h"
#include "glisson/material_point.h"
#include "glisson/simulation/simulation.h"
#include "material/every_tissue.h"
#include "support/must_step.h"

namespace glisson::time_law_lanes_test {
namespace {

std::vector<Tissue> following_tissues() {
  std::vector<Tissue> all = test::maxwell_tissues();
  std::erase_if(all, [](const Tissue& t) { return !t.relaxation_follows(); });
  return all;
}

Mat3d mean_piola(const Simulation& body, std::size_t tets) {
  const TetFields fields = body.tet_fields();
  Mat3d mean{};
  for (std::size_t e = 0; e < tets; ++e) {
    for (std::size_t i = 0; i < 9; ++i) mean(i / 3, i % 3) += fields.piola[9 * e + i] / static_cast<double>(tets);
  }
  return mean;
}

// A cube all of whose vertices are led through shear and stretch, to and fro, in float: the stress of its tets is that of the
// material point, of which the test of the equation knows that it is its solution. 1e-5 of the largest stress: the end is without
// strain, where only what the branches hold is left.
TEST(TimeLawLanes, ABodyIsItsMaterialPoint) {
  constexpr double kSpeed = 1.5, kEnd = 0.12;
  constexpr int kSteps = 2400;
  const TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
  const auto amount = [](double t) { return kSpeed * std::min(t, 0.9 * (kEnd - t)); };
  for (Tissue tissue : following_tissues()) {
    tissue.density = 1e6;  // all vertices are led: inertia moves nothing, and the stable step is long
    tissue.maxwell[0].time = 0.2, tissue.maxwell[1].time = 0.4;
    MaterialPoint point(tissue);
    double largest = 0.0;
    Simulation body(mesh, {{0, tissue}}, {.step = kEnd / kSteps});
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      const std::array<std::uint32_t, 1> one{v};
      body.drive(one, [&mesh, amount, v](double t) {
        const Vec3d& x = mesh.vertices[v];
        return Vec3d{0.5 * amount(t) * x.x + amount(t) * x.z, 0.0, -0.4 * amount(t) * x.z};
      });
    }
    for (int k = 1; k <= kSteps; ++k) {
      test::must_step(body);
      const double a = amount(kEnd * k / kSteps);
      MaterialTargets targets;
      targets(0, 0).value = 1.0 + 0.5 * a, targets(0, 2).value = a, targets(2, 2).value = 1.0 - 0.4 * a;
      ASSERT_TRUE(point.advance(kEnd / kSteps, targets).converged);
      largest = std::max(largest, test::size_of(point.state().nominal));
      if (k % 600 != 0) continue;
      const Mat3d apart = test::difference(mean_piola(body, mesh.tets.size()), point.state().nominal);
      EXPECT_LE(test::size_of(apart), 1e-5 * largest) << tissue.name << ", step " << k;
    }
  }
}

/// A jittered cube of one tissue in free vibration about a random state.
struct Vibration {
  TetMesh mesh;
  Tissue tissue;
  std::vector<Vec3d> u, v;
  explicit Vibration(const Tissue& t) : tissue(t) {
    std::mt19937 random(11);
    mesh = test::jittered_box({3, 3, 3}, 0.01, 0.2, random);
    u = test::random_field(mesh.vertices.size(), 0.0005, random);
    v = test::random_field(mesh.vertices.size(), 0.02, random);
  }
  Simulation start(SimulationOptions options = {}) const {
    Simulation s(mesh, {{0, tissue}}, options);
    s.set_state(u, v);
    return s;
  }
};

double distance(const Simulation& a, const Simulation& b, std::size_t vertices) {
  double apart = 0.0, size = 0.0;
  for (std::uint32_t i = 0; i < vertices; ++i) {
    apart += norm(a.displacement()[i] - b.displacement()[i]);
    size += norm(b.displacement()[i]);
  }
  return apart / size;
}

// A rate and an exponent of 0: the motion is that of the plain branches, whose memory is kept in another way, up to (h/τ)²/12,
// 5e-7 here, and the rounding of 600 steps.
TEST(TimeLawLanes, ConstantLawIsThePlainBranch) {
  for (const Tissue& plain : test::maxwell_tissues()) {
    if (plain.relaxation_follows()) continue;
    Tissue t = plain;
    t.maxwell[0].time = 0.02, t.maxwell[1].time = 0.3;
    const Vibration is(t);
    t.maxwell[0].time_law = ExponentialTime{.rate = 0.0};
    t.maxwell[1].time_law = PowerTime{.exponent = 0.0};
    const Vibration was(t);
    Simulation a = is.start({.step = 5e-5}), b = was.start({.step = 5e-5});
    for (int n = 0; n < 600; ++n) test::must_step(a), test::must_step(b);
    EXPECT_LE(distance(b, a, is.u.size()), 2e-5) << t.name;
  }
}

/// Tissues whose elastic part has an energy after long times too.
std::vector<Tissue> conservative() {
  std::vector<Tissue> all;
  for (const Kinematics k : test::all_of<Kinematics>()) {
    Tissue t;
    t.youngs_modulus = 3000.0, t.kinematics = k, t.maxwell_part = MaxwellPart::all, t.name = test::name_of(k);
    all.push_back(t);
  }
  Tissue t;
  t.hyperelastic = NeoHookean{.mu = 1000.0, .bulk_modulus = 6000.0}, t.name = "neo-Hookean";
  all.push_back(t);
  all.back().maxwell_part = MaxwellPart::all;
  return all;
}

// Times that fall by the deformation to a thousandth of the step, and times that rise from there: by the step that the engine
// chooses, the branches take energy from a free vibration at all times and give none, and it is a part of what there was.
TEST(TimeLawLanes, TheStableStepHolds) {  // long
  for (Tissue t : conservative()) {
    for (const TimeLaw& law : std::initializer_list<TimeLaw>{
             ExponentialTime{.rate = -300.0, .least = 1e-6}, ExponentialTime{.rate = 300.0, .most = 1e6},
             PowerTime{.exponent = 3.0, .reference = 0.05, .least = 1e-6, .most = 1e6},
             PowerTime{.exponent = -3.0, .reference = 0.05, .least = 1e-6, .most = 1e6}}) {
      for (const double time : {1e-4, 1e-2}) {
        t.maxwell = {{.share = 0.6, .time = time, .time_law = law}, {.share = 0.3, .time = 1.0, .time_law = law}};
        const Vibration is(t);
        Simulation s = is.start({.track_energies = true});
        for (int n = 0; n < 3000; ++n) {
          test::must_step(s);
          const Energies e = s.energies();
          ASSERT_GT(e.maxwell, -1e-3 * e.initial) << t.name << ", " << law_name(law) << ", " << time << ", step " << n;
          ASSERT_LT(e.kinetic, e.initial) << t.name << ", " << law_name(law) << ", " << time << ", step " << n;
        }
        EXPECT_GT(s.energies().maxwell, 0.05 * s.energies().initial) << t.name;
      }
    }
  }
}

// A body pressed, held and let go: what its tools gave is stored, moving or lost to branches, step by step, and what the
// branches have taken when all is at rest again was lost.
TEST(TimeLawLanes, ACycleKeepsItsEnergyLedger) {  // long
  Tissue t;
  t.hyperelastic = NeoHookean{.mu = 1500.0, .bulk_modulus = 8000.0};
  t.maxwell_part = MaxwellPart::deviator;
  t.maxwell = {{0.5, 0.02, PowerTime{.exponent = 1.0, .reference = 0.1, .least = 0.05}},
               {0.3, 0.05, ExponentialTime{.rate = 8.0}}};
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    Simulation body(box_mesh({.cells = {3, 3, 3}, .size = {0.03, 0.03, 0.03}}), {{0, t}},
                    {.step = 1e-4, .precision = precision, .track_energies = true});
    body.fix("z_min");
    body.drive("z_max", [](double time) {
      const double a = time < 0.1 ? time / 0.1 : (time < 0.15 ? 1.0 : std::max(0.0, 1.0 - (time - 0.15) / 0.1));
      return Vec3d{0.0, 0.0, -0.008 * a};
    });
    double most = 0.0;
    while (body.time() < 0.6) {
      test::must_step(body);
      most = std::max(most, body.stored_energy().value());
    }
    const Energies e = body.energies();
    EXPECT_GT(e.maxwell, 0.1 * most);
    EXPECT_LT(body.stored_energy().value() + e.kinetic, 0.02 * most);
    EXPECT_LT(std::abs(body.energy_drift().value()), 2e-3 * most);
  }
}

// Saved in the middle of a motion and read back, a run goes on with the same bytes, in lanes, in double and implicit.
TEST(TimeLawLanes, GoesOnFromACheckpoint) {
  Tissue t = following_tissues().front();
  const Vibration is(t);
  for (const SimulationOptions& options :
       std::initializer_list<SimulationOptions>{{.step = 1e-4},
                                                {.step = 1e-4, .precision = Precision::double_precision},
                                                {.integrator = Integrator::implicit, .step = 1e-3}}) {
    Simulation whole = is.start(options);
    for (int n = 0; n < 10; ++n) test::must_step(whole);
    std::stringstream saved;
    whole.save(saved);
    Simulation later(is.mesh, {{0, t}}, options);
    later.load(saved);
    for (int n = 0; n < 10; ++n) test::must_step(whole), test::must_step(later);
    EXPECT_EQ(whole.state_hash(), later.state_hash());
  }
}

}  // namespace
}  // namespace glisson::time_law_lanes_test
