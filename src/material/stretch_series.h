// stretch_series.h — Ogden's law where a tet's stretches are close to each other: a polynomial, no eigenvalues.
//
// With C = m (I + X), m = ⅓ tr C, X is traceless and the whole of the shape's change. Its powers are combinations of I, X
// and X² (Cayley and Hamilton), so that any isotropic function of C̄ = C/J^⅔ is one too:
//
//   Σ t_i n_i ⊗ n_i = q₁ X + q₂ dev X²,   t_i = ∂W/∂ln λ_i,   q₁, q₂ power series of J₂ = ½ X:X and J₃ = det X
//
// Series: material/invariant_series.h. Up to `largest_J2` what is left out is below the rounding of floats.
#pragma once

#include <array>

#include "glisson/material/hyperelastic_law.h"
#include "material/invariant_series.h"

namespace glisson {

/// Number is double, or float for lanes.
template <class Number = double>
struct StretchSeries {
  InvariantSeries<Number> first{}, second{};  ///< of q₁ and q₂ [Pa]
  Number largest_J2 = 0;                      ///< where the series hold; 0: nowhere
  /// λ_max of the tangent of the isochoric part is at most (b₀ + b₁ δ + b₂ δ² + b₃ J₃/δ)/m [Pa], and at least 1/1.2 of it;
  /// δ² = 4/3 J₂, for δ is the largest that an eigenvalue of X can be.
  std::array<Number, 4> bound{};

  StretchSeries<float> rounded() const;
};

StretchSeries<> stretch_series(const Ogden& law);

}  // namespace glisson
