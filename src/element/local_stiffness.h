// local_stiffness.h — λ and μ of one element from its deformation, and how much stiffer its tangent is.
//
// The tangent matters for the stable step. With σ = f(x) σ₀(ε), x the measure and n = ∂x/∂ε,
//   dσ = f C₀ dε + f' σ₀ (n : dε).
// The symmetric part of σ₀ ⊗ n exceeds C₀ at most by the factor ½ (ε:n + √(ε:σ₀ · n:C₀⁻¹:n)), and n is a
// deviator of norm g (intensity: 1; 1 − q: 4s/3; raw mean ratio: at most 1.64 x), so that
//   tangent ≤ r C₀,   r = f + |f'| g ½ (e + √(e² + (K/2μ) t²)),   e = ‖dev ε‖, t = tr ε, K = λ + ⅔ μ.
#pragma once

#include <cmath>

#include "element/body.h"
#include "glisson/material/shape_measure.h"
#include "material/modulus_laws.h"
#include "material/stiffness_formulas.h"

namespace glisson {

/// Moduli of an element in its present shape [Pa], and the bound r of tangent over rest stiffness [-].
struct LocalStiffness {
  double lambda, mu, stiffening;
};

/// The measure x of an element and the bound g of ‖∂x/∂ε‖.
struct MeasureValue {
  double x, slope;
};

template <DeformationMeasure M>
MeasureValue measure_value(const Mat3d& H, double rest_volume, const EdgeMetric<double>& metric) {
  if constexpr (M == DeformationMeasure::regular_mean_ratio) {
    const double x = regular_mean_ratio(H, rest_volume, metric);
    return {x, 1.64 * x};
  } else {
    const double p = one_minus_q(H), s = intensity_of(p);
    if constexpr (M == DeformationMeasure::one_minus_q) return {p, 4.0 / 3.0 * s};
    return {s, 1.0};
  }
}

/// ½ (e + √(e² + (K/2μ) t²)).
inline double strain_bound(const Mat3d& H, double bulk_over_two_mu) {
  const double e2 = deviator_squared(H), t = trace(H);
  return 0.5 * (std::sqrt(e2) + std::sqrt(e2 + bulk_over_two_mu * t * t));
}
inline double bulk_over_two_mu(const LameParameters& lame) {
  return (lame.lambda + 2.0 / 3.0 * lame.mu) / (2.0 * lame.mu);
}

/// A law on E: λ and μ scale alike.
template <class Law>
class YoungStiffness {
 public:
  YoungStiffness(const TissueBlock& block, const Law& law)
      : numbers_(law.numbers(block.tissue.youngs_modulus)), inverse_E_(1.0 / block.tissue.youngs_modulus),
        rest_(block.elastic), bulk_over_two_mu_(bulk_over_two_mu(rest_)) {}

  LocalStiffness operator()(const Mat3d& H, MeasureValue m) const {
    const ValueSlope<double> E = Law::at(numbers_, m.x);
    const double f = E.value * inverse_E_, slope = std::abs(E.slope) * inverse_E_ * m.slope;
    return {f * rest_.lambda, f * rest_.mu, f + slope * strain_bound(H, bulk_over_two_mu_)};
  }

 private:
  decltype(std::declval<Law>().numbers(0.0)) numbers_;
  double inverse_E_;
  LameParameters rest_;
  double bulk_over_two_mu_;
};

/// Laws on λ and μ apart.
class LameStiffness {
 public:
  explicit LameStiffness(const TissueBlock& block)
      : laws_(block.tissue), rest_(block.elastic), bulk_over_two_mu_(bulk_over_two_mu(rest_)) {}

  LocalStiffness operator()(const Mat3d& H, MeasureValue m) const {
    const Moduli<double> k = laws_.at(m.x);
    const double bulk = k.lambda + 2.0 / 3.0 * k.mu, rest_bulk = rest_.lambda + 2.0 / 3.0 * rest_.mu;
    const double slope_mu = std::abs(k.mu_slope) / rest_.mu;
    const double slope_bulk = (std::abs(k.lambda_slope) + 2.0 / 3.0 * rest_.mu * slope_mu) / rest_bulk;
    const double f = std::max(k.mu / rest_.mu, bulk / rest_bulk), slope = std::max(slope_mu, slope_bulk) * m.slope;
    return {k.lambda, k.mu, f + slope * strain_bound(H, bulk_over_two_mu_)};
  }

 private:
  ModulusLaws laws_;
  LameParameters rest_;
  double bulk_over_two_mu_;
};

}  // namespace glisson
