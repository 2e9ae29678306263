// linear_fem_implicit.cpp — linear finite elements in motion, by backward Euler [BaraffWitkin1998]: one factor for all steps, a solve a step,
// stable at any length of it.
//
//   (M/h² + C/h + K) u⁺ = weight + M (u/h² + v/h) + C u/h,   v⁺ = (u⁺ − u)/h,   C = γ M, M lumped
#include <Eigen/SparseCholesky>

#include "compare/models/linear_stiffness.h"
#include "compare/models/stepping.h"

namespace glisson::models {
namespace {

class ImplicitSteps {
 public:
  ImplicitSteps(const Problem& problem, double step)
      : problem_(problem), step_(step), boundary_(problem), gone_(problem.mesh.tets.size(), false),
        masses_(lumped_masses(problem)), mass_(3 * masses_.size()) {
    for (std::size_t v = 0; v < masses_.size(); ++v) {
      mass_.segment<3>(static_cast<Eigen::Index>(3 * v)).setConstant(masses_[v]);
    }
    u_ = v_ = change_of_speed_ = Eigen::VectorXd::Zero(mass_.size());
    factorise();
  }

  void advance(double time, double h) {
    std::vector<Vec3d> given(masses_.size());
    boundary_.set(time + h, given);
    const Eigen::VectorXd prescribed = flat(given);
    Eigen::VectorXd right = weight(problem_, masses_, time + h) + mass_.cwiseProduct(u_ * inertia() + v_ / h);
    right -= matrix_ * prescribed + inertia() * mass_.cwiseProduct(prescribed);
    clear_prescribed(right, boundary_);
    const Eigen::VectorXd next = prescribed + factor_.solve(right);
    change_of_speed_ = (next - u_) / h - v_;
    v_ += change_of_speed_;
    u_ = next;
  }

  Vec3d force(double time) const {
    const Eigen::VectorXd inertia = mass_.cwiseProduct(change_of_speed_ / step_ + problem_.damping() * v_);
    return boundary_.force(vectors_of(weight(problem_, masses_, time) - matrix_ * u_ - inertia), displacement());
  }
  std::vector<Vec3d> displacement() const { return vectors_of(u_); }
  std::size_t bytes() const {
    return 12 * static_cast<std::size_t>(matrix_.nonZeros() + factor_.matrixL().nestedExpression().nonZeros());
  }
  /// The stiffness of tets goes; their mass stays.
  std::string remove(std::span<const std::uint32_t> tets) {
    for (const std::uint32_t t : tets) gone_[t] = true;
    factorise();
    return {};
  }

 private:
  double inertia() const { return 1.0 / (step_ * step_) + problem_.damping() / step_; }
  void factorise() {
    matrix_ = stiffness_matrix(problem_, [&](std::size_t t) { return !gone_[t]; });
    const Eigen::VectorXd diagonal = inertia() * mass_;
    factor_.compute(of_free_components(matrix_ + Sparse(diagonal.asDiagonal()), boundary_));
  }

  const Problem& problem_;
  double step_;
  Boundary boundary_;
  std::vector<bool> gone_;
  std::vector<double> masses_;
  Eigen::VectorXd mass_;  ///< of each component [kg]
  Sparse matrix_;
  Eigen::SimplicialLDLT<Sparse> factor_;
  Eigen::VectorXd u_, v_;
  Eigen::VectorXd change_of_speed_;  ///< in the last step [m/s]
};

}  // namespace

Answer linear_fem_implicit(const Problem& problem, const Effort& effort, const Stop& stop) {
  Stopwatch watch;
  const auto steps = static_cast<std::size_t>(effort.steps);
  ImplicitSteps model(problem, problem.duration / static_cast<double>(steps));
  return run_in_steps(problem, stop, model, steps, watch);
}

}  // namespace glisson::models
