// drag_stages.h — the viscous force of a step in stages: explicit steps of the velocities alone, within a step.
//
//   w₀ = v₋,   w_k = w_{k−1} + τ_k h M⁻¹ (f − C w_{k−1}),   Σ τ_k = 1,   v₊ = w_n        f: elastic and outer forces at u(t)
//
// Tissue that moves steadily, f = C v, is exact at any step: the forces are those of the explicit scheme. With z an eigenvalue of
// h M⁻¹ C,
//   v₊ = R(z) v₋ + h φ(z) M⁻¹ f,     R(z) = Π (1 − τ_k z) = ½ [1 + T_n(1 − 2 z/n²)],     φ(z) = (1 − R)/z,
// T_n Chebyshev's polynomial. R is in [0, 1] up to z = n², where n steps of explicit drag reach 2n [VerwerHundsdorferSommeijer1990].
// φ(hM⁻¹C)⁻¹ M takes the place of the mass, so that the step is stable where
//   h² K ≤ 2 M (1 + R)/φ,       and (1 + R)/φ is at least 1.66 for two stages, 1.75 for three and 1.82 for many: 0.91 to 0.95 of the elastic step.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace glisson {

/// τ_1 … τ_n, the longest last. n = 1: the whole step.
inline std::vector<double> drag_stages(int n) {
  if (n <= 1) return {1.0};
  std::vector<double> steps;
  for (int j = 1; j <= n; ++j) {
    steps.push_back(2.0 / (n * n * (1.0 - std::cos((2 * j - 1) * std::numbers::pi / n))));
  }
  std::sort(steps.begin(), steps.end());
  return steps;
}

/// The least of (1 + R)/φ over z from 0 to n², from below.
inline double drag_stage_room(int n) {
  constexpr int kSamples = 20000;
  double least = 2.0;
  for (int i = 1; i < kSamples; ++i) {
    const double x = static_cast<double>(i) / kSamples, R = 0.5 * (1.0 + std::cos(n * std::acos(1.0 - 2.0 * x)));
    if (R < 1.0) least = std::min(least, (1.0 + R) * x * n * n / (1.0 - R));
  }
  return (1.0 - 1e-4) * least;
}

}  // namespace glisson
