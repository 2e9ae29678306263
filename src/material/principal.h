// principal.h — principal stretches and rotation of a deformation gradient, safe for inverted and flat tets.
//
// F = I + H = Σ λ_i u_i ⊗ n_i with λ₁ ≥ λ₂ ≥ |λ₃|, u and n right-handed: λ₃ < 0 exactly where J < 0, so that an
// inverted tet is told the shortest way back [Irving2004]. b_i = λ_i − 1 is formed from the Green strain, whose small
// eigenvalues keep their digits.
//
// An isotropic tissue has P = Σ w_i(b) u_i ⊗ n_i. Its derivative follows from the same numbers: with A = Uᵀ dF N,
//   diagonal        Σ_j ∂w_i/∂λ_j A_jj
//   off-diagonal    (w_i − w_j)/(λ_i − λ_j) sym A + (w_i + w_j)/(λ_i + λ_j) skew A
#pragma once

#include <array>

#include "material/dual.h"
#include "material/strain.h"

namespace glisson {

struct PrincipalFrame {
  std::array<double, 3> b{};  ///< λ_i − 1
  Mat3d u, n;                 ///< columns u_i, n_i; det = +1
};

PrincipalFrame principal_frame(const Mat3d& H);

namespace detail {

inline Mat3d values_of(const Mat3<Dual>& a) {
  Mat3d r;
  for (std::size_t i = 0; i < 9; ++i) r(i / 3, i % 3) = a(i / 3, i % 3).v;
  return r;
}
inline Mat3d derivatives_of(const Mat3<Dual>& a) {
  Mat3d r;
  for (std::size_t i = 0; i < 9; ++i) r(i / 3, i % 3) = a(i / 3, i % 3).d;
  return r;
}
/// U W Nᵀ
inline Mat3d out_of_frame(const PrincipalFrame& f, const Mat3d& W) {
  const Mat3d left = product(f.u, W);
  Mat3d r;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      r(i, j) = left(i, 0) * f.n(j, 0) + left(i, 1) * f.n(j, 1) + left(i, 2) * f.n(j, 2);
    }
  }
  return r;
}
inline Mat3d diagonal(double a, double b, double c) { return {{{{a, 0.0, 0.0}, {0.0, b, 0.0}, {0.0, 0.0, c}}}}; }

}  // namespace detail

/// P = Σ w_i(b) u_i ⊗ n_i.
/// @param w  std::array<T, 3> → std::array<T, 3> for T double and Dual; symmetric in its arguments
template <class W>
Mat3d isotropic_piola(const Mat3d& H, const W& w) {
  const PrincipalFrame f = principal_frame(H);
  const std::array<double, 3> p = w(f.b);
  return detail::out_of_frame(f, detail::diagonal(p[0], p[1], p[2]));
}

/// The same with its derivative.
template <class W>
Mat3<Dual> isotropic_piola(const Mat3<Dual>& H, const W& w) {
  const PrincipalFrame f = principal_frame(detail::values_of(H));
  const Mat3d A = product(transposed_product(f.u, detail::derivatives_of(H)), f.n);
  using Duals = std::array<Dual, 3>;
  const Duals p = w(Duals{Dual{f.b[0], A(0, 0)}, Dual{f.b[1], A(1, 1)}, Dual{f.b[2], A(2, 2)}});
  Mat3d dW = detail::diagonal(p[0].d, p[1].d, p[2].d);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    constexpr double kClose = 1e-6;  // of stretches: nearer ones take the limit
    const double difference = f.b[i] - f.b[j], total = 2.0 + f.b[i] + f.b[j];
    double minus = (p[i].v - p[j].v) / difference;
    if (std::abs(difference) < kClose) {
      Duals apart{Dual{f.b[0]}, Dual{f.b[1]}, Dual{f.b[2]}};
      apart[i].d = 1.0, apart[j].d = -1.0;
      const Duals q = w(apart);
      minus = 0.5 * (q[i].d - q[j].d);
    }
    const double plus = (p[i].v + p[j].v) / (std::abs(total) > kClose ? total : kClose);
    const double even = 0.5 * (A(i, j) + A(j, i)), odd = 0.5 * (A(i, j) - A(j, i));
    dW(i, j) = minus * even + plus * odd;
    dW(j, i) = minus * even - plus * odd;
  }
  const Mat3d P = detail::out_of_frame(f, detail::diagonal(p[0].v, p[1].v, p[2].v)), dP = detail::out_of_frame(f, dW);
  Mat3<Dual> out;
  for (std::size_t k = 0; k < 9; ++k) out(k / 3, k % 3) = {P(k / 3, k % 3), dP(k / 3, k % 3)};
  return out;
}

}  // namespace glisson
