// decompositions.h — decompositions of dense matrices by Eigen, for all of the fit: they take seconds to compile, in one file once.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

namespace glisson::fit {

struct SingularDirections {
  Eigen::VectorXd values;   ///< descending, one a column of the matrix
  Eigen::MatrixXd vectors;  ///< right ones: columns of length 1, in that order
};
/// Of a matrix of many rows, by its triangle: AᵀA would lose half the digits.
SingularDirections singular_directions(const Eigen::MatrixXd& a);

/// x of the least |a x − b|, by QR with pivots.
/// @param rank  columns whose pivot is below this share of the largest do not count; none: to rounding
Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, std::optional<double> rank = {});

/// Q R of a matrix of full column rank, without pivots.
class QrFactor {
 public:
  explicit QrFactor(const Eigen::MatrixXd& a);
  ~QrFactor();
  /// The columns of Q that span those of a.
  Eigen::MatrixXd thin() const;
  /// x of the least |a x − b|, column by column.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

/// By LU with row pivots. @param a  square
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& a);
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
