// edge_stages-inl.h — a linear tissue by its edges: [Schwartz2002, eq. 2] and the viscous twin of it.
//
// Row sums of K vanish, so the force needs differences along edges only. With T the edge's tensor of the
// assembled elements and δ = u_j − u_i:
//
//   one tensor     T = −Σ K_ij                        f_i += T δ,   f_j −= Tᵀ δ
//   two moduli     T = −Σ A_ij = −Σ V s_i ⊗ s_j       p = λ δu + a δv,   q = μ δu + b δv
//                  (B_ij = A_ijᵀ + tr(A_ij) I)        f_i += T p + Tᵀ q + tr(T) q
//                                                     f_j −= Tᵀ p + T q + tr(T) q
//
// The second serves the viscous tissue: nine numbers an edge carry both tensors, whichever viscous one it is.
// There are 1.23 edges a tet in large meshes: 22 multiply-adds a tet against 75 by elements.
//
// Included once per instruction set, never from outside kernels.cpp.
#if defined(GLISSON_EDGE_STAGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_EDGE_STAGES_INL_H_
#undef GLISSON_EDGE_STAGES_INL_H_
#else
#define GLISSON_EDGE_STAGES_INL_H_
#endif

#include <hwy/cache_control.h>

#include "engine/kernels/kernels.h"
#include "engine/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

HWY_INLINE Xyz product(const F (&T)[9], const Xyz& v) {
  return {hn::MulAdd(T[2], v.z, hn::MulAdd(T[1], v.y, T[0] * v.x)),
          hn::MulAdd(T[5], v.z, hn::MulAdd(T[4], v.y, T[3] * v.x)),
          hn::MulAdd(T[8], v.z, hn::MulAdd(T[7], v.y, T[6] * v.x))};
}
HWY_INLINE Xyz transposed_product(const F (&T)[9], const Xyz& v) {
  return {hn::MulAdd(T[6], v.z, hn::MulAdd(T[3], v.y, T[0] * v.x)),
          hn::MulAdd(T[7], v.z, hn::MulAdd(T[4], v.y, T[1] * v.x)),
          hn::MulAdd(T[8], v.z, hn::MulAdd(T[5], v.y, T[2] * v.x))};
}
HWY_INLINE Xyz combined(F a, const Xyz& u, F b, const Xyz& v) {
  return {hn::MulAdd(a, u.x, b * v.x), hn::MulAdd(a, u.y, b * v.y), hn::MulAdd(a, u.z, b * v.z)};
}
HWY_INLINE Xyz scaled(F a, const Xyz& u) { return {a * u.x, a * u.y, a * u.z}; }
HWY_INLINE F squared(const Xyz& v) { return hn::MulAdd(v.z, v.z, hn::MulAdd(v.y, v.y, v.x * v.x)); }

/// Loads a batch's tensor and asks for that of a few batches on.
HWY_INLINE void load_tensor(const float* in, F (&T)[9]) {
  constexpr std::size_t kAhead = 8;
  for (std::size_t k = 0; k < 9 * kLanes; k += 16) hwy::Prefetch(in + kAhead * 9 * kLanes + k);
  for (std::size_t k = 0; k < 9; ++k) T[k] = hn::Load(Lanes(), in + k * kLanes);
}

/// Adds the forces of one batch by the two-moduli form.
HWY_INLINE void push_edge(float* forces, const std::uint16_t* index, const F (&T)[9], const Xyz& p, const Xyz& q) {
  const F t = T[0] + T[4] + T[8];
  const Xyz Tp = product(T, p), Ttp = transposed_product(T, p), Tq = product(T, q), Ttq = transposed_product(T, q);
  const auto at_i = [&](F a, F b, F c) GLISSON_INLINED { return hn::MulAdd(t, c, a + b); };
  add_forces(forces, index, Xyz{at_i(Tp.x, Ttq.x, q.x), at_i(Tp.y, Ttq.y, q.y), at_i(Tp.z, Ttq.z, q.z)});
  add_forces(forces, index + kLanes,
             negative({at_i(Ttp.x, Tq.x, q.x), at_i(Ttp.y, Tq.y, q.y), at_i(Ttp.z, Tq.z, q.z)}));
}

inline float edges_elastic(const Edges& e) {
  F longest = hn::Zero(Lanes());
  for (std::size_t b = 0; b < e.batches; ++b) {
    const std::uint16_t* index = e.index + b * 2 * kLanes;
    F T[9];
    load_tensor(e.tensor + b * 9 * kLanes, T);
    const Xyz u = Origin<false>(e.states, index).difference(index + kLanes).u;
    longest = hn::Max(longest, squared(u));
    add_forces(e.elastic, index, product(T, u));
    add_forces(e.elastic, index + kLanes, negative(transposed_product(T, u)));
  }
  return hn::GetLane(hn::MaxOfLanes(Lanes(), longest));
}

template <bool kSplit>
inline float edges_viscous(const Edges& e) {
  const Lanes d;
  const F lambda = hn::Set(d, e.tissue.lambda), mu = hn::Set(d, e.tissue.mu);
  const F a = hn::Set(d, e.tissue.viscous_lambda), b = hn::Set(d, e.tissue.viscous_mu);
  F longest = hn::Zero(d);
  for (std::size_t k = 0; k < e.batches; ++k) {
    const std::uint16_t* index = e.index + k * 2 * kLanes;
    F T[9];
    load_tensor(e.tensor + k * 9 * kLanes, T);
    const UV difference = Origin<true>(e.states, index).difference(index + kLanes);
    longest = hn::Max(longest, squared(difference.u));
    if constexpr (kSplit) {
      push_edge(e.elastic, index, T, scaled(lambda, difference.u), scaled(mu, difference.u));
      push_edge(e.viscous, index, T, scaled(a, difference.v), scaled(b, difference.v));
    } else {
      push_edge(e.elastic, index, T, combined(lambda, difference.u, a, difference.v),
                combined(mu, difference.u, b, difference.v));
    }
  }
  return hn::GetLane(hn::MaxOfLanes(d, longest));
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_EDGE_STAGES_INL_H_
