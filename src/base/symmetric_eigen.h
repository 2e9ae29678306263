// symmetric_eigen.h — eigenvalues of symmetric matrices by Eigen, of symmetric operators by Spectra: they take seconds to compile, in one
// file once.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace glisson {

struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;  ///< columns of length 1, in the order of the values
};

/// All eigenvalues, ascending. @param a  symmetric
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a);

/// A point of a rule for the mean of a function over (0, 1).
struct RuleNode {
  double at, weight;
};

/// Gauss's rule of polynomials orthogonal on (0, 1), from their recurrence on (-1, 1) [GolubWelsch1969].
/// @param diagonal  n numbers @param beside  n - 1 numbers next to it @return n nodes; the weights' sum is 1
std::vector<RuleNode> gauss_rule(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& beside);

/// Writes A x for an n-vector x. It keeps neither pointer.
using SymmetricOperator = std::function<void(const double* x, double* image)>;

struct LanczosOptions {
  int count = 1;            ///< of eigenvalues, at least 1
  int krylov_size = 24;     ///< vectors kept, above count and at most n
  int restarts = 100;       ///< at most
  double tolerance = 1e-4;  ///< residual over eigenvalue
  Eigen::VectorXd start;    ///< n numbers; empty: Spectra's own random vector
};

struct LanczosResult {
  SymmetricEigen pairs;    ///< those that converged
  bool converged = false;  ///< all of them
};

/// The largest eigenvalues of an operator of n unknowns, descending, by Lanczos with implicit restarts.
/// @throws std::exception where an inner decomposition fails
LanczosResult largest_eigenpairs(const SymmetricOperator& apply, Eigen::Index n, const LanczosOptions& options);

}  // namespace glisson
