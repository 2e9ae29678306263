// stiffness_bound.h — how stiff a tet may have become: bounds of ‖∂P/∂F‖ that need no eigenvectors.
//
// The stable step is found from the tangent at rest and followed by the largest ratio r of such a bound to the same
// bound at rest. Constants that both share drop out; what counts is that the bound grows whenever the tangent does.
// Isochoric and volumetric part each have their own ratio and the larger one counts: one bound is loose and the other
// tight, so that in their sum the growth of the tight one would be lost. In ±30 % of stretch the tangent's largest
// eigenvalue then stays below 1.2 r times that at rest (tests/laws/stiffness_test.cpp); a step of 0.9 h* has 1.23.
//
//   λ_max² ≤ I₁ − 2 J/√I₁ = A                          (two stretches have the product J/λ_max)
//   κ/2 (J − 1)²          κ I₂ + κ |J − 1| √A
//   w(Ī₁)                 |w₁| J^(−⅔) [ 2 + 10/9 I₁ I₂/J² + ⅔ I₁/J √A + 4/3 (√(I₁ I₂)/J − 3) ] + |w₁₁| ‖∂Ī₁‖²
//   w(Ī₂)                 the same of cof F, times A, and the slope times √A
//   Ogden                 [ 8/3 Σ |μ_k| max λ̄^α_k + 2 max |τ| ] / λ_min²
#pragma once

#include <algorithm>
#include <cmath>

#include "tissue/hyperelastic_response.h"

namespace glisson {

/// I₁, I₂ and J, kept away from where the bounds have no meaning.
struct BoundInvariants {
  double I1, I2, J;
};

inline BoundInvariants bound_invariants(const Mat3d& H) {
  const Mat3d F = deformation_gradient(H), cof = deformation_gradient(cofactor_change(H));
  return {squared_norm(F), squared_norm(cof), std::max(jacobian(H), kSmallestVolume)};
}
/// Bound of the largest stretch squared.
inline double largest_stretch_squared(const BoundInvariants& i) { return i.I1 - 2.0 * i.J / std::sqrt(i.I1); }

inline double volume_bound(const BoundInvariants& i, double bulk) {
  return bulk * (i.I2 + std::abs(i.J - 1.0) * std::sqrt(largest_stretch_squared(i)));
}

/// Bound of w ∂²Ī₁/∂F² for |w| = 1.
inline double first_invariant_bend(const BoundInvariants& i) {
  const double product = i.I1 * i.I2 / (i.J * i.J);
  const double inner = 2.0 + 10.0 / 9.0 * product + 2.0 / 3.0 * i.I1 / i.J * std::sqrt(largest_stretch_squared(i)) +
                       4.0 / 3.0 * (std::sqrt(product) - 3.0);
  return inner / std::cbrt(i.J * i.J);
}
/// ‖∂Ī₁/∂F‖².
inline double first_invariant_slope_squared(const BoundInvariants& i) {
  const double J23 = std::cbrt(i.J * i.J);
  return 4.0 / (J23 * J23) * std::max(0.0, i.I1 * i.I1 * i.I2 / (9.0 * i.J * i.J) - i.I1);
}

/// @param power  of J, J^(−⅔) or what it goes on as: an exponential of Ī₁ forgives no error in it
template <class Law>
double invariant_bound(const Law& law, const BoundInvariants& i, double power) {
  const BoundInvariants c{i.I2, i.I1 * i.J * i.J, i.J * i.J};  // those of cof F
  const double i1 = std::max(0.0, power * i.I1 - 3.0), i2 = std::max(0.0, c.I1 / std::cbrt(c.J * c.J) - 3.0);
  const auto slopes = law.slopes(Dual{i1, 1.0}, Dual{i2});
  const double A = largest_stretch_squared(i);
  const double first =
      std::abs(slopes[0].v) * first_invariant_bend(i) + std::abs(slopes[0].d) * first_invariant_slope_squared(i);
  const double second =
      std::abs(slopes[1].v) * (first_invariant_bend(c) * A + std::sqrt(first_invariant_slope_squared(c)) * 2.0);
  return first + second;
}

inline double ogden_bound(const Ogden& law, const std::array<double, 3>& b) {
  const std::array<double, 3> l = isochoric_logarithms(b).l, t = law.slopes(l);
  double bend = 0.0;
  for (std::size_t k = 0; k < law.mu.size(); ++k) {
    const double e = std::max({law.alpha[k] * l[0], law.alpha[k] * l[1], law.alpha[k] * l[2]});
    bend += 8.0 / 3.0 * std::abs(law.mu[k]) * std::exp(std::min(e, Ogden::kLargestExponent));
  }
  const double tension = std::max({std::abs(t[0]), std::abs(t[1]), std::abs(t[2])});
  const double smallest = std::max(1.0 + std::min({b[0], b[1], b[2]}), kSmallestStretch);
  return (bend + 2.0 * tension) / (smallest * smallest);
}

/// Bounds of ‖∂P/∂F‖ of the two parts of a hyperelastic law [Pa].
struct HyperelasticBound {
  double isochoric, volume;
};
inline HyperelasticBound hyperelastic_bound(const HyperelasticLaw& law, const Mat3d& H) {
  const BoundInvariants i = bound_invariants(H);
  const double isochoric = std::visit(
      [&]<class Law>(const Law& l) {
        if constexpr (std::is_same_v<Law, Ogden>) {
          return ogden_bound(l, principal_frame(H).b);
        } else {
          return invariant_bound(l, i, volume_power<2>(jacobian(H)).value);
        }
      },
      law);
  return {isochoric, volume_bound(i, bulk_modulus(law))};
}

}  // namespace glisson
