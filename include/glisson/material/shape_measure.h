// shape_measure.h — how far a tetrahedron is from its rest shape.
//
// The stiffness law needs one number per tetrahedron that ignores rotation and costs little. The paper
// takes the mean ratio against the regular tetrahedron. That number is not 1 at rest and can rise under
// compression (docs/theory.md §3), so the default compares with the rest tetrahedron instead; the paper's
// choice stays available as `regular_mean_ratio`.
//
//   F = I + H, J = det F, Ī₁ = J^(−⅔) tr(FᵀF)
//   q(F) = 3 / Ī₁                      1 at rest, blind to rotation and to uniform dilation
//   s    = √(3 (1 − q) / 2)            ≈ ‖dev ε‖
//
// 1 − q is a small difference of large numbers: near rest it is of second order in H while I₁ and J are of
// order one. All terms that cancel are cancelled on paper, with c = J^⅓ and δ = c − 1:
//   I₁ − 3 J^⅔ = 2 ‖dev ε‖² + ⅓ (3δ − t)(3δ + t) + 2 δ³ − 2 det H,   t = tr H, ε = sym H
//   3δ − t     = [ 3 (m₂ + det H) − t δ (c + 2) ] / (c² + c + 1),    m₂ = sum of the principal minors of H
#pragma once

#include <algorithm>
#include <cmath>

#include "glisson/math.h"

namespace glisson {

/// Sum of the three principal 2 × 2 minors.
template <class T>
T second_invariant(const Mat3<T>& H) {
  return H(0, 0) * H(1, 1) - H(0, 1) * H(1, 0) + H(1, 1) * H(2, 2) - H(1, 2) * H(2, 1) + H(2, 2) * H(0, 0) -
         H(2, 0) * H(0, 2);
}

/// J = det(I + H) [-], exact to rounding for small H.
template <class T>
T jacobian(const Mat3<T>& H) {
  return T(1) + (trace(H) + second_invariant(H) + determinant(H));
}

/// ‖dev sym H‖² [-].
template <class T>
T deviator_squared(const Mat3<T>& H) {
  const T third = trace(H) / T(3);
  const T a = H(0, 0) - third, b = H(1, 1) - third, c = H(2, 2) - third;
  const T xy = H(0, 1) + H(1, 0), yz = H(1, 2) + H(2, 1), zx = H(2, 0) + H(0, 2);
  return a * a + b * b + c * c + T(0.5) * (xy * xy + yz * yz + zx * zx);
}

/// 1 − q of the displacement gradient H [-], in [0, 1]; 1 where J ≤ 0 (inverted).
///   q(F) = 3 J^⅔ / tr(FᵀF)       [LiuJoe1994], with the rest tetrahedron as the reference
/// Blind to volume change; tension and compression of equal size give nearly the same value.
template <class T>
T one_minus_q(const Mat3<T>& H) {
  const T t = trace(H), m2 = second_invariant(H), det = determinant(H);
  const T J = T(1) + (t + m2 + det);
  if (!(J > T(0))) return T(1);
  using std::cbrt;
  const T c = cbrt(J);
  const T sum = c * c + c + T(1);
  const T delta = (t + m2 + det) / sum;
  const T difference = (T(3) * (m2 + det) - t * delta * (c + T(2))) / sum;  // 3δ − t
  T squares = T(0);
  for (const auto& row : H.m) {
    for (const T h : row) squares += h * h;
  }
  const T I1 = T(3) + T(2) * t + squares;
  const T numerator =
      T(2) * deviator_squared(H) + difference * (T(3) * delta + t) / T(3) + T(2) * delta * delta * delta - T(2) * det;
  return std::clamp(numerator / I1, T(0), T(1));
}

/// q(F) in [0, 1]: 1 exactly for the rest shape, 0 where J ≤ 0.
template <class T>
T mean_ratio(const Mat3<T>& H) {
  return T(1) - one_minus_q(H);
}

/// Equivalent shear strain s = √(3 (1 − q) / 2) [-]; equals ‖dev ε‖ to first order, at most √1.5.
template <class T>
T intensity_of(T one_minus_q_value) {
  using std::sqrt;
  return sqrt(T(1.5) * one_minus_q_value);
}

/// The six numbers that the raw mean ratio needs of a rest tetrahedron: Σ l lᵀ over its edges [m²].
template <class T>
struct EdgeMetric {
  T xx{}, yy{}, zz{}, xy{}, yz{}, zx{};
};

/// The paper's raw measure, 12 (3V)^⅔ / Σ l² = 12 (3 V₀ J)^⅔ / tr(F G Fᵀ), in [0, 1].
/// @param rest_volume V₀ [m³]
/// @param G           Σ l lᵀ of the rest edges [m²]
template <class T>
T regular_mean_ratio(const Mat3<T>& H, T rest_volume, const EdgeMetric<T>& G) {
  const T J = jacobian(H);
  if (!(J > T(0))) return T(0);
  T sum = T(0);
  for (std::size_t i = 0; i < 3; ++i) {
    const T x = H(i, 0) + T(i == 0 ? 1 : 0), y = H(i, 1) + T(i == 1 ? 1 : 0), z = H(i, 2) + T(i == 2 ? 1 : 0);
    sum += x * x * G.xx + y * y * G.yy + z * z * G.zz + T(2) * (x * y * G.xy + y * z * G.yz + z * x * G.zx);
  }
  using std::cbrt;
  const T c = cbrt(T(3) * rest_volume * J);
  return T(12) * c * c / sum;
}

}  // namespace glisson
