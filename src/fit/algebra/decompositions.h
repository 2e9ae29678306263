// decompositions.h — decompositions of dense matrices by Eigen, for all of the fit: they take seconds to compile, in one file once.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace glisson::fit {

struct SymmetricEigen {
  Eigen::VectorXd values;   ///< ascending
  Eigen::MatrixXd vectors;  ///< columns of length 1, in that order
};
/// @param a  symmetric
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a);
double largest_eigenvalue(const Eigen::MatrixXd& a);

struct SingularDirections {
  Eigen::VectorXd values;   ///< descending, one a column of the matrix
  Eigen::MatrixXd vectors;  ///< right ones: columns of length 1, in that order
};
/// Of a matrix of many rows, by its triangle: AᵀA would lose half the digits.
SingularDirections singular_directions(const Eigen::MatrixXd& a);

/// x of the least |a x − b|, by QR with pivots.
/// @param rank  columns whose pivot is below this share of the largest do not count; none: to rounding
Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, std::optional<double> rank = {});

/// a⁻¹ b, by LU with row pivots. @param a  square
Eigen::VectorXd solve(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// A positive definite system.
struct DefiniteSolution {
  Eigen::VectorXd x;             ///< a⁻¹ b
  double log_determinant = 0.0;  ///< ln det a
};
/// By Cholesky's factor; none where a is not positive definite.
std::optional<DefiniteSolution> solve_definite(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

}  // namespace glisson::fit
