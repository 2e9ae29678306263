// The factor of the system of a Newton iteration is that of the matrix that is applied, of averaged volume changes too.
#include "dynamics/solvers/tangent_system.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "support/bodies.h"

namespace glisson {
namespace {

struct Kind {
  const char* name;
  Tissue tissue;
};
void PrintTo(const Kind& k, std::ostream* out) { *out << k.name; }

std::vector<Kind> kinds() {
  std::vector<Kind> all;
  const auto add = [&](const char* name, auto&& set) {
    Kind k{name, {}};
    k.tissue.youngs_modulus = 5000.0, k.tissue.poisson_ratio = 0.49;
    k.tissue.volume_change = VolumeChange::average_nodal;
    set(k.tissue);
    all.push_back(k);
  };
  add("linear", [](Tissue&) {});
  add("no_bulk", [](Tissue& t) { t.poisson_ratio = 0.0; });
  add("corotational", [](Tissue& t) { t.kinematics = Kinematics::corotational; });
  add("neo_hooke", [](Tissue& t) { t.hyperelastic = NeoHookean{.mu = 1700.0, .bulk_modulus = 85000.0}; });
  add("maxwell", [](Tissue& t) { t.maxwell = {{0.3, 0.2}, {0.2, 2.0}}; });
  add("own_volumes", [](Tissue& t) { t.volume_change = VolumeChange::element; });
  return all;
}

class TangentFactor : public testing::TestWithParam<Kind> {};

// Beside tissue that does not share, deformed by some 1 % and with its bottom held: x from A x by the factor alone, and a solve
// takes one iteration. With each tet's own volume change in the factor's place, nearly incompressible tissue took 36 to 40.
TEST_P(TangentFactor, IsThatOfTheMatrix) {
  std::mt19937 random(17);
  TetMesh mesh = test::jittered_box({4, 4, 4}, 0.01, 0.15, random);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    mesh.regions.push_back(mesh.vertices[mesh.tets[t][0]].x < 0.02 ? 0 : 1);
  }
  Tissue other;
  other.youngs_modulus = 2000.0, other.poisson_ratio = 0.3;
  const Body body = build_body(mesh, {{0, GetParam().tissue}, {1, other}});
  const TissueOperator op(body);
  StepInterrupt nobody_asks;
  TangentSystem system(op, Preconditioner::factorised, nobody_asks);
  std::vector<char> free(3 * body.vertex_count, 1);
  for (std::size_t v = 0; v < body.vertex_count; ++v) {
    if (body.rest_positions[v].z < 0.003) free[3 * v] = free[3 * v + 1] = free[3 * v + 2] = 0;
  }
  system.set_free(free);
  const std::vector<Vec3d> u = test::random_field(body.vertex_count, 1e-4, random), v(body.vertex_count);
  const std::vector<Vec3d> diagonal(body.vertex_count, Vec3d{0.1, 0.1, 0.1});
  system.linearise({u, v, 0.05}, {.rate = 20.0, .weight = 0.7, .diagonal = diagonal}, false);

  std::vector<Vec3d> x = test::random_field(body.vertex_count, 1.0, random), b(x.size());
  for (std::size_t c = 0; c < free.size(); ++c) x[c / 3][c % 3] *= free[c];
  system.apply(x, b);
  for (std::size_t c = 0; c < free.size(); ++c) b[c / 3][c % 3] *= free[c];
  const Eigen::VectorXd wanted = flat(std::span<const Vec3d>(x)), load = flat(std::span<const Vec3d>(b));
  Eigen::VectorXd found;
  const KrylovResult solved = system.solve(load, 1e-8, found);
  EXPECT_TRUE(solved.converged);
  EXPECT_EQ(solved.iterations, 1);
  Eigen::MatrixXd by_factor = load;
  system.factor_solve(by_factor);
  EXPECT_LT((by_factor.col(0) - wanted).norm(), 1e-9 * wanted.norm());
}

INSTANTIATE_TEST_SUITE_P(Tissues, TangentFactor, testing::ValuesIn(kinds()),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace glisson
