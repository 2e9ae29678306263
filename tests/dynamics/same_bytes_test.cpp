// The same run gives the same bytes: again, beside others on other threads, and in pieces.
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "glisson/instruments/motion.h"
#include "support/bodies.h"
#include "support/must_step.h"

namespace glisson {
namespace {

/// A viscous, stiffening tissue of two regions under a press, gravity and damping.
Simulation busy_body(SimulationOptions options, TetMesh mesh = test::paper_mesh()) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) mesh.regions.push_back(t % 5 == 0 ? 1 : 0);
  Tissue soft, hard;
  soft.viscosity = 2.0;
  soft.law = LinearLaw{20000.0};
  hard.youngs_modulus = 20000.0;
  hard.law = ExponentialLaw{.amplitude = 500.0, .rate = 6.0};
  options.gravity = {0.0, 0.0, -9.81};
  options.damping_rate = 5.0;
  Simulation simulation(mesh, {{0, soft}, {1, hard}}, options);
  simulation.fix(mesh.vertex_sets.at("z_min"));
  simulation.drive(test::paper_triangle(), press({.velocity = 0.05, .depth = 0.01, .hold = 1.0}));
  return simulation;
}

std::uint64_t hash_after(int steps, Simulation simulation) {
  for (int i = 0; i < steps; ++i) test::must_step(simulation);
  return simulation.state_hash();
}
SimulationOptions in(Precision precision) {
  SimulationOptions options;
  options.precision = precision;
  return options;
}
std::uint64_t hash_after(int steps, Precision precision) { return hash_after(steps, busy_body(in(precision))); }

class SameBytes : public testing::TestWithParam<Precision> {};

// Run to run, in one process.
TEST_P(SameBytes, RunToRun) { EXPECT_EQ(hash_after(500, GetParam()), hash_after(500, GetParam())); }

// On 2, 4 and 8 threads that each run their own body side by side.
TEST_P(SameBytes, BesideOtherThreads) {
  const std::uint64_t alone = hash_after(300, GetParam());
  for (const std::size_t threads : {2U, 4U, 8U}) {
    std::vector<std::uint64_t> hashes(threads);
    {
      std::vector<std::jthread> workers;
      for (std::uint64_t& hash : hashes) workers.emplace_back([&hash] { hash = hash_after(300, GetParam()); });
    }
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, alone) << threads << " threads";
  }
}

// Reading forces, energies and fields between steps changes nothing.
TEST_P(SameBytes, WatchedOrNot) {
  Simulation watched = busy_body(in(GetParam()));
  for (int i = 0; i < 300; ++i) {
    test::must_step(watched);
    watched.tet_fields();
    watched.positions();
    watched.force({1});
    watched.energies();
  }
  EXPECT_EQ(watched.state_hash(), hash_after(300, GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Precisions, SameBytes,
                         testing::Values(Precision::single_precision, Precision::double_precision),
                         [](const testing::TestParamInfo<Precision>& p) {
                           return std::string(p.param == Precision::single_precision ? "single" : "double");
                         });

// On one to eight threads of its own, whether energies are kept or not; the body has several submeshes.
TEST(SameBytesOnThreads, OneToEight) {  // long
  const TetMesh mesh = box_mesh({.cells = {9, 9, 18}, .size = {0.04, 0.04, 0.08}});
  SimulationOptions options;
  for (const bool track_energies : {false, true}) {
    options.track_energies = track_energies;
    const auto hash = [&](int threads) {
      options.threads = threads;
      Simulation simulation = busy_body(options, mesh);
      EXPECT_EQ(simulation.engine_info().threads, threads);
      EXPECT_GT(simulation.engine_info().submeshes, 4U);
      return hash_after(50, std::move(simulation));
    };
    const std::uint64_t one = hash(1);
    for (int threads = 2; threads <= 8; ++threads) EXPECT_EQ(hash(threads), one) << threads << " threads";
  }
}

Tissue branching() {
  Tissue tissue;
  tissue.kinematics = Kinematics::corotational, tissue.poisson_ratio = 0.45, tissue.viscosity = 2.0;
  tissue.maxwell.push_back({.share = 0.3, .time = 0.05});
  return tissue;
}

// Long steps share the elements out, too: forces, tangents by derivatives and definite ones, with branches and viscosity.
TEST(SameBytesOnThreads, InLongSteps) {
  const TetMesh mesh = box_mesh({.cells = {5, 5, 6}, .size = {0.04, 0.04, 0.05}});
  const auto hash = [&](Integrator integrator, int threads) {
    SimulationOptions options;
    options.integrator = integrator, options.threads = threads, options.step = 0.01;
    Simulation simulation(mesh, {{0, branching()}}, options);
    simulation.fix("z_min");
    simulation.drive("z_max", press({.velocity = 0.2, .depth = 0.02, .hold = 1.0}));
    EXPECT_EQ(simulation.engine_info().threads, threads);
    return hash_after(8, std::move(simulation));
  };
  for (const Integrator integrator : {Integrator::implicit, Integrator::quasi_static}) {
    const std::uint64_t one = hash(integrator, 1);
    for (const int threads : {2, 3, 8}) EXPECT_EQ(hash(integrator, threads), one) << threads << " threads";
  }
}

}  // namespace
}  // namespace glisson
