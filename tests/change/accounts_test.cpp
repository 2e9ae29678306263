// What leaves with removed tets is accounted for: mass, momentum, energy; and the balance stays exact while it moves.
#include "change/changed_body.h"
#include "element/body.h"
#include "element/tet_fields.h"
#include "glisson/instruments/motion.h"

namespace glisson::test {
namespace {

class Accounts : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, Accounts, testing::ValuesIn(every_kind()), kind_name);

constexpr double kCell = 0.01;

/// The paper's body under gravity, load and tool, shaking.
struct Shaken {
  std::mt19937 random{5};
  TetMesh mesh = jittered_box({4, 4, 8}, kCell, 0.2, random);
  Simulation simulation;

  explicit Shaken(const Kind& kind) : simulation(mesh, {{0, kind.tissue}}, options(kind)) {
    simulation.fix(mesh.vertex_sets.at("z_min"));
    simulation.drive(paper_triangle(), press({.velocity = 0.05, .depth = 0.01, .hold = 0.1, .returns = true}));
    simulation.add_load(mesh.vertex_sets.at("x_max"), {0.02, 0.0, 0.01}, [](double t) { return std::sin(20.0 * t); });
  }
  static SimulationOptions options(const Kind& kind) {
    SimulationOptions o = kind.options(std::nullopt);
    o.gravity = {0.0, 0.0, -9.81};
    o.gravity_ramp = 0.05;
    o.damping_rate = 5.0;
    o.nodal_damping = 1e-4;
    return o;
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) ASSERT_EQ(simulation.step().status, StepStatus::ok);
  }
  double volume_of(const std::vector<std::uint32_t>& tets) const {
    double sum = 0.0;
    for (const std::uint32_t t : tets) sum += six_rest_volume(mesh, t) / 6.0;
    return sum;
  }
  void expect_balance(const char* when) const {
    const Energies e = simulation.energies();
    const double scale = std::abs(e.elastic) + std::abs(e.dissipated) + std::abs(e.kinetic) + std::abs(e.removed);
    EXPECT_LE(std::abs(e.imbalance()), 1e-10 * scale) << when << ": " << e.imbalance() << " J of " << scale;
  }
};

// Mass is density times volume, momentum that of the tets' shares; what stays has the rest of both.
TEST_P(Accounts, MassAndMomentumLeaveWithTheTets) {
  Shaken body(GetParam());
  body.run(100);
  const std::vector<std::uint32_t> tets = choose(60, body.mesh.tets.size(), body.random);
  const double mass_before = mass(body.simulation);
  const Vec3d momentum_before = momentum(body.simulation);
  const RemovalReport report = body.simulation.remove_tets(tets);
  EXPECT_EQ(report.tets, 60U);
  EXPECT_NEAR(report.mass, GetParam().tissue.density * body.volume_of(tets), 1e-14 * mass_before);
  EXPECT_NEAR(mass(body.simulation) + report.mass, mass_before, 1e-14 * mass_before);
  EXPECT_GT(norm(report.momentum), 0.0);
  EXPECT_LE(norm(momentum(body.simulation) + report.momentum - momentum_before), 1e-13 * norm(momentum_before));
}

// The balance is exact after each removal, before the next step and after it, until nothing is left.
TEST_P(Accounts, TheBalanceStaysExact) {
  Shaken body(GetParam());
  body.run(50);
  body.expect_balance("before");
  const std::vector<std::uint32_t> order = choose(body.mesh.tets.size(), body.mesh.tets.size(), body.random);
  double removed = body.simulation.energies().removed;
  EXPECT_EQ(removed, 0.0);
  for (std::size_t i = 0; i < order.size(); i += 32) {
    const RemovalReport report = body.simulation.remove_tets(std::span(order).subspan(i, 32));
    EXPECT_NEAR(body.simulation.energies().removed - removed, report.energy, 1e-12 * std::abs(removed + report.energy));
    removed = body.simulation.energies().removed;
    body.expect_balance("removed");
    body.run(1);
    body.expect_balance("a step later");
    body.run(10);
    body.expect_balance("ten steps later");
  }
  EXPECT_EQ(mass(body.simulation), 0.0);
  EXPECT_EQ(body.simulation.energies().kinetic, 0.0);
}

// Energies are those of what is left: for a linear tissue at rest the stored energy and what has gone are the whole.
TEST(AccountsOfLinear, RemovedEnergyIsWhatWasStored) {
  std::mt19937 random(2);
  const TetMesh mesh = jittered_box({4, 4, 4}, kCell, 0.2, random);
  const Body rest = build_body(mesh, {{0, linear_tissue()}});
  SimulationOptions options = in_double();
  options.step = kProbeStep;
  Simulation simulation(mesh, {{0, linear_tissue()}}, options);
  FieldState state = random_state(mesh, kCell, random);
  simulation.set_state(state.u, state.v);
  const double whole = simulation.energies().initial;
  double kinetic = 0.0;
  for (std::size_t i = 0; i < state.v.size(); ++i) kinetic += 0.5 * rest.masses[i] * dot(state.v[i], state.v[i]);
  EXPECT_NEAR(whole, secant_energy(rest, state.u) + kinetic, 1e-13 * whole);
  double removed = 0.0;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) removed += simulation.remove_tets({&t, 1}).energy;
  EXPECT_NEAR(removed, whole, 1e-12 * whole);
  EXPECT_NEAR(simulation.energies().elastic, 0.0, 1e-12 * whole);
  EXPECT_NEAR(simulation.energies().kinetic, 0.0, 1e-12 * whole);
}

// A tool's force is that of the last step, whatever is removed after it.
TEST_P(Accounts, ForcesStayThoseOfTheLastStep) {
  Shaken body(GetParam());
  body.run(100);
  const ForceParts support = body.simulation.force({0}), tool = body.simulation.force({1});
  body.simulation.remove_tets(choose(300, body.mesh.tets.size(), body.random));
  EXPECT_EQ(body.simulation.force({0}).total(), support.total());
  EXPECT_EQ(body.simulation.force({1}).total(), tool.total());
}

}  // namespace
}  // namespace glisson::test
