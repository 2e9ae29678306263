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

/// @param h  [s], ≥ 0 and may be infinite
/// @param time  τ [s], > 0
inline BranchWeights<> branch_weights(double h, double time) { return weights_over(h / time); }

}  // namespace glisson
