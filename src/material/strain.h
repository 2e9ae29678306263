// strain.h — symmetric tensors, strains and cofactors of a displacement gradient H = F − I, formed without loss of digits.
#pragma once

#include <algorithm>
#include <cmath>

#include "glisson/math.h"

namespace glisson {

/// A symmetric tensor.
template <class T>
struct Sym3 {
  T xx{}, yy{}, zz{}, xy{}, yz{}, zx{};

  friend Vec3<T> operator*(const Sym3& a, const Vec3<T>& v) {
    return {a.xx * v.x + a.xy * v.y + a.zx * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
            a.zx * v.x + a.yz * v.y + a.zz * v.z};
  }
  friend Sym3 operator+(const Sym3& a, const Sym3& b) {
    return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.yz + b.yz, a.zx + b.zx};
  }
  friend Sym3 operator-(const Sym3& a, const Sym3& b) { return a + b * T(-1.0); }
  friend Sym3 operator*(const Sym3& a, T s) { return {a.xx * s, a.yy * s, a.zz * s, a.xy * s, a.yz * s, a.zx * s}; }
  Sym3& operator+=(const Sym3& b) { return *this = *this + b; }
  friend bool operator==(const Sym3&, const Sym3&) = default;
  void archive(auto& ar) { ar(xx, yy, zz, xy, yz, zx); }
};

template <class T>
T trace(const Sym3<T>& a) {
  return a.xx + a.yy + a.zz;
}
/// a : b
template <class T>
T contract(const Sym3<T>& a, const Sym3<T>& b) {
  return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + T(2.0) * (a.xy * b.xy + a.yz * b.yz + a.zx * b.zx);
}
template <class T>
Mat3<T> full(const Sym3<T>& a) {
  return {{{{a.xx, a.xy, a.zx}, {a.xy, a.yy, a.yz}, {a.zx, a.yz, a.zz}}}};
}
/// ½ (A + Aᵀ)
template <class T>
Sym3<T> symmetric(const Mat3<T>& a) {
  const T half(0.5);
  return {
      a(0, 0), a(1, 1), a(2, 2), half * (a(0, 1) + a(1, 0)), half * (a(1, 2) + a(2, 1)), half * (a(2, 0) + a(0, 2))};
}

/// λ_max of a symmetric tensor q I + p B with tr B = 0: q + 2 p cos(⅓ arccos(½ det B)).
inline double largest_eigenvalue(Sym3<double> a) {
  const double q = (a.xx + a.yy + a.zz) / 3.0;
  a.xx -= q, a.yy -= q, a.zz -= q;
  const double squares = a.xx * a.xx + a.yy * a.yy + a.zz * a.zz + 2.0 * (a.xy * a.xy + a.yz * a.yz + a.zx * a.zx);
  const double p = std::sqrt(squares / 6.0);
  if (!(p > 0.0)) return q;
  const double det =
      a.xx * (a.yy * a.zz - a.yz * a.yz) - a.xy * (a.xy * a.zz - a.yz * a.zx) + a.zx * (a.xy * a.yz - a.yy * a.zx);
  return q + 2.0 * p * std::cos(std::acos(std::clamp(0.5 * det / (p * p * p), -1.0, 1.0)) / 3.0);
}

/// σ = λ tr(ε) I + 2 μ ε with ε = sym H: Hooke's law of the small-strain tensor, [Schwartz2002, eq. 1]
/// without tensors. With (a, b) for (λ, μ) and a velocity gradient for H it is the viscous stress.
template <class T>
Sym3<T> isotropic_stress(const Mat3<T>& H, T lambda, T mu) {
  const T p = lambda * trace(H), two_mu = mu + mu;
  return {p + two_mu * H(0, 0),     p + two_mu * H(1, 1),     p + two_mu * H(2, 2),
          mu * (H(0, 1) + H(1, 0)), mu * (H(1, 2) + H(2, 1)), mu * (H(2, 0) + H(0, 2))};
}
/// The same of a strain.
template <class T>
Sym3<T> isotropic_stress(const Sym3<T>& strain, T lambda, T mu) {
  const T p = lambda * trace(strain), two_mu = mu + mu;
  Sym3<T> s = strain * two_mu;
  s.xx += p, s.yy += p, s.zz += p;
  return s;
}

template <class T>
Mat3<T> sum(const Mat3<T>& a, const Mat3<T>& b) {
  Mat3<T> r;
  for (std::size_t i = 0; i < 9; ++i) r(i / 3, i % 3) = a(i / 3, i % 3) + b(i / 3, i % 3);
  return r;
}
template <class T>
Mat3<T> scaled(const Mat3<T>& a, T s) {
  Mat3<T> r;
  for (std::size_t i = 0; i < 9; ++i) r(i / 3, i % 3) = a(i / 3, i % 3) * s;
  return r;
}
template <class T>
Mat3<T> product(const Mat3<T>& a, const Mat3<T>& b) {
  Mat3<T> r;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) r(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
  }
  return r;
}
/// Aᵀ B
template <class T>
Mat3<T> transposed_product(const Mat3<T>& a, const Mat3<T>& b) {
  Mat3<T> r;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) r(i, j) = a(0, i) * b(0, j) + a(1, i) * b(1, j) + a(2, i) * b(2, j);
  }
  return r;
}
/// F = I + H
template <class T>
Mat3<T> deformation_gradient(Mat3<T> H) {
  for (std::size_t i = 0; i < 3; ++i) H(i, i) = H(i, i) + T(1.0);
  return H;
}

/// E = ½ (FᵀF − I) = sym H + ½ HᵀH.
template <class T>
Sym3<T> green_strain(const Mat3<T>& H) {
  return symmetric(H) + symmetric(transposed_product(H, H)) * T(0.5);
}
/// Ė = sym(Fᵀ Ḣ).
template <class T>
Sym3<T> green_rate(const Mat3<T>& H, const Mat3<T>& rate) {
  return symmetric(rate) + symmetric(transposed_product(H, rate));
}

/// cof A: ∂(det A)/∂A.
template <class T>
Mat3<T> cofactors(const Mat3<T>& a) {
  Mat3<T> c;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      c(i, j) = a(i1, j1) * a(i2, j2) - a(i1, j2) * a(i2, j1);
    }
  }
  return c;
}
/// K = cof(I + H) − I = (tr H) I − Hᵀ + cof H, of the order of H.
template <class T>
Mat3<T> cofactor_change(const Mat3<T>& H) {
  Mat3<T> K = cofactors(H);
  const T t = trace(H);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) K(i, j) = K(i, j) - H(j, i);
    K(i, i) = K(i, i) + t;
  }
  return K;
}
/// The same numbers in another scalar.
template <class T>
Mat3<T> with_scalar(const Mat3d& a) {
  Mat3<T> r;
  for (std::size_t i = 0; i < 9; ++i) r(i / 3, i % 3) = T(a(i / 3, i % 3));
  return r;
}
template <class T>
Sym3<T> with_scalar(const Sym3<double>& a) {
  return {T(a.xx), T(a.yy), T(a.zz), T(a.xy), T(a.yz), T(a.zx)};
}
/// Σ a_ij²
template <class T>
T squared_norm(const Mat3<T>& a) {
  T sum(0.0);
  for (const auto& row : a.m) {
    for (const T x : row) sum += x * x;
  }
  return sum;
}

}  // namespace glisson
