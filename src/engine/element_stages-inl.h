// element_stages-inl.h — gather, measure and push: the stages of a block that touch geometry.
//
// Included once per instruction set, never from outside kernels.cpp.
#if defined(GLISSON_ELEMENT_STAGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_ELEMENT_STAGES_INL_H_
#undef GLISSON_ELEMENT_STAGES_INL_H_
#else
#define GLISSON_ELEMENT_STAGES_INL_H_
#endif

#include <hwy/cache_control.h>

#include "engine/element_math-inl.h"
#include "engine/kernels.h"
#include "engine/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

/// The shape gradients of tet A (0) or B (1) of a batch.
HWY_INLINE void load_gradients(const float* rest, F (&s)[3][3]) {
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t i = 0; i < 3; ++i) s[a][i] = hn::Load(Lanes(), rest + (3 * a + i) * kLanes);
  }
}

HWY_INLINE void store_gradient(const Gradient<F>& g, float* out) {
  for (std::size_t k = 0; k < 9; ++k) hn::Store(g.h[k / 3][k % 3], Lanes(), out + k * kLanes);
}
HWY_INLINE Gradient<F> load_gradient(const float* in) {
  Gradient<F> g;
  for (std::size_t k = 0; k < 9; ++k) g.h[k / 3][k % 3] = hn::Load(Lanes(), in + k * kLanes);
  return g;
}

HWY_INLINE void store_stress(const Stress<F>& s, float* out) {
  const Lanes d;
  hn::Store(s.xx, d, out), hn::Store(s.yy, d, out + kLanes), hn::Store(s.zz, d, out + 2 * kLanes);
  hn::Store(s.xy, d, out + 3 * kLanes), hn::Store(s.yz, d, out + 4 * kLanes), hn::Store(s.zx, d, out + 5 * kLanes);
}
HWY_INLINE Stress<F> load_stress(const float* in) {
  const auto get = [&](std::size_t k) { return hn::Load(Lanes(), in + k * kLanes); };
  return {get(0), get(1), get(2), get(3), get(4), get(5)};
}
HWY_INLINE Stress<F> sum(const Stress<F>& a, const Stress<F>& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.yz + b.yz, a.zx + b.zx};
}

/// Asks for a batch's rest data and indices while those of a block before are worked on. They are gone through
/// once a step, in many short streams, which hardware finds too late.
HWY_INLINE void prefetch_batch(const Elements& e, std::size_t batch) {
  constexpr std::size_t kLine = 64;
  const float* rest = e.rest + batch * 2 * kTetRest * kLanes;
  const std::uint16_t* index = e.index + batch * kPairVertices * kLanes;
  for (std::size_t k = 0; k < 2 * kTetRest * kLanes; k += kLine / sizeof(float)) hwy::Prefetch(rest + k);
  for (std::size_t k = 0; k < kPairVertices * kLanes; k += kLine / sizeof(std::uint16_t)) hwy::Prefetch(index + k);
}

template <bool kViscous>
inline void gather(const Elements& e, std::size_t begin, std::size_t n, Block& block) {
  const F lambda = hn::Set(Lanes(), e.tissue.viscous_lambda), mu = hn::Set(Lanes(), e.tissue.viscous_mu);
  for (std::size_t b = 0; b < n; ++b) {
    const std::uint16_t* index = e.index + (begin + b) * kPairVertices * kLanes;
    const float* rest = e.rest + (begin + b) * 2 * kTetRest * kLanes;
    if (e.prefetch) prefetch_batch(e, begin + b + kBlockBatches);
    const auto vertex = [&](std::size_t a) { return Indices(index + a * kLanes); };
    const Origin<kViscous> origin(e.states, vertex(0));
    const UV d2 = origin.difference(vertex(2)), d3 = origin.difference(vertex(3));
    for (std::size_t tet = 0; tet < 2; ++tet) {
      const UV d1 = origin.difference(vertex(tet == 0 ? 1 : 4));
      const std::size_t item = 2 * b + tet;
      F s[3][3];
      load_gradients(rest + tet * kTetRest * kLanes, s);
      store_gradient(gradient(d1.u, d2.u, d3.u, s), block.gradient + item * 9 * kLanes);
      if constexpr (kViscous) {
        store_stress(stress(gradient(d1.v, d2.v, d3.v, s), lambda, mu), block.viscous + item * 6 * kLanes);
      }
    }
  }
}

