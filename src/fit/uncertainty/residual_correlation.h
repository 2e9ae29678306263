// residual_correlation.h — how the residuals of a fit swing, by restricted likelihood: noise and misfit taken apart.
//
// A machine writes 500 samples a second, but a law that misfits leaves residuals that swing slowly: neighbours say the same
// thing twice. A residual is white noise and a first-order process, of which the second is what swings:
//
//   r_i = e_i + s_i,   var e = w σ²,   cov(s_i, s_j) = (1 − w) σ² φ^|i − j|,   V = cov(r) / σ²
//
// w, φ and σ² are those of the largest restricted likelihood [PattersonThompson1971], which knows that the fit has taken p
// shapes out of the residuals; φ is that of no slower swings than a fit leaves, since what a slower misfit would take into the
// parameters is theirs: they are those with which the law comes nearest. Their process is a state of one number, so that V⁻¹ᐟ² is a pass of a Kalman filter.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace glisson::fit {

/// Rows of a curve among all residuals.
struct Rows {
  Eigen::Index first = 0, size = 0;
};

class ResidualCorrelation {
 public:
  /// Independent residuals.
  ResidualCorrelation() = default;
  /// @param jacobian  of the residuals, of full rank
  ResidualCorrelation(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& jacobian, std::span<const Rows> curves);

  double white() const { return white_; }  ///< w
  double phi() const { return phi_; }
  double variance() const { return variance_; }  ///< σ²
  /// Samples of a curve that count as one: 1ᵀV1 / n.
  double time(Eigen::Index size) const;
  /// V x for each column.
  Eigen::MatrixXd times(const Eigen::MatrixXd& x, std::span<const Rows> curves) const;
  /// Degrees of freedom of an estimate of σ² from the residuals: 2 E² / var of rᵀr [Satterthwaite1946].
  /// @param inverse  (JᵀJ)⁻¹
  double freedom(const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& inverse, std::span<const Rows> curves) const;

 private:
  double likelihood(const Eigen::MatrixXd& columns, std::span<const Rows> curves, double& variance) const;
  double whiten(Eigen::MatrixXd& columns, const Rows& curve) const;

  double white_ = 1.0, phi_ = 0.0, variance_ = 0.0;
};

/// Probability that independent samples show autocorrelations at least as large: small where they are not independent.
///
///   Q = n (n + 2) Σ_k ρ_k² / (n − k), χ² with as many degrees of freedom as lags            [LjungBox1978]
///
/// summed over the series, with up to ten lags of each.
double independence_probability(const std::vector<std::vector<double>>& series);

}  // namespace glisson::fit
