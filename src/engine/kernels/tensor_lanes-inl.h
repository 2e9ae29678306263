// tensor_lanes-inl.h — 3 × 3 tensors in lanes, as src/material/strain.h has them for one tet.
//
// Included once per instruction set, never from outside kernels.cpp, response_kernels.cpp and response_flops.cpp.
#if defined(GLISSON_TENSOR_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_TENSOR_LANES_INL_H_
#undef GLISSON_TENSOR_LANES_INL_H_
#else
#define GLISSON_TENSOR_LANES_INL_H_
#endif

#include "engine/kernels/element_math-inl.h"
#include "engine/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

using Tensor = Gradient<F>;   ///< h[i][j]
using Symmetric = Stress<F>;  ///< xx, yy, zz, xy, yz, zx

HWY_INLINE F number(float x) { return hn::Set(Lanes(), x); }

HWY_INLINE Tensor load_tensor(const float* in) {
  Tensor t;
  for (std::size_t k = 0; k < 9; ++k) t.h[k / 3][k % 3] = hn::Load(Lanes(), in + k * kLanes);
  return t;
}
HWY_INLINE void store_tensor(const Tensor& t, float* out) {
  for (std::size_t k = 0; k < 9; ++k) hn::Store(t.h[k / 3][k % 3], Lanes(), out + k * kLanes);
}
HWY_INLINE Symmetric load_symmetric(const float* in) {
  const auto get = [&](std::size_t k) GLISSON_INLINED { return hn::Load(Lanes(), in + k * kLanes); };
  return {get(0), get(1), get(2), get(3), get(4), get(5)};
}
HWY_INLINE void store_symmetric(const Symmetric& s, float* out) {
  const Lanes d;
  hn::Store(s.xx, d, out), hn::Store(s.yy, d, out + kLanes), hn::Store(s.zz, d, out + 2 * kLanes);
  hn::Store(s.xy, d, out + 3 * kLanes), hn::Store(s.yz, d, out + 4 * kLanes), hn::Store(s.zx, d, out + 5 * kLanes);
}

