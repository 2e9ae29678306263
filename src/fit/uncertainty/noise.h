// noise.h — what the residuals of a fit say of its noise, and the covariance that follows. Internal to the proof: Eigen here.
//
// All in the coordinates of the determined directions: J is the Jacobian along them, A = (JᵀJ)⁻¹ is diagonal.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "fit/uncertainty/covariance.h"

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
  struct Part {
    Eigen::Index first = 0, size = 0;
    double time = 1.0;  ///< τ
    std::size_t curve = 0;
  };
  Eigen::VectorXd rows(const Part& part) const { return scores_.segment(part.first, part.size); }
  Eigen::MatrixXd block(const Part& part) const { return jacobian_.middleRows(part.first, part.size); }
  void set_effective(NoiseKind kind);
  bool clusters_possible() const;
  std::optional<double> common_probability() const;
  Eigen::MatrixXd autocorrelated() const;
  Eigen::MatrixXd by_curve() const;

  const Problem& problem_;
  Eigen::MatrixXd jacobian_, inverse_;
  Eigen::VectorXd scores_;   ///< ψ / mean ψ': for squares the residuals
  std::vector<Part> parts_;  ///< curves with weight
  double samples_ = 0.0, effective_ = 0.0, variance_ = 0.0, mean_slope_ = 1.0;
  NoiseKind kind_ = NoiseKind::independent;
};

}  // namespace glisson::fit
