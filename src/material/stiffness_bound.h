// stiffness_bound.h — how stiff a tet may have become: bounds of ‖∂P/∂F‖ that need no eigenvectors.
//
// The stable step is found from the tangent at rest and followed by the largest ratio r of such a bound to the same
// bound at rest. Constants that both share drop out; what counts is that the bound grows whenever the tangent does.
// Isochoric and volumetric part each have their own ratio and the larger one counts: one bound is loose and the other
// tight, so that in their sum the growth of the tight one would be lost. In ±30 % of stretch the tangent's largest
// eigenvalue then stays below 1.2 r times that at rest (tests/material/stiffness_test.cpp); a step of 0.9 h* has 1.23.
//
//   λ_max² ≤ I₁ − 2 J/√I₁ = A                          (two stretches have the product J/λ_max; J ≥ 0)
//   κ/2 (J − 1)²          κ I₂ + κ |J − 1| √A          for J < 0 and J > 1 √(2 I₁) in the place of √A
//   w(Ī₁)                 |w₁| J^(−⅔) [ 2 + 10/9 I₁ I₂/J² + ⅔ I₁/J √A + 4/3 (√(I₁ I₂)/J − 3) ] + |w₁₁| ‖∂Ī₁‖²
//   w(Ī₂)                 the same of cof F, times A, and the slope times √A; |w₂₂| ‖∂Ī₂‖² and 2 |w₁₂| ‖∂Ī₁‖ ‖∂Ī₂‖ with
//                         ‖∂Ī₂‖² = 4 J^(−8/3) [ 4/9 I₂³/J² − 5/3 I₁ I₂ + 3 J² ]
//   Ogden                 the tangent itself: its matrix in the principal frame has 3 × 3 and six numbers beside
//
// Below J = 0.2 powers of J go on as volume_powers.h says, and with a(J), b(J) for J^(−⅔), J^(−4/3)
//   w(a I₁)               |w₁| [ 2 a + |a'| ( 2 √(I₁ I₂) − 6 J + I₁ √A ) + |a''| I₁ I₂ ] + |w₁₁| ‖2 a F + a' I₁ cof F‖²
//   w(b I₂)               |w₂| [ 4 b (I₁ + √I₂) + |b'| I₂ ( 4 √(2 I₁) + √A ) + |b''| I₂² ] + |w₂₂| ‖∂(b I₂)‖²,
//                         ‖∂(b I₂)‖² = 4 b² (I₁ I₂ + 3 J²) + 8 b b' J I₁ I₂ + b'² I₂³, and the product of both with 2 |w₁₂|
// J itself counts there, which is 0 or less: held at the limit, A is too small and may fall below 0.
#pragma once

#include <algorithm>
#include <cmath>

#include "material/hyperelastic_response.h"

