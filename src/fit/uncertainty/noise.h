// noise.h — what the residuals of a fit say of its noise, and the covariance that follows. Internal to the proof: Eigen here.
//
// All in the coordinates of the determined directions: J is the Jacobian along them, A = (JᵀJ)⁻¹ is diagonal.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fit/uncertainty/covariance.h"
#include "fit/uncertainty/residual_correlation.h"

namespace glisson::fit {

class NoiseStudy {
 public:
  NoiseStudy(const Problem& problem, const std::vector<double>& residuals, Eigen::MatrixXd jacobian,
             Eigen::MatrixXd inverse);

  /// Tests which noise it is; covariance() and freedom() are of that choice.
  NoiseEstimate choose(const CovarianceOptions& options);
  Eigen::MatrixXd covariance() const;
  double freedom() const;
  /// Σ ψ² over samples that are free, over the mean ψ': a likelihood ratio's unit for a robust loss. [Huber1981]
  double cost_unit() const { return variance_ * mean_slope_; }

 private:
  Eigen::VectorXd of(const Rows& curve) const { return scores_.segment(curve.first, curve.size); }
  Eigen::MatrixXd block(const Rows& curve) const { return jacobian_.middleRows(curve.first, curve.size); }
  NoiseKind kind_of(const CovarianceOptions& options, NoiseEstimate& e) const;
  bool stand_alone() const;
  bool is_given() const;
  NoiseEstimate as_given(NoiseEstimate e);
  bool of_kinds() const;
  Eigen::MatrixXd rest_of(const Rows& curve) const;
  Eigen::MatrixXd by_curve() const;
  Eigen::MatrixXd pulls_of_kind(std::size_t kind) const;
  Eigen::MatrixXd by_kind(std::size_t kind) const;
  double freedom_by_kind() const;
  double freedom_of(const Eigen::VectorXd& combination) const;

  const Problem& problem_;
  Eigen::MatrixXd jacobian_, inverse_;
  Eigen::VectorXd scores_;                       ///< ψ / mean ψ': for squares the residuals
  std::vector<Rows> curves_;                     ///< those with weight
  std::vector<std::size_t> numbers_;             ///< of them in the problem
  std::vector<std::vector<std::size_t>> kinds_;  ///< curves of each kind of test
  ResidualCorrelation correlation_;
  double samples_ = 0.0, variance_ = 0.0, mean_slope_ = 1.0;
  NoiseKind kind_ = NoiseKind::independent;
};

}  // namespace glisson::fit
