// The paper's press, slow enough to be static, against an independent static solution and the literature check.
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>

#include "glisson/instruments/motion.h"
#include "material/reference/reference.h"
#include "support/bodies.h"

namespace glisson {
namespace {

/// Static stiffness [N/m] of pressing a triangle down without sideways motion, base held: LDLᵀ of the
/// assembled matrix on the free components.
double static_stiffness(const TetMesh& mesh, const Tissue& tissue, const test::VertexSet& triangle) {
  const Eigen::SparseMatrix<double> K = reference::stiffness_matrix(mesh, {{0, tissue}});
  Eigen::VectorXd u = Eigen::VectorXd::Zero(K.rows());
  std::vector<char> held(static_cast<std::size_t>(K.rows()), 0);
  const auto hold = [&](std::uint32_t i) { held[3 * i] = held[3 * i + 1] = held[3 * i + 2] = 1; };
  for (const std::uint32_t i : mesh.vertex_sets.at("z_min")) hold(i);
  for (const std::uint32_t i : triangle) hold(i), u[3 * i + 2] = -1.0;

  std::vector<Eigen::Index> number(held.size(), -1);
  Eigen::Index n = 0;
  for (std::size_t i = 0; i < held.size(); ++i) number[i] = held[i] ? -1 : n++;
  const Eigen::VectorXd load = -(K * u);
  Eigen::VectorXd free_load(n);
  std::vector<Eigen::Triplet<double>> entries;
  for (int c = 0; c < K.outerSize(); ++c) {
    if (held[c]) continue;
    free_load[number[c]] = load[c];
    for (Eigen::SparseMatrix<double>::InnerIterator it(K, c); it; ++it) {
      if (!held[it.row()]) entries.emplace_back(number[it.row()], number[c], it.value());
    }
  }
  Eigen::SparseMatrix<double> free(n, n);
  free.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd x = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(free).solve(free_load);
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (!held[i]) u[i] = x[number[i]];
  }
  const Eigen::VectorXd reaction = K * u;
  double force = 0.0;
  for (const std::uint32_t i : triangle) force -= reaction[3 * i + 2];
  return force;
}

struct Press {
  const char* name;
  test::VertexSet triangle;
  double expected;  ///< [N/m], found by two independent codes
};

class QuasiStaticPress : public testing::TestWithParam<Press> {};

// Three triangles of the top face: dynamics = static solve = literature check; what the tool gives the base takes.
TEST_P(QuasiStaticPress, GivesTheStaticStiffness) {
  const Press& p = GetParam();
  const TetMesh mesh = test::paper_mesh();
  const double solved = static_stiffness(mesh, Tissue{}, p.triangle);
  EXPECT_NEAR(solved, p.expected, 1e-3 * p.expected) << "static solve [N/m]";

  SimulationOptions options;
  options.damping_rate = 20.0;
  Simulation simulation(mesh, {{0, Tissue{}}}, options);
  const ConstraintId base = simulation.fix(mesh.vertex_sets.at("z_min"));
  const PressMotion motion{.velocity = 0.005, .depth = 0.005, .ramp = 0.2, .hold = 2.0};
  const ConstraintId tool = simulation.drive(p.triangle, press(motion));
  while (simulation.time() < press_end(motion)) ASSERT_EQ(simulation.step().status, StepStatus::ok);
  const double stiffness = -simulation.force(tool).total().z / motion.depth;
  EXPECT_NEAR(stiffness, solved, 5e-3 * solved) << "against the static solve [N/m]";
  EXPECT_NEAR(stiffness, p.expected, 5e-3 * p.expected) << "against the literature check [N/m]";
  EXPECT_NEAR(simulation.force(base).total().z, -simulation.force(tool).total().z, 1e-4 * stiffness * motion.depth);
}

std::string case_name(const testing::TestParamInfo<Press>& c) { return c.param.name; }

INSTANTIATE_TEST_SUITE_P(Triangles, QuasiStaticPress,
                         testing::Values(Press{"centre_left_below", {212, 211, 207}, 51.19},
                                         Press{"centre_right_above", {212, 213, 217}, 50.59},
                                         Press{"lower_of_the_cell", {212, 213, 218}, 49.41}),
                         case_name);

}  // namespace
}  // namespace glisson