namespace glisson {

/// Stretches whose sum is less count as this far apart: where λ_i = −λ_j the tangent of an inverted tet has no bound.
inline constexpr double kSmallestFlip = 0.05;

/// How stiff a corotational tet of stretch U = I + B is against turning: at rest not at all, for there the rotation follows at no
/// cost. Of the tangent 2 μ (I − ∂R/∂F) + λ [ R ⊗ R + tr B ∂R/∂F ], with 2/(s_i + s_j) for eigenvalues of ∂R/∂F, the part
/// 2 (λ tr B − 2 μ)/(s_i + s_j) where it is above 0; s_i + s_j ≥ tr U − ‖U‖.
/// @param trace, squares  tr B, B:B
inline double turning_bound(double trace, double squares, double lambda, double mu) {
  const double pull = std::max(lambda * trace - 2.0 * mu, 0.0);
  const double pair = trace + 3.0 - std::sqrt(std::max(squares + 2.0 * trace + 3.0, 0.0));
  return 2.0 * pull / std::max(pair, kSmallestFlip);
}

/// I₁, I₂ and J.
struct BoundInvariants {
  double I1, I2, J;
};

inline BoundInvariants bound_invariants(const Mat3d& H) {
  const Mat3d F = deformation_gradient(H), cof = deformation_gradient(cofactor_change(H));
  return {squared_norm(F), squared_norm(cof), jacobian(H)};
}
/// Bound of the largest stretch squared.
inline double largest_stretch_squared(const BoundInvariants& i) {
  return i.J > 0.0 ? std::max(0.0, i.I1 - 2.0 * i.J / std::sqrt(i.I1)) : i.I1;
}

/// Bound of what a negative multiple of ∂cof F/∂F has for a largest eigenvalue, over that multiple: λ_max; the two largest
/// stretches together where the multiple is positive or the tet inside out.
inline double cofactor_bend(const BoundInvariants& i, bool positive) {
  return std::sqrt(positive || i.J < 0.0 ? 2.0 * i.I1 : largest_stretch_squared(i));
}
inline double volume_bound(const BoundInvariants& i, double bulk) {
  return bulk * (i.I2 + std::abs(i.J - 1.0) * cofactor_bend(i, i.J > 1.0));
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

/// ‖∂Ī₂/∂F‖².
inline double second_invariant_slope_squared(const BoundInvariants& i) {
  const double J2 = i.J * i.J, J43 = std::cbrt(J2 * J2);
  const double inner = 4.0 / 9.0 * i.I2 * i.I2 * i.I2 / J2 - 5.0 / 3.0 * i.I1 * i.I2 + 3.0 * J2;
  return 4.0 / (J43 * J43) * std::max(0.0, inner);
}

/// What ∂²W/∂Ī² adds to the bound. @param first, second  ‖∂Ī₁/∂F‖², ‖∂Ī₂/∂F‖²
inline double curvature_bound(const InvariantSlopes<double>& w, double first, double second) {
  return std::abs(w.bend) * first + std::abs(w.second_bend) * second +
         2.0 * std::abs(w.mixed) * std::sqrt(std::max(0.0, first * second));
}

/// For J ≥ kSmallestVolume.
template <class Law>
double invariant_bound(const Law& law, const BoundInvariants& i) {
  const BoundInvariants c{i.I2, i.I1 * i.J * i.J, i.J * i.J};  // those of cof F
  const double J23 = std::cbrt(i.J * i.J);
  const InvariantSlopes<double> w =
      slopes_at(law, std::max(0.0, i.I1 / J23 - 3.0), [&] { return i.I2 / (J23 * J23) - 3.0; });
  const double A = largest_stretch_squared(i);
  double bound = std::abs(w.first) * first_invariant_bend(i);
  bound += curvature_bound(w, first_invariant_slope_squared(i), second_invariant_slope_squared(i));
  const double second =
      std::abs(w.second) * (first_invariant_bend(c) * A + std::sqrt(first_invariant_slope_squared(c)) * 2.0);
  return bound + second;
}

/// The same where powers of J go on below their limit.
template <class Law>
double collapsed_bound(const Law& law, const BoundInvariants& i) {
  const ValueSlope<Dual> a = volume_power<2>(Dual{i.J, 1.0}), b = volume_power<4>(Dual{i.J, 1.0});
  // a tet that has shrunk to little has Ī < 3, where a square is steep, too
  const double excess = a.value.v * i.I1 - 3.0, least = Law::kSecond == SecondInvariant::general ? -3.0 : 0.0;
  const InvariantSlopes<double> w = slopes_at(law, std::max(least, excess), [&] { return b.value.v * i.I2 - 3.0; });
  const double product = std::sqrt(i.I1 * i.I2), stretch = cofactor_bend(i, false);
  const double a1 = std::abs(a.slope.v), b1 = std::abs(b.slope.v);
  const double bend =
      2.0 * a.value.v + a1 * (2.0 * product - 6.0 * i.J + i.I1 * stretch) + std::abs(a.slope.d) * product * product;
  const double slope_squared =
      i.I1 * (4.0 * a.value.v * (a.value.v + 3.0 * a.slope.v * i.J) + a1 * a1 * product * product);
  const double second = 4.0 * b.value.v * (i.I1 + std::sqrt(i.I2)) +
                        b1 * i.I2 * (4.0 * std::sqrt(2.0 * i.I1) + stretch) + std::abs(b.slope.d) * i.I2 * i.I2;
  const double second_slope_squared = 4.0 * b.value.v * b.value.v * (i.I1 * i.I2 + 3.0 * i.J * i.J) +
                                      i.I2 * b.slope.v * (8.0 * b.value.v * i.J * i.I1 + b.slope.v * i.I2 * i.I2);
  return std::abs(w.first) * bend + curvature_bound(w, slope_squared, second_slope_squared) +
         std::abs(w.second) * second;
}

/// λ_max of ∂P/∂F of P = Σ p_i u_i ⊗ n_i, from the entries of ∂p_i/∂λ_j and of each pair (p_i ∓ p_j)/(λ_i ∓ λ_j)
/// (principal.h) [Pa].
/// @param w  as in isotropic_piola
template <class W>
double stiffest_of_isotropic(const std::array<double, 3>& b, const W& w) {
  constexpr double kClose =
      1e-4;  // of stretches: nearer ones take the limit; further apart than this, inverted ones count
  std::array<std::array<double, 3>, 3> A;
  std::array<double, 3> p{};
  for (std::size_t j = 0; j < 3; ++j) {
    std::array<Dual, 3> at{Dual{b[0]}, Dual{b[1]}, Dual{b[2]}};
    at[j].d = 1.0;
    const std::array<Dual, 3> q = w(at);
    for (std::size_t i = 0; i < 3; ++i) A[i][j] = q[i].d, p[i] = q[i].v;
  }
  double most = largest_eigenvalue(Sym3<double>{A[0][0], A[1][1], A[2][2], A[0][1], A[1][2], A[2][0]});
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const double difference = b[i] - b[j], total = std::max(2.0 + b[i] + b[j], kSmallestFlip);
    const double even =
        std::abs(difference) < kClose ? 0.5 * (A[i][i] + A[j][j] - A[i][j] - A[j][i]) : (p[i] - p[j]) / difference;
    most = std::max({most, even, (p[i] + p[j]) / total});
  }
  return most;
}

template <StretchLaw Law>
double stretch_bound(const Law& law, const std::array<double, 3>& b) {
  return stiffest_of_isotropic(b, [&](const std::array<Dual, 3>& at) {
    const IsochoricLogarithms<Dual> ln = isochoric_logarithms(at);
    const std::array<Dual, 3> t = law.slopes(ln.l);
    return std::array<Dual, 3>{t[0] * ln.slope[0], t[1] * ln.slope[1], t[2] * ln.slope[2]};
  });
}

/// Bounds of ‖∂P/∂F‖ of the two parts of a hyperelastic law [Pa].
struct HyperelasticBound {
  double isochoric, volume;
};
inline HyperelasticBound hyperelastic_bound(const HyperelasticLaw& law, const Mat3d& H) {
  const BoundInvariants i = bound_invariants(H);
  const double isochoric = std::visit(
      [&]<class Law>(const Law& l) {
        if constexpr (StretchLaw<Law>) {
          return stretch_bound(l, principal_frame(H).b);
        } else {
          return i.J >= kSmallestVolume ? invariant_bound(l, i) : collapsed_bound(l, i);
        }
      },
      law);
  return {isochoric, volume_bound(i, bulk_modulus(law))};
}

}  // namespace glisson
