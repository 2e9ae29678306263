// linear_fem_modal.cpp — linear finite elements in a few shapes [PentlandWilliams1989]: the lowest modes of K φ = ω² M φ, M lumped, and the
// answers of the body to what is known beforehand: a translation of each tool along each axis, and weight. These are the static correction of
// the modes left out; a load that is made of them is answered exactly. A station costs a product with each shape, no solve.
//
//   u = Σ v (vᵀ r),   r = weight − K u_prescribed,   vᵀ K v' = δ
#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/symmetric_eigen.h"
#include "compare/models/linear_stiffness.h"
#include "compare/models/stopwatch.h"

namespace glisson::models {
namespace {

using Factor = Eigen::SimplicialLDLT<Sparse>;

/// M^½ K⁻¹ M^½ of the free components; its largest eigenvalues are 1/ω² of the lowest modes.
class Softness {
 public:
  Softness(const Factor& factor, Eigen::VectorXd root_masses) : factor_(factor), root_(std::move(root_masses)) {}
  Eigen::Index rows() const { return root_.size(); }
  void perform_op(const double* in, double* out) const {
    const Eigen::Map<const Eigen::VectorXd> x(in, rows());
    Eigen::Map<Eigen::VectorXd>(out, rows()) = root_.cwiseProduct(factor_.solve(root_.cwiseProduct(x)));
  }

 private:
  const Factor& factor_;
  Eigen::VectorXd root_;
};

/// The lowest modes, each with vᵀ K v = 1. A mode has φ = M^(−½) z and ω² = 1/θ, z of unit length.
Eigen::MatrixXd lowest_modes(const Softness& softness, const Eigen::VectorXd& root, Eigen::Index free, int count) {
  Eigen::MatrixXd z;
  Eigen::VectorXd theta;
  if (3 * count < free) {
    const auto apply = [&](const double* in, double* out) { softness.perform_op(in, out); };
    const SymmetricEigen lowest =
        largest_eigenpairs(apply, softness.rows(), {count, 2 * count + 20, 200, 1e-10, {}}).pairs;
    z = lowest.vectors;
    theta = lowest.values;
  } else {
    Eigen::MatrixXd dense(softness.rows(), softness.rows());
    for (Eigen::Index c = 0; c < dense.cols(); ++c) {
      const Eigen::VectorXd unit = Eigen::VectorXd::Unit(dense.rows(), c);
      softness.perform_op(unit.data(), dense.col(c).data());
    }
    const SymmetricEigen all = symmetric_eigen(dense);
    const Eigen::Index taken = std::min<Eigen::Index>(count, free);
    z = all.vectors.rightCols(taken);
    theta = all.values.tail(taken);
  }
  for (Eigen::Index k = 0; k < z.cols(); ++k) {
    for (Eigen::Index i = 0; i < z.rows(); ++i) z(i, k) = root[i] > 0.0 ? z(i, k) * std::sqrt(theta[k]) / root[i] : 0.0;
  }
  return z;
}

class Modes {
 public:
  Modes(const Problem& problem, int count)
      : problem_(problem), boundary_(problem), masses_(lumped_masses(problem)),
        matrix_(stiffness_matrix(problem, [](std::size_t) { return true; })),
        factor_(of_free_components(matrix_, boundary_)) {
    if (!held()) return;
    const auto n = static_cast<Eigen::Index>(3 * masses_.size());
    Eigen::VectorXd root(n);
    Eigen::Index free = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto v = static_cast<std::size_t>(i / 3), axis = static_cast<std::size_t>(i % 3);
      root[i] = boundary_.prescribes(v, axis) ? 0.0 : std::sqrt(masses_[v]);
      free += boundary_.prescribes(v, axis) ? 0 : 1;
    }
    const Softness softness(factor_, root);
    shapes_ = lowest_modes(softness, root, free, count);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const Tool& tool : problem.tools) correct(translation(tool, axis));
    }
    if (norm(problem.motion.gravity) > 0.0) correct(weight(problem, masses_, problem.duration));
  }

  bool held() const { return factor_.info() == Eigen::Success; }

  /// Answers a load and adds what no shape has of it.
  void correct(Eigen::VectorXd load) {
    clear_prescribed(load, boundary_);
    Eigen::VectorXd answer = factor_.solve(load);
    const double before = answer.dot(matrix_ * answer);
    for (int pass = 0; pass < 2; ++pass) answer -= shapes_ * (shapes_.transpose() * (matrix_ * answer));
    const double energy = answer.dot(matrix_ * answer);
    constexpr double kRounding = 1e-16;  // of the energy: what is left of a load that the shapes have
    if (!(energy > kRounding * before)) return;
    shapes_.conservativeResize(Eigen::NoChange, shapes_.cols() + 1);
    shapes_.col(shapes_.cols() - 1) = answer / std::sqrt(energy);
  }

  Vec3d solve(double time, std::vector<Vec3d>& displacement) const {
    std::vector<Vec3d> u(masses_.size());
    boundary_.set(time, u);
    const Eigen::VectorXd given = flat(u), pull = weight(problem_, masses_, time);
    Eigen::VectorXd load = pull - matrix_ * given;
    clear_prescribed(load, boundary_);
    const Eigen::VectorXd solved = given + shapes_ * (shapes_.transpose() * load);
    displacement = vectors_of(solved);
    return boundary_.force(vectors_of(pull - matrix_ * solved), displacement);
  }

  std::size_t bytes() const { return static_cast<std::size_t>(shapes_.size()) * sizeof(double); }

 private:
  /// What a tool moved along an axis does to the free components.
  Eigen::VectorXd translation(const Tool& tool, std::size_t axis) const {
    Eigen::VectorXd moved = Eigen::VectorXd::Zero(matrix_.rows());
    const std::array<bool, 3> driven{tool.axes.x, tool.axes.y, tool.axes.z};
    for (const std::uint32_t v : tool.vertices) {
      moved[static_cast<Eigen::Index>(3 * v + axis)] = driven[axis] ? 1.0 : 0.0;
    }
    return -(matrix_ * moved);
  }

  const Problem& problem_;
  Boundary boundary_;
  std::vector<double> masses_;
  Sparse matrix_;
  Factor factor_;
  Eigen::MatrixXd shapes_;  ///< v in columns
};

}  // namespace

Answer linear_fem_modal(const Problem& problem, const Effort& effort, const Stop& stop) {
  Answer answer;
  if (stop) return answer;
  if (problem.cut) {
    answer.trouble = "its modes are those of the whole body; a cut asks for others, at the price of its set-up";
    return answer;
  }
  Stopwatch watch;
  const Modes modes(problem, effort.iterations);
  if (!modes.held()) {
    answer.trouble = "the stiffness matrix is singular: supports and tools leave a rigid motion free";
    return answer;
  }
  answer.setup_s = watch.lap();
  for (const double time : problem.stations) {
    if (stop) break;
    answer.forces.push_back(modes.solve(time, answer.displacement));
  }
  answer.run_s = watch.lap();
  answer.steps = problem.stations.size();
  answer.bytes = modes.bytes();
  return answer;
}

}  // namespace glisson::models
