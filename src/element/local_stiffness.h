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
#include "material/modulus_laws.h"
#include "material/shape_measure.h"

namespace glisson {

/// Moduli of an element in its present shape [Pa], and the bound r of tangent over rest stiffness [-].
template <class T>
struct LocalStiffness {
  T lambda, mu, stiffening;
};

/// The measure x of an element and the bound g of ‖∂x/∂ε‖.
template <class T>
struct MeasureValue {
  T x, slope;
};

template <DeformationMeasure M, class T>
MeasureValue<T> measure_value(const Mat3<T>& H, T rest_volume, const EdgeMetric<T>& metric) {
  if constexpr (M == DeformationMeasure::regular_mean_ratio) {
    const T x = regular_mean_ratio(H, rest_volume, metric);
    return {x, T(1.64) * x};
  } else {
    const T p = one_minus_q(H), s = intensity_of(p);
    if constexpr (M == DeformationMeasure::one_minus_q) return {p, T(4.0 / 3.0) * s};
    return {s, T(1)};
  }
}

/// ½ (e + √(e² + (K/2μ) t²)).
template <class T>
T strain_bound(const Mat3<T>& H, T bulk_over_two_mu) {
  const T e2 = deviator_squared(H), t = trace(H);
  return T(0.5) * (std::sqrt(e2) + std::sqrt(e2 + bulk_over_two_mu * t * t));
}

/// A law on E: λ and μ scale alike.
template <class T, class Law>
class YoungStiffness {
 public:
  YoungStiffness(const TissueBlock& block, const Law& law)
      : numbers_(law.numbers(block.tissue.youngs_modulus)), inverse_E_(T(1) / T(block.tissue.youngs_modulus)),
        lambda_(T(block.elastic.lambda)), mu_(T(block.elastic.mu)),
        bulk_over_two_mu_((lambda_ + T(2.0 / 3.0) * mu_) / (T(2) * mu_)) {}

  LocalStiffness<T> operator()(const Mat3<T>& H, MeasureValue<T> m) const {
    const ValueSlope<T> E = Law::at(numbers_, m.x);
    const T f = E.value * inverse_E_, slope = std::abs(E.slope) * inverse_E_ * m.slope;
    return {f * lambda_, f * mu_, f + slope * strain_bound(H, bulk_over_two_mu_)};
  }

 private:
  decltype(std::declval<Law>().numbers(0.0)) numbers_;
  T inverse_E_, lambda_, mu_, bulk_over_two_mu_;
};

/// Laws on λ and μ apart.
template <class T>
class LameStiffness {
 public:
  explicit LameStiffness(const TissueBlock& block)
      : laws_(block.tissue), lambda_(block.elastic.lambda), mu_(block.elastic.mu),
        bulk_over_two_mu_(T((lambda_ + 2.0 / 3.0 * mu_) / (2.0 * mu_))) {}

  LocalStiffness<T> operator()(const Mat3<T>& H, MeasureValue<T> m) const {
    const Moduli<double> k = laws_.at(static_cast<double>(m.x));
    const double bulk = k.lambda + 2.0 / 3.0 * k.mu, rest_bulk = lambda_ + 2.0 / 3.0 * mu_;
    const double slope_mu = std::abs(k.mu_slope) / mu_;
    const double slope_bulk = (std::abs(k.lambda_slope) + 2.0 / 3.0 * mu_ * slope_mu) / rest_bulk;
    const T f = T(std::max(k.mu / mu_, bulk / rest_bulk)), slope = T(std::max(slope_mu, slope_bulk)) * m.slope;
    return {T(k.lambda), T(k.mu), f + slope * strain_bound(H, bulk_over_two_mu_)};
  }

 private:
  ModulusLaws laws_;
  double lambda_, mu_;
  T bulk_over_two_mu_;
};

}  // namespace glisson
