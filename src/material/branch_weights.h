// branch_weights.h — a Maxwell branch over one step: q' = (S − q)/τ, exact for S linear in time.
#pragma once

#include <cmath>
#include <cstddef>

namespace glisson {

/// Branches that a tissue may have.
inline constexpr std::size_t kMostBranches = 8;

/// q(t + h) = decay q(t) + from S(t) + to S(t + h).
struct BranchWeights {
  double decay, from, to;
};

/// @param h  [s], ≥ 0 and may be infinite: q = S then
/// @param time  τ [s], > 0
inline BranchWeights branch_weights(double h, double time) {
  const double x = h / time;
  if (!(x > 0.0)) return {1.0, 0.0, 0.0};
  const double rise = -std::expm1(-x);                                // 1 − e⁻ˣ
  const double to = x < 1e-3 ? x * (0.5 - x / 6.0) : 1.0 - rise / x;  // without cancellation
  return {1.0 - rise, rise - to, to};
}

}  // namespace glisson
