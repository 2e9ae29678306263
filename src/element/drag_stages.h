// drag_stages.h — the viscous force of a step in stages: explicit steps of the velocities alone, within a step.
//
//   w₀ = v₋,   w_k = w_{k−1} + τ_k h M⁻¹ (f − C w_{k−1}),   Σ τ_k = 1,   v₊ = w_n        f: elastic and outer forces at u(t)
//
// Tissue that moves steadily, f = C v, is exact at any step: the forces are those of the explicit scheme. With z an eigenvalue of
// h M⁻¹ C,
//   v₊ = R(z) v₋ + h φ(z) M⁻¹ f,     R(z) = Π (1 − τ_k z) = [1 + T_n(a − b z)]/[1 + T_n(a)],     φ(z) = (1 − R)/z,
// T_n Chebyshev's polynomial, T_n(a) = 1 + ε, and b such that R′(0) = −1. R is in [0, 1] up to z = (1 + a)/b, nearly n², where n steps of
// explicit drag reach 2n [VerwerHundsdorferSommeijer1990]. Without ε, R would be 1 and φ 0 at some z in between: such motions would lose
// nothing in a step and answer to no force but to the impulses of instruments, which act after the stages.
// φ(hM⁻¹C)⁻¹ M takes the place of the mass, so that the step is stable where h² K ≤ 2 M (1 + R)/φ.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace glisson {

/// ε. It takes 6 % of the reach of the stages, and leaves a motion 0.8 of its velocity in a step at most.
inline constexpr double kStageDamping = 0.5;

/// R of n stages.
struct DragPolynomial {
  int n = 1;
  double a = 1.0, b = 1.0, top = 2.0;  ///< top: 1 + T_n(a)

  explicit DragPolynomial(int stages) : n(stages) {
    const double angle = std::acosh(1.0 + kStageDamping) / n;
    a = std::cosh(angle);
    top = 2.0 + kStageDamping;
    b = top / (n * std::sinh(n * angle) / std::sinh(angle));
  }
  double end() const { return (1.0 + a) / b; }
  /// @param z  up to end()
  double operator()(double z) const {
    const double x = a - b * z;
    const double chebyshev = x > 1.0 ? std::cosh(n * std::acosh(x)) : std::cos(n * std::acos(std::max(-1.0, x)));
    return (1.0 + chebyshev) / top;
  }
};

/// τ_1 … τ_n, the longest last. n = 1: the whole step.
inline std::vector<double> drag_stages(int n) {
  if (n <= 1) return {1.0};
  const DragPolynomial R(n);
  std::vector<double> steps;
  for (int j = 1; j <= n; ++j) steps.push_back(R.b / (R.a - std::cos((2 * j - 1) * std::numbers::pi / n)));
  std::sort(steps.begin(), steps.end());
  return steps;
}

/// The least of (1 + R)/φ over z up to the end, from below.
inline double drag_stage_room(int n) {
  constexpr int kSamples = 20000;
  const DragPolynomial R(n);
  double least = 2.0;
  for (int i = 1; i < kSamples; ++i) {
    const double z = R.end() * i / kSamples, left = R(z);
    if (left < 1.0) least = std::min(least, (1.0 + left) * z / (1.0 - left));
  }
  return (1.0 - 1e-4) * least;
}

}  // namespace glisson