/// a + f b
HWY_INLINE Tensor plus(const Tensor& a, F f, const Tensor& b) {
  Tensor r;
  for (std::size_t k = 0; k < 9; ++k) r.h[k / 3][k % 3] = hn::MulAdd(f, b.h[k / 3][k % 3], a.h[k / 3][k % 3]);
  return r;
}
HWY_INLINE Symmetric plus(const Symmetric& a, F f, const Symmetric& b) {
  return {hn::MulAdd(f, b.xx, a.xx), hn::MulAdd(f, b.yy, a.yy), hn::MulAdd(f, b.zz, a.zz),
          hn::MulAdd(f, b.xy, a.xy), hn::MulAdd(f, b.yz, a.yz), hn::MulAdd(f, b.zx, a.zx)};
}
HWY_INLINE Tensor times(F f, const Tensor& a) {
  Tensor r;
  for (std::size_t k = 0; k < 9; ++k) r.h[k / 3][k % 3] = f * a.h[k / 3][k % 3];
  return r;
}
HWY_INLINE Symmetric times(F f, const Symmetric& a) {
  return {f * a.xx, f * a.yy, f * a.zz, f * a.xy, f * a.yz, f * a.zx};
}
HWY_INLINE Tensor plus_identity(Tensor a, F f) {
  for (std::size_t i = 0; i < 3; ++i) a.h[i][i] = a.h[i][i] + f;
  return a;
}
HWY_INLINE Symmetric plus_identity(Symmetric a, F f) {
  a.xx = a.xx + f, a.yy = a.yy + f, a.zz = a.zz + f;
  return a;
}
HWY_INLINE F trace_of(const Symmetric& a) { return a.xx + a.yy + a.zz; }
/// a : b
HWY_INLINE F contraction(const Symmetric& a, const Symmetric& b) {
  const F off = hn::MulAdd(a.xy, b.xy, hn::MulAdd(a.yz, b.yz, a.zx * b.zx));
  return hn::MulAdd(number(2.0F), off, hn::MulAdd(a.xx, b.xx, hn::MulAdd(a.yy, b.yy, a.zz * b.zz)));
}
/// Σ a_ij²
HWY_INLINE F squares_of(const Tensor& a) {
  F sum = a.h[0][0] * a.h[0][0];
  for (std::size_t k = 1; k < 9; ++k) sum = hn::MulAdd(a.h[k / 3][k % 3], a.h[k / 3][k % 3], sum);
  return sum;
}
HWY_INLINE Symmetric symmetric_part(const Tensor& a) {
  const F half = number(0.5F);
  return {a.h[0][0],
          a.h[1][1],
          a.h[2][2],
          half * (a.h[0][1] + a.h[1][0]),
          half * (a.h[1][2] + a.h[2][1]),
          half * (a.h[2][0] + a.h[0][2])};
}
HWY_INLINE Tensor full_tensor(const Symmetric& s) {
  return {{{s.xx, s.xy, s.zx}, {s.xy, s.yy, s.yz}, {s.zx, s.yz, s.zz}}};
}
/// A S
HWY_INLINE Tensor tensor_product(const Tensor& a, const Symmetric& s) {
  Tensor r;
  for (std::size_t i = 0; i < 3; ++i) {
    r.h[i][0] = hn::MulAdd(a.h[i][2], s.zx, hn::MulAdd(a.h[i][1], s.xy, a.h[i][0] * s.xx));
    r.h[i][1] = hn::MulAdd(a.h[i][2], s.yz, hn::MulAdd(a.h[i][1], s.yy, a.h[i][0] * s.xy));
    r.h[i][2] = hn::MulAdd(a.h[i][2], s.zz, hn::MulAdd(a.h[i][1], s.yz, a.h[i][0] * s.zx));
  }
  return r;
}
/// sym(Aᵀ B)
HWY_INLINE Symmetric symmetric_product(const Tensor& a, const Tensor& b) {
  const auto at = [&](std::size_t i, std::size_t j) GLISSON_INLINED {
    return hn::MulAdd(a.h[2][i], b.h[2][j], hn::MulAdd(a.h[1][i], b.h[1][j], a.h[0][i] * b.h[0][j]));
  };
  const F half = number(0.5F);
  return {at(0, 0),
          at(1, 1),
          at(2, 2),
          half * (at(0, 1) + at(1, 0)),
          half * (at(1, 2) + at(2, 1)),
          half * (at(2, 0) + at(0, 2))};
}
/// The product of two symmetric tensors that commute.
HWY_INLINE Symmetric commuting_product(const Symmetric& a, const Symmetric& b) {
  return {hn::MulAdd(a.zx, b.zx, hn::MulAdd(a.xy, b.xy, a.xx * b.xx)),
          hn::MulAdd(a.yz, b.yz, hn::MulAdd(a.yy, b.yy, a.xy * b.xy)),
          hn::MulAdd(a.zz, b.zz, hn::MulAdd(a.yz, b.yz, a.zx * b.zx)),
          hn::MulAdd(a.zx, b.yz, hn::MulAdd(a.xy, b.yy, a.xx * b.xy)),
          hn::MulAdd(a.yz, b.zz, hn::MulAdd(a.yy, b.yz, a.xy * b.zx)),
          hn::MulAdd(a.zx, b.zz, hn::MulAdd(a.xy, b.yz, a.xx * b.zx))};
}
/// cof of a symmetric tensor, and its determinant.
struct SymmetricCofactors {
  Symmetric cof;
  F determinant;
};
HWY_INLINE SymmetricCofactors cofactors_of(const Symmetric& s) {
  const Symmetric c{hn::NegMulAdd(s.yz, s.yz, s.yy * s.zz), hn::NegMulAdd(s.zx, s.zx, s.xx * s.zz),
                    hn::NegMulAdd(s.xy, s.xy, s.xx * s.yy), hn::NegMulAdd(s.xy, s.zz, s.zx * s.yz),
                    hn::NegMulAdd(s.xx, s.yz, s.xy * s.zx), hn::NegMulAdd(s.zx, s.yy, s.xy * s.yz)};
  return {c, hn::MulAdd(s.xx, c.xx, hn::MulAdd(s.xy, c.xy, s.zx * c.zx))};
}

/// E = sym H + ½ HᵀH
HWY_INLINE Symmetric green_strain(const Tensor& H) {
  return plus(symmetric_part(H), number(0.5F), symmetric_product(H, H));
}
/// K = cof(I + H) − I = (tr H) I − Hᵀ + cof H
HWY_INLINE Tensor cofactor_change(const Tensor& H) {
  const F t = trace(H);
  Tensor K;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const F cof = hn::NegMulAdd(H.h[i1][j2], H.h[i2][j1], H.h[i1][j1] * H.h[i2][j2]);
      K.h[i][j] = cof - H.h[j][i];
    }
    K.h[i][i] = K.h[i][i] + t;
  }
  return K;
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_TENSOR_LANES_INL_H_
