#include "base/symmetric_eigen.h"

#include <Spectra/SymEigsSolver.h>
#include <Eigen/Eigenvalues>

namespace glisson {
namespace {

/// An operator as Spectra sees it.
struct SpectraOperator {
  using Scalar = double;

  Eigen::Index rows() const { return n; }
  Eigen::Index cols() const { return n; }
  void perform_op(const double* in, double* out) const { apply(in, out); }

  const SymmetricOperator& apply;
  Eigen::Index n;
};

}  // namespace

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

std::vector<RuleNode> gauss_rule(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& beside) {
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, beside);
  std::vector<RuleNode> rule;
  for (Eigen::Index k = 0; k < diagonal.size(); ++k) {
    const double first = solver.eigenvectors()(0, k);
    rule.push_back({0.5 * (1.0 + solver.eigenvalues()[k]), first * first});
  }
  return rule;
}

LanczosResult largest_eigenpairs(const SymmetricOperator& apply, Eigen::Index n, const LanczosOptions& options) {
  SpectraOperator op{apply, n};
  Spectra::SymEigsSolver<SpectraOperator> solver(op, options.count, options.krylov_size);
  if (options.start.size() == 0) {
    solver.init();
  } else {
    solver.init(options.start.data());
  }
  solver.compute(Spectra::SortRule::LargestAlge, options.restarts, options.tolerance);
  return {{solver.eigenvalues(), solver.eigenvectors()}, solver.info() == Spectra::CompInfo::Successful};
}

}  // namespace glisson
