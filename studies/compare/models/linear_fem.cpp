// linear_fem.cpp — linear finite elements: the sparse stiffness matrix is factorised once, each station is one solve. Small strain and
// small rotation: forces are proportional to the displacement, and a turned body swells.
#include <Eigen/SparseCholesky>
#include <memory>

#include "compare/models/boundary.h"
#include "compare/models/linear_stiffness.h"
#include "compare/models/stopwatch.h"

namespace glisson::models {
namespace {

/// The stiffness of the tets that are left and its factor, of the components that are free: not prescribed, and with a tet.
class Factored {
 public:
  Factored(const Problem& problem, const Boundary& boundary, const std::vector<bool>& gone)
      : matrix_(stiffness_matrix(problem, [&](std::size_t t) { return !gone[t]; })),
        free_(static_cast<std::size_t>(matrix_.rows())) {
    const Eigen::VectorXd diagonal = matrix_.diagonal();
    for (std::size_t i = 0; i < free_.size(); ++i) {
      free_[i] = !boundary.prescribes(i / 3, i % 3) && diagonal[static_cast<Eigen::Index>(i)] > 0.0;
    }
    Sparse rest = matrix_;
    rest.prune([&](Eigen::Index i, Eigen::Index j, double) { return free(i) && free(j); });
    for (Eigen::Index i = 0; i < rest.rows(); ++i) {
      if (!free(i)) rest.coeffRef(i, i) = 1.0;
    }
    rest.makeCompressed();
    factor_.compute(rest);
  }

  bool sound() const { return factor_.info() == Eigen::Success; }
  const Sparse& matrix() const { return matrix_; }
  std::size_t bytes() const {
    return 12 * static_cast<std::size_t>(matrix_.nonZeros() + factor_.matrixL().nestedExpression().nonZeros());
  }

  /// Displacements under loads where the prescribed ones are given, the others of `given` 0.
  Eigen::VectorXd solve(const Eigen::VectorXd& loads, const Eigen::VectorXd& given) const {
    Eigen::VectorXd right = loads - matrix_ * given;
    for (Eigen::Index i = 0; i < right.size(); ++i) {
      if (!free(i)) right[i] = 0.0;
    }
    return given + factor_.solve(right);
  }

 private:
  bool free(Eigen::Index i) const { return free_[static_cast<std::size_t>(i)]; }

  Sparse matrix_;
  std::vector<bool> free_;
  Eigen::SimplicialLDLT<Sparse> factor_;
};

}  // namespace

Answer linear_fem(const Problem& problem, const Effort&, const Stop& stop) {
  Answer answer;
  Stopwatch watch;
  const Boundary boundary(problem);
  const std::size_t n = problem.mesh.vertices.size();
  std::vector<bool> gone(problem.mesh.tets.size(), false);
  auto body = std::make_unique<Factored>(problem, boundary, gone);
  if (!body->sound()) {
    answer.trouble = "the stiffness matrix is singular: supports and tools leave a rigid motion free";
    return answer;
  }
  const std::vector<double> masses = lumped_masses(problem);
  answer.setup_s = watch.lap();
  answer.displacement.assign(n, Vec3d{});
  bool whole = problem.cut.has_value();
  for (const double time : problem.stations) {
    if (stop) break;
    if (whole && time >= problem.cut->time) {
      whole = false;
      Stopwatch knife;
      for (const std::uint32_t t : problem.cut->tets) gone[t] = true;
      body = std::make_unique<Factored>(problem, boundary, gone);
      answer.cut_s = knife.lap();
    }
    std::vector<Vec3d> u(n);
    boundary.set(time, u);
    const Eigen::VectorXd pull = weight(problem, masses, time), solved = body->solve(pull, flat(u));
    answer.displacement = vectors_of(solved);
    answer.forces.push_back(boundary.force(vectors_of(pull - body->matrix() * solved), answer.displacement));
  }
  answer.run_s = watch.lap();
  answer.steps = problem.stations.size();
  answer.bytes = body->bytes();
  return answer;
}

}  // namespace glisson::models
