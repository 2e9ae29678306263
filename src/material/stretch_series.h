// stretch_series.h — Ogden's law where a tet's stretches are close to each other: a polynomial, no eigenvalues.
//
// With C = m (I + X), m = ⅓ tr C, X is traceless and the whole of the shape's change. Its powers are combinations of I, X
// and X² (Cayley and Hamilton), so that any isotropic function of C̄ = C/J^⅔ is one too:
//
//   Σ t_i n_i ⊗ n_i = q₁ X + q₂ dev X²,   t_i = ∂W/∂ln λ_i,   q₁, q₂ power series of J₂ = ½ X:X and J₃ = det X
//
//   (I + X)^a = Σ_n binom(a, n) X^n,   X^n = α_n X² + α_(n+1) X + α_(n−1) J₃ I,   α_(n+2) = J₂ α_n + J₃ α_(n−1), α₂ = 1
//
// The series are cut off behind the fourteenth power of X; up to `largest_J2` what is left out is below the rounding of floats.
#pragma once

#include <array>
#include <cstddef>

#include "glisson/material/hyperelastic_law.h"
#include "glisson/material/scalar.h"

namespace glisson {

/// Number is double, or float for lanes.
template <class Number = double>
struct StretchSeries {
  static constexpr std::size_t kOrder = 14;
  /// How many powers of J₂ go with the j-th power of J₃: 2 i + 3 j ≤ kOrder.
  static constexpr std::array<std::size_t, 5> kPowers{8, 6, 5, 3, 2};
  using Coefficients = std::array<std::array<Number, kPowers[0]>, kPowers.size()>;  ///< [power of J₃][power of J₂]

  Coefficients first{}, second{};  ///< of q₁ and q₂ [Pa]
  Number largest_J2 = 0;           ///< where the series hold; 0: nowhere
  /// λ_max of the tangent of the isochoric part is at most (b₀ + b₁ δ + b₂ δ² + b₃ J₃/δ)/m [Pa], and at least 1/1.2 of it;
  /// δ² = 4/3 J₂, for δ is the largest that an eigenvalue of X can be.
  std::array<Number, 4> bound{};

  StretchSeries<float> rounded() const;
};

StretchSeries<> stretch_series(const Ogden& law);

/// Σ c_ij J₂^i J₃^j, on numbers or lanes.
template <class T, class Coefficients>
GLISSON_FORMULA T series_at(const Coefficients& c, T J2, T J3) {
  using namespace scalar;
  T sum(0.0);
  for (std::size_t j = StretchSeries<>::kPowers.size(); j-- > 0;) {
    T row(c[j][StretchSeries<>::kPowers[j] - 1]);
    for (std::size_t i = StretchSeries<>::kPowers[j] - 1; i-- > 0;) row = mul_add(row, J2, T(c[j][i]));
    sum = mul_add(sum, J3, row);
  }
  return sum;
}

}  // namespace glisson
