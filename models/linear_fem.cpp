// linear_fem.cpp — linear finite elements: the sparse stiffness matrix is factorised once, each station is one solve. Small strain and
// small rotation: forces are proportional to the displacement, and a turned body swells.
#include <Eigen/SparseCholesky>

#include "models/boundary.h"
#include "models/stopwatch.h"

namespace glisson::models {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// K_ab = V (λ s_a s_bᵀ + μ s_b s_aᵀ + μ (s_a·s_b) I).
Sparse stiffness_matrix(const Problem& problem) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(144 * problem.mesh.tets.size());
  for (std::size_t t = 0; t < problem.mesh.tets.size(); ++t) {
    const RestTet rest = rest_tet(problem.mesh, t);
    const LameParameters lame = problem.tissue_of(t).lame();
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) {
        const double along = lame.mu * dot(rest.s[a], rest.s[b]);
        for (std::size_t i = 0; i < 3; ++i) {
          for (std::size_t j = 0; j < 3; ++j) {
            const double k = lame.lambda * rest.s[a][i] * rest.s[b][j] + lame.mu * rest.s[b][i] * rest.s[a][j] +
                             (i == j ? along : 0.0);
            entries.emplace_back(static_cast<int>(3 * problem.mesh.tets[t][a] + i),
                                 static_cast<int>(3 * problem.mesh.tets[t][b] + j), rest.volume * k);
          }
        }
      }
    }
  }
  const auto n = static_cast<Eigen::Index>(3 * problem.mesh.vertices.size());
  Sparse matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// The matrix with rows and columns of prescribed components replaced by those of the identity.
Sparse of_free_components(const Sparse& matrix, const Boundary& boundary) {
  const auto prescribed = [&](Eigen::Index i) {
    return boundary.prescribes(static_cast<std::size_t>(i / 3), static_cast<std::size_t>(i % 3));
  };
  Sparse free = matrix;
  free.prune([&](Eigen::Index i, Eigen::Index j, double) { return !prescribed(i) && !prescribed(j); });
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    if (prescribed(i)) free.coeffRef(i, i) = 1.0;
  }
  free.makeCompressed();
  return free;
}

Eigen::VectorXd flat(const std::vector<Vec3d>& vectors) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(3 * vectors.size()));
  for (std::size_t v = 0; v < vectors.size(); ++v) {
    for (std::size_t i = 0; i < 3; ++i) out[static_cast<Eigen::Index>(3 * v + i)] = vectors[v][i];
  }
  return out;
}

}  // namespace

Answer linear_fem(const Problem& problem, const Effort&, const Stop& stop) {
  Answer answer;
  Stopwatch watch;
  const Boundary boundary(problem);
  const std::size_t n = problem.mesh.vertices.size();
  const Sparse matrix = stiffness_matrix(problem);
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
    for (Eigen::Index i = 0; i < right.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (boundary.prescribes(k / 3, k % 3)) right[i] = 0.0;
    }
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
