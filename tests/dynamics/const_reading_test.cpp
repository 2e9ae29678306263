// Two threads may read one const simulation: each reads what a thread alone would.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "glisson/mesh.h"
#include "glisson/simulation/simulation.h"
#include "support/must_step.h"

namespace glisson {
namespace {

/// All that const members tell, as bytes.
std::string all_of(const Simulation& simulation, ConstraintId bottom) {
  std::ostringstream out;
  out.precision(17);
  const auto put = [&](const Vec3d& v) { out << v.x << ' ' << v.y << ' ' << v.z << '\n'; };
  for (const Vec3d& u : simulation.displacement()) put(u);
  for (const Vec3d& v : simulation.velocity()) put(v);
  for (const Vec3d& x : simulation.positions()) put(x);
  put(simulation.force(bottom).total());
  put(simulation.torque(bottom, {}));
  const Energies energies = simulation.energies();
  out << energies.elastic << ' ' << energies.kinetic << ' ' << simulation.stored_energy().value_or(-1.0) << '\n';
  out << simulation.step_size() << ' ' << simulation.stable_step() << ' ' << simulation.next_corner(0.0) << '\n';
  for (const LimitingTet& tet : simulation.limiting_tets()) out << tet.tet << '\n';
  for (const double p : simulation.tet_fields().stress) out << p << '\n';
  for (const double p : simulation.contact_fields().pressure) out << p << '\n';
  out << simulation.present_mesh().tets.size() << ' ' << simulation.state_hash() << ' '
      << simulation.save_state().time();
  std::ostringstream saved;
  simulation.save(saved);
  return out.str() + saved.str();
}

/// Two threads read a simulation after each of a few steps.
void expect_same_for_two(Simulation& simulation, ConstraintId bottom) {
  const Simulation& read = simulation;
  const std::string alone = all_of(read, bottom);
  for (int round = 0; round < 3; ++round) {
    test::must_step(simulation);  // what was filled for the last state is stale
    std::array<std::string, 2> seen;
    std::atomic<int> ready{0};
    std::vector<std::thread> threads;
    for (std::string& text : seen) {
      threads.emplace_back([&] {
        ++ready;
        while (ready < 2) {
        }
        text = all_of(read, bottom);
      });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(seen[0], all_of(read, bottom));
    EXPECT_EQ(seen[0], seen[1]);
    EXPECT_NE(seen[0], alone);
  }
}

class ConstReading : public testing::TestWithParam<Integrator> {};

TEST_P(ConstReading, TwoThreadsReadTheSame) {
  const TetMesh mesh = box_mesh({.cells = {4, 4, 4}, .size = {0.04, 0.04, 0.04}});
  Tissue tissue;
  tissue.youngs_modulus = 3000.0;
  tissue.viscosity = 1.0;
  SimulationOptions options;
  options.integrator = GetParam();
  if (GetParam() == Integrator::implicit) options.step = 1e-3;
  options.gravity = {0, 0, -9.81};
  options.threads = 1;
  Simulation simulation(mesh, {{0, tissue}}, options);
  const ConstraintId bottom = simulation.fix(mesh.vertex_sets.at("z_min"));
  for (int i = 0; i < 5; ++i) test::must_step(simulation);
  expect_same_for_two(simulation, bottom);
}

// The same of a body that has lost tets, whose layout is written, with branches and precision that follows the deformation.
TEST(ConstReadingOfChanges, TwoThreadsReadTheSame) {
  const TetMesh mesh = box_mesh({.cells = {4, 4, 4}, .size = {0.04, 0.04, 0.04}});
  Tissue tissue;
  tissue.hyperelastic = Ogden{.mu = {1786.0}, .alpha = {4.0}, .bulk_modulus = 8333.0};
  tissue.maxwell = {{.share = 0.3, .time = 0.01}};
  SimulationOptions options;
  options.precision = Precision::adaptive;
  options.gravity = {0, 0, -9.81};
  options.threads = 1;
  Simulation simulation(mesh, {{0, tissue}}, options);
  const ConstraintId bottom = simulation.fix(mesh.vertex_sets.at("z_min"));
  for (int i = 0; i < 5; ++i) test::must_step(simulation);
  simulation.remove_tets(std::array<std::uint32_t, 3>{200, 201, 202});
  for (int i = 0; i < 5; ++i) test::must_step(simulation);
  expect_same_for_two(simulation, bottom);
}

INSTANTIATE_TEST_SUITE_P(Integrators, ConstReading,
                         testing::Values(Integrator::central_difference, Integrator::semi_implicit,
                                         Integrator::implicit),
                         [](const auto& made) { return std::string(word_of(made.param)); });

}  // namespace
}  // namespace glisson
