// linear_fem.cpp — linear finite elements: the sparse stiffness matrix is factorised once, each station is one solve. Small strain and
// small rotation: forces are proportional to the displacement, and a turned body swells.
#include <Eigen/SparseCholesky>

#include "models/boundary.h"
#include "models/linear_stiffness.h"
#include "models/stopwatch.h"

namespace glisson::models {
Answer linear_fem(const Problem& problem, const Effort&, const Stop& stop) {
  Answer answer;
  Stopwatch watch;
  const Boundary boundary(problem);
  const std::size_t n = problem.mesh.vertices.size();
  const Sparse matrix = stiffness_matrix(problem, [](std::size_t) { return true; });
  const Eigen::SimplicialLDLT<Sparse> factor(of_free_components(matrix, boundary));
  if (factor.info() != Eigen::Success) {
    answer.trouble = "the stiffness matrix is singular: supports and tools leave a rigid motion free";
    return answer;
  }
  const std::vector<double> masses = lumped_masses(problem);
  answer.setup_s = watch.lap();
  answer.displacement.assign(n, Vec3d{});
  for (const double time : problem.stations) {
    if (stop) break;
    std::vector<Vec3d> u(n), weight(n);
    for (std::size_t v = 0; v < n; ++v) weight[v] = problem.gravity_at(time) * masses[v];
    boundary.set(time, u);
    const Eigen::VectorXd given = flat(u);
    Eigen::VectorXd right = flat(weight) - matrix * given;
    clear_prescribed(right, boundary);
    const Eigen::VectorXd solved = given + factor.solve(right);
    const Eigen::VectorXd own = flat(weight) - matrix * solved;
    std::vector<Vec3d> forces(n);
    for (std::size_t v = 0; v < n; ++v) {
      const auto k = static_cast<Eigen::Index>(3 * v);
      answer.displacement[v] = {solved[k], solved[k + 1], solved[k + 2]};
      forces[v] = {own[k], own[k + 1], own[k + 2]};
    }
    answer.forces.push_back(boundary.force(forces, answer.displacement));
  }
  answer.run_s = watch.lap();
  answer.steps = problem.stations.size();
  answer.bytes = static_cast<std::size_t>(matrix.nonZeros() + factor.matrixL().nestedExpression().nonZeros()) * 12;
  return answer;
}

}  // namespace glisson::models
