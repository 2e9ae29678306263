#include "compare/models/linear_stiffness.h"

#include "compare/models/relaxation.h"

namespace glisson::models {

Sparse stiffness_matrix(const Problem& problem, const std::function<bool(std::size_t)>& takes) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(144 * problem.mesh.tets.size());
  for (std::size_t t = 0; t < problem.mesh.tets.size(); ++t) {
    if (!takes(t)) continue;
    const RestTet rest = rest_tet(problem.mesh, t);
    const LameParameters lame = test_moduli(problem, problem.tissue_of(t));
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

void clear_prescribed(Eigen::VectorXd& components, const Boundary& boundary) {
  for (Eigen::Index i = 0; i < components.size(); ++i) {
    if (boundary.prescribes(static_cast<std::size_t>(i / 3), static_cast<std::size_t>(i % 3))) components[i] = 0.0;
  }
}

Eigen::VectorXd weight(const Problem& problem, const std::vector<double>& masses, double time) {
  std::vector<Vec3d> pull(masses.size());
  for (std::size_t v = 0; v < pull.size(); ++v) pull[v] = problem.gravity_at(time) * masses[v];
  return flat(pull);
}

Eigen::VectorXd flat(const std::vector<Vec3d>& vectors) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(3 * vectors.size()));
  for (std::size_t v = 0; v < vectors.size(); ++v) {
    for (std::size_t i = 0; i < 3; ++i) out[static_cast<Eigen::Index>(3 * v + i)] = vectors[v][i];
  }
  return out;
}

std::vector<Vec3d> vectors_of(const Eigen::VectorXd& flat) {
  std::vector<Vec3d> vectors(static_cast<std::size_t>(flat.size() / 3));
  for (std::size_t v = 0; v < vectors.size(); ++v) {
    const auto k = static_cast<Eigen::Index>(3 * v);
    vectors[v] = {flat[k], flat[k + 1], flat[k + 2]};
  }
  return vectors;
}

}  // namespace glisson::models