template <DeformationMeasure M>
inline bool measure(const Elements& e, std::size_t begin, std::size_t n, Block& block) {
  const Lanes d;
  F lowest = hn::Set(d, 1.0F);
  for (std::size_t item = 0; item < 2 * n; ++item) {
    const Gradient<F> g = load_gradient(block.gradient + item * 9 * kLanes);
    const Invariants<F> inv = invariants(d, g);
    Measured<F> m;
    if constexpr (M == DeformationMeasure::intensity) {
      m = measure_intensity(d, inv, e.tissue.bulk_over_two_mu);
    } else if constexpr (M == DeformationMeasure::one_minus_q) {
      m = measure_one_minus_q(d, inv, e.tissue.bulk_over_two_mu);
    } else {
      F s[3][3];
      load_gradients(e.rest + ((begin + item / 2) * 2 + item % 2) * kTetRest * kLanes, s);
      m = measure_regular_mean_ratio(d, g, inv, s, e.tissue.bulk_over_two_mu);
    }
    lowest = hn::Min(lowest, inv.volume_change);
    hn::Store(m.x, d, block.x + item * kLanes);
    hn::Store(m.y, d, block.y + item * kLanes);
  }
  return !hn::AllTrue(d, hn::Gt(lowest, hn::Set(d, -1.0F)));
}

/// Forces of a batch from the two stresses (−V included): both tets add to the two vertices they share.
HWY_INLINE void push_pair(float* forces, const std::uint16_t* index, const float* rest, const Stress<F>& A,
                          const Stress<F>& B) {
  const auto vertex = [&](std::size_t a) { return Indices(index + a * kLanes); };
  F s[3][3];
  load_gradients(rest, s);
  const Xyz f1 = force<F, Xyz>(A, s[0]);
  add_forces(forces, vertex(1), f1);
  Xyz f2 = force<F, Xyz>(A, s[1]), f3 = force<F, Xyz>(A, s[2]);
  load_gradients(rest + kTetRest * kLanes, s);
  const Xyz f4 = force<F, Xyz>(B, s[0]);
  add_forces(forces, vertex(4), f4);
  f2 = force_beside(B, s[1], f2);
  f3 = force_beside(B, s[2], f3);
  add_forces(forces, vertex(2), f2);
  add_forces(forces, vertex(3), f3);
  const auto minus = [](F a, F b, F c, F e) { return hn::Neg((a + b) + (c + e)); };
  add_forces(forces, vertex(0),
             Xyz{minus(f1.x, f4.x, f2.x, f3.x), minus(f1.y, f4.y, f2.y, f3.y), minus(f1.z, f4.z, f2.z, f3.z)});
}

/// Whose stress a push carries.
enum class Push { elastic, viscous, merged };

/// −V σ of one tet of a batch.
template <Push P>
HWY_INLINE Stress<F> weighted_stress(const Elements& e, const Block& block, std::size_t item, F minus_volume) {
  const Lanes d;
  if constexpr (P == Push::viscous) return scaled(load_stress(block.viscous + item * 6 * kLanes), minus_volume);
  const F lambda = hn::Set(d, e.tissue.lambda) * hn::Load(d, block.value[0] + item * kLanes);
  const F mu = hn::Set(d, e.tissue.mu) * hn::Load(d, block.value[e.mu_law] + item * kLanes);
  const Stress<F> elastic = stress(load_gradient(block.gradient + item * 9 * kLanes), lambda, mu);
  if constexpr (P == Push::elastic) return scaled(elastic, minus_volume);
  return scaled(sum(elastic, load_stress(block.viscous + item * 6 * kLanes)), minus_volume);
}

template <Push P>
inline void push(const Elements& e, std::size_t begin, std::size_t n, const Block& block) {
  float* forces = P == Push::viscous ? e.viscous : e.elastic;
  for (std::size_t b = 0; b < n; ++b) {
    const std::uint16_t* index = e.index + (begin + b) * kPairVertices * kLanes;
    const float* rest = e.rest + (begin + b) * 2 * kTetRest * kLanes;
    const auto minus_volume = [&](std::size_t tet) { return hn::Load(Lanes(), rest + (tet * kTetRest + 9) * kLanes); };
    push_pair(forces, index, rest, weighted_stress<P>(e, block, 2 * b, minus_volume(0)),
              weighted_stress<P>(e, block, 2 * b + 1, minus_volume(1)));
  }
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_ELEMENT_STAGES_INL_H_
