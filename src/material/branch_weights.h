// branch_weights.h — a Maxwell branch over one step: q' = (S − q)/τ, exact for S linear in time.
#pragma once

#include <cmath>
#include <cstddef>

#include "material/dual.h"

namespace glisson {

/// Branches that a tissue may have.
inline constexpr std::size_t kMostBranches = 8;

/// q(t + h) = decay q(t) + from S(t) + to S(t + h).
template <class T = double>
struct BranchWeights {
  T decay, from, to;
};

/// @param x  ∫ dt/τ over the step [-], ≥ 0 and may be infinite: q = S then
template <class T>
BranchWeights<T> weights_over(T x) {
  using std::expm1;
  if (!(x > T(0.0))) return {T(1.0), T(0.0), T(0.0)};
  if (std::isinf(value_of(x))) return {T(0.0), T(0.0), T(1.0)};
  const T rise = -expm1(-x);                                                 // 1 − e⁻ˣ
  const T to = x < T(1e-3) ? x * (T(0.5) - x / T(6.0)) : T(1.0) - rise / x;  // without cancellation
  return {T(1.0) - rise, rise - to, to};
}

/// Weights for explicit steps in which x changes from one to the next: q(t + h) = e^(−x) q(t) + ½ (1 − e^(−x)) (S(t) + S(t + h)).
///
/// The overstress o = S − q then goes on by o₁ = e^(−x) o₀ + ½ (1 + e^(−x)) ΔS, and of the work of the central difference,
/// ½ (o₀ + o₁) Δε, what the spring does not hold is a square, whatever x is: ½ (o₀ + o₁)² (1 − e^(−x))/(1 + e^(−x)) over the
/// modulus. So a branch takes energy in every single step (docs/theory.md §7). They differ from those above by x²/12.
template <class T>
BranchWeights<T> passive_weights_over(T x) {
  using std::expm1;
  const T rise = x > T(0.0) ? -expm1(-x) : T(0.0);
  return {T(1.0) - rise, T(0.5) * rise, T(0.5) * rise};
}

/// @param h  [s], ≥ 0 and may be infinite
/// @param time  τ [s], > 0
inline BranchWeights<> branch_weights(double h, double time) { return weights_over(h / time); }

}  // namespace glisson
