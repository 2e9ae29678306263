// Fields of some tets, computed apart from the simulation, are those that the simulation has at the same instant.
#include "glisson/simulation/part_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <vector>

#include "glisson/simulation/simulation.h"

namespace glisson::part_fields_test {
namespace {

Tissue rubber(VolumeChange volume_change) {
  return {.youngs_modulus = 3000.0,
          .poisson_ratio = 0.4,
          .viscosity = 2.0,
          .maxwell = {{.share = 0.5, .time = 0.02}, {.share = 0.2, .time = 0.1}},
          .volume_change = volume_change};
}

/// Two regions, of which the upper one has branches and Kelvin-Voigt's viscosity.
struct Body {
  explicit Body(VolumeChange volume_change) : mesh(box_mesh({.cells = {3, 3, 4}, .size = {0.03, 0.03, 0.04}})) {
    for (const Tet& tet : mesh.tets) mesh.regions.push_back(mesh.vertices[tet[0]].z < 0.02 ? 1 : 2);
    tissues = {{1, Tissue{.youngs_modulus = 5000.0, .poisson_ratio = 0.3}}, {2, rubber(volume_change)}};
    simulation.emplace(mesh, tissues, SimulationOptions{});
    simulation->fix("z_min");
    std::vector<Vec3d> u;
    for (const Vec3d& x : mesh.vertices) u.push_back({x.z * x.x, -3.0 * x.y * x.z, -0.08 * x.z});
    simulation->set_state(u, std::vector<Vec3d>(u.size()));
    go(20);
  }
  void go(int steps) {
    for (int i = 0; i < steps; ++i) ASSERT_TRUE(simulation->step().made());
  }
  TetFields part(const std::vector<std::uint32_t>& tets, const BranchRecord& record) const {
    return PartFields(mesh, tissues, tets).fields(simulation->displacement(), simulation->velocity(), record);
  }

  TetMesh mesh;
  std::map<int, Tissue> tissues;
  std::optional<Simulation> simulation;
};

/// Every fifth, from the last on: of both regions, in no order of the mesh.
std::vector<std::uint32_t> some_tets(const TetMesh& mesh) {
  std::vector<std::uint32_t> tets;
  for (std::size_t t = mesh.tets.size(); t > 5; t -= 5) tets.push_back(static_cast<std::uint32_t>(t - 1));
  return tets;
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double x : values) most = std::max(most, std::abs(x));
  return most;
}

/// How far a field of some tets is from that of all, over the largest number.
double apart(const std::vector<double>& part, const std::vector<double>& all, const std::vector<std::uint32_t>& tets,
             std::size_t numbers) {
  double most = 0.0;
  for (std::size_t i = 0; i < tets.size(); ++i) {
    for (std::size_t k = 0; k < numbers; ++k)
      most = std::max(most, std::abs(part[numbers * i + k] - all[numbers * tets[i] + k]));
  }
  return most / largest(all);
}

class PartOfABody : public testing::TestWithParam<VolumeChange> {};

// The same sums in the same order, but for shared volumes, whose tets come in another order: rounding.
TEST_P(PartOfABody, HasTheFieldsOfTheWhole) {
  const Body body(GetParam());
  const std::vector<std::uint32_t> tets = some_tets(body.mesh);
  const TetFields all = body.simulation->tet_fields(), part = body.part(tets, BranchRecord(*body.simulation));
  ASSERT_EQ(part.q.size(), tets.size());
  ASSERT_EQ(part.stress.size(), 6 * tets.size());
  EXPECT_LT(apart(part.q, all.q, tets, 1), 1e-14);
  EXPECT_LT(apart(part.s, all.s, tets, 1), 1e-14);
  EXPECT_LT(apart(part.jacobian, all.jacobian, tets, 1), 1e-14);
  EXPECT_LT(apart(part.stress, all.stress, tets, 6), 1e-12);
  EXPECT_LT(apart(part.piola, all.piola, tets, 9), 1e-12);
  EXPECT_GT(apart(body.part(tets, {}).stress, all.stress, tets, 6), 0.02) << "branches count";
}

// A record stays that of its instant while the simulation goes on, and knows which element a tet is once others are gone.
TEST_P(PartOfABody, StaysThatOfItsInstant) {
  Body body(GetParam());
  const std::vector<std::uint32_t> tets = some_tets(body.mesh);
  const BranchRecord record(*body.simulation);
  const std::vector<Vec3d> u(body.simulation->displacement().begin(), body.simulation->displacement().end());
  const std::vector<Vec3d> v(body.simulation->velocity().begin(), body.simulation->velocity().end());
  const TetFields then = body.simulation->tet_fields();
  body.go(20);
  EXPECT_LT(apart(PartFields(body.mesh, body.tissues, tets).fields(u, v, record).stress, then.stress, tets, 6), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(All, PartOfABody, testing::Values(VolumeChange::element, VolumeChange::average_nodal),
                         [](const auto& given) { return given.param == VolumeChange::element ? "Own" : "Shared"; });

// Tets that are gone leave the others their elements' numbers.
TEST(PartFields, FollowsWhatIsGone) {
  Body body(VolumeChange::element);
  std::vector<std::uint32_t> tets = some_tets(body.mesh);
  const std::vector<std::uint32_t> gone{tets.front() - 1, tets[3] - 1};
  body.simulation->remove_tets(gone);
  body.go(5);
  EXPECT_LT(
      apart(body.part(tets, BranchRecord(*body.simulation)).stress, body.simulation->tet_fields().stress, tets, 6),
      1e-12);
}

TEST(PartFields, RefusesWhatIsNotThere) {
  const Body body(VolumeChange::element);
  const auto count = static_cast<std::uint32_t>(body.mesh.tets.size());
  EXPECT_THROW(PartFields(body.mesh, body.tissues, {0, count}), std::invalid_argument);
  EXPECT_THROW(PartFields(body.mesh, body.tissues, {3, 4, 3}), std::invalid_argument);
  EXPECT_THROW(PartFields(body.mesh, {{1, Tissue{}}}, {0, count - 1}), std::invalid_argument);
  const PartFields part(body.mesh, body.tissues, {0});
  const std::vector<Vec3d> few(body.mesh.vertices.size() - 1), enough(body.mesh.vertices.size());
  EXPECT_THROW(part.fields(few, enough), std::invalid_argument);
  EXPECT_THROW(part.fields(enough, few), std::invalid_argument);
  EXPECT_EQ(part.fields(enough, enough).q, std::vector<double>{1.0});
}

}  // namespace
}  // namespace glisson::part_fields_test
