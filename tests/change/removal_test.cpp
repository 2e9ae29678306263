// Removing tets leaves the body that one would build without them: same masses, same forces.
#include "change/changed_body.h"
#include "support/must_step.h"

namespace glisson::test::removal_test {
namespace {

class Removal : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, Removal, testing::ValuesIn(every_kind()), kind_name);

constexpr double kCell = 0.004;

/// Six thousand tets in four submeshes, no two alike.
struct Body {
  std::mt19937 random{7};
  TetMesh mesh = jittered_box({10, 10, 10}, kCell, 0.2, random);
  Tissues tissues;
  SimulationOptions options;
  double tolerance;
  Simulation simulation;

  explicit Body(const Kind& kind, SimulationOptions o)
      : tissues{{0, kind.tissue}}, options(o), tolerance(kind.tolerance()), simulation(mesh, tissues, options) {}
  explicit Body(const Kind& kind) : Body(kind, kind.options()) {}
  void expect_as_built_anew() {
    test::expect_as_built_anew(simulation, tissues, options, random_state(simulation.mesh(), kCell, random), tolerance);
  }
};

// Tets here and there, in one call after the other, some of them named again.
TEST_P(Removal, OfTetsHereAndThere) {
  Body body(GetParam());
  std::size_t gone = 0;
  for (const std::size_t count : {1U, 5U, 20U, 100U, 400U}) {
    const std::vector<std::uint32_t> tets = choose(count, body.mesh.tets.size(), body.random);
    gone += body.simulation.remove_tets(tets).tets;
    for (const std::uint32_t t : tets) EXPECT_TRUE(body.simulation.is_removed(t));
    EXPECT_EQ(body.simulation.present_mesh().tets.size(), body.mesh.tets.size() - gone);
    EXPECT_EQ(body.simulation.remove_tets(tets).tets, 0U);
    body.expect_as_built_anew();
  }
}

// A compact hole through several submeshes leaves loose vertices: they are told, stay where they are, and weigh nothing.
TEST_P(Removal, OfAHoleLeavesLooseVertices) {
  Body body(GetParam());
  const auto in_hole = [](const Vec3d& x) { return norm(x - Vec3d{0.02, 0.02, 0.02}) < 0.012; };
  const RemovalReport report = body.simulation.remove_tets(tets_where(body.mesh, in_hole));
  ASSERT_GT(report.loose_vertices.size(), 20U);
  body.expect_as_built_anew();

  const FieldState before = state_of(body.simulation);
  for (int i = 0; i < 10; ++i) test::must_step(body.simulation);
  std::vector<char> loose(body.mesh.vertices.size(), 0);
  for (const std::uint32_t v : report.loose_vertices) loose[v] = 1;
  for (std::size_t v = 0; v < loose.size(); ++v) {
    EXPECT_EQ(body.simulation.masses()[v] == 0.0, loose[v] != 0);
    if (loose[v] == 0) continue;
    EXPECT_EQ(body.simulation.displacement()[v], before.u[v]);
  }
}

// Half of the body, whole submeshes and cut ones, and then all of it: no force is left and no mass.
TEST_P(Removal, OfHalfAndOfAll) {
  Body body(GetParam());
  body.simulation.remove_tets(tets_where(body.mesh, [](const Vec3d& x) { return x.x + 0.5 * x.y < 0.03; }));
  body.expect_as_built_anew();
  const RemovalReport rest = body.simulation.remove_tets(tets_where(body.mesh, [](const Vec3d&) { return true; }));
  EXPECT_EQ(body.simulation.present_mesh().tets.size(), 0U);
  EXPECT_GT(rest.tets, 1000U);
  EXPECT_EQ(mass(body.simulation), 0.0);
  const FieldState state = random_state(body.mesh, kCell, body.random);
  body.simulation.set_state(state.u, state.v);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(body.simulation.step().status, StepStatus::ok);
  for (std::size_t v = 0; v < state.u.size(); ++v) EXPECT_EQ(body.simulation.displacement()[v], state.u[v]);
}

// Tets of several tissues, side by side and mixed, a region that vanishes included.
TEST_P(Removal, FromBodiesOfSeveralTissues) {
  std::mt19937 random(3);
  TetMesh mesh = jittered_box({8, 8, 8}, kCell, 0.2, random);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) mesh.regions.push_back(t < 900 ? 4 : static_cast<int>(t % 3));
  Tissue hard = GetParam().tissue;
  hard.youngs_modulus *= 4.0;
  hard.density = 1300.0;
  const Tissues tissues{{0, GetParam().tissue}, {1, linear_tissue()}, {2, law_tissue()}, {4, hard}};
  Simulation simulation(mesh, tissues, GetParam().options());
  for (const std::size_t count : {10U, 300U}) {
    simulation.remove_tets(choose(count, mesh.tets.size(), random));
    const FieldState state = random_state(mesh, kCell, random);
    expect_as_built_anew(simulation, tissues, GetParam().options(), state, GetParam().tolerance());
  }
  std::vector<std::uint32_t> region(900);
  std::iota(region.begin(), region.end(), 0U);
  simulation.remove_tets(region);
  const FieldState state = random_state(mesh, kCell, random);
  expect_as_built_anew(simulation, tissues, GetParam().options(), state, GetParam().tolerance());
}

// The present mesh has a region and a fibre for each tet that is left, its own.
TEST(PresentMesh, KeepsWhatBelongsToItsTets) {
  TetMesh mesh = box_mesh({.cells = {2, 2, 2}});
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    mesh.regions.push_back(static_cast<int>(t));
    mesh.fibres.push_back({1.0, static_cast<double>(t), 0.0});
  }
  std::map<int, Tissue> tissues;
  for (const int region : mesh.regions) tissues[region] = {};
  Simulation simulation(mesh, tissues);
  simulation.remove_tets(std::vector<std::uint32_t>{0, 5});
  const TetMesh present = simulation.present_mesh();
  ASSERT_EQ(present.tets.size(), mesh.tets.size() - 2);
  ASSERT_EQ(present.fibres.size(), present.tets.size());
  EXPECT_EQ(present.regions.front(), 1);
  EXPECT_EQ(present.fibres.front().y, 1.0);
  EXPECT_EQ(present.fibres[4].y, 6.0);
}

}  // namespace
}  // namespace glisson::test::removal_test
