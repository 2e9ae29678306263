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

/// The shape gradients of one tet of a batch.
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

HWY_INLINE const std::uint16_t* index_of(const Elements& e, std::size_t batch) {
  return e.index + batch * kChainVertices * kLanes;
}
HWY_INLINE const float* rest_of(const Elements& e, std::size_t batch) {
  return e.rest + batch * kChainTets * kTetRest * kLanes;
}

/// Asks for a batch's rest data and indices while those of a block before are worked on. They are gone through
/// once a step, in many short streams, which hardware finds too late.
HWY_INLINE void prefetch_batch(const Elements& e, std::size_t batch) {
  constexpr std::size_t kLine = 64;
  const float* rest = rest_of(e, batch);
  const std::uint16_t* index = index_of(e, batch);
  for (std::size_t k = 0; k < kChainTets * kTetRest * kLanes; k += kLine / sizeof(float)) hwy::Prefetch(rest + k);
  for (std::size_t k = 0; k < kChainVertices * kLanes; k += kLine / sizeof(std::uint16_t)) hwy::Prefetch(index + k);
}

/// Gradient and viscous stress of one tet from the differences of its vertices.
template <bool kViscous>
HWY_INLINE void gather_tet(const UV& d1, const UV& d2, const UV& d3, const float* rest, F lambda, F mu,
                           std::size_t item, Block& block) {
  F s[3][3];
  load_gradients(rest, s);
  store_gradient(gradient(d1.u, d2.u, d3.u, s), block.gradient + item * 9 * kLanes);
  if constexpr (kViscous) {
    store_stress(stress(gradient(d1.v, d2.v, d3.v, s), lambda, mu), block.viscous + item * 6 * kLanes);
  }
}

template <bool kViscous>
inline void gather(const Elements& e, std::size_t begin, std::size_t n, Block& block) {
  const F lambda = hn::Set(Lanes(), e.tissue.viscous_lambda), mu = hn::Set(Lanes(), e.tissue.viscous_mu);
  for (std::size_t b = 0; b < n; ++b) {
    if (e.prefetch) prefetch_batch(e, begin + b + kBlockBatches);
    const std::uint16_t* index = index_of(e, begin + b);
    const float *rest_A = rest_of(e, begin + b), *rest_B = rest_A + kTetRest * kLanes,
                *rest_C = rest_B + kTetRest * kLanes;
    const std::size_t item = kChainTets * b;
    const auto vertex = [&](std::size_t a) { return Indices(index + a * kLanes); };
    const Origin<kViscous> origin(e.states, vertex(0));
    const UV d1 = origin.difference(vertex(1)), d2 = origin.difference(vertex(2));
    gather_tet<kViscous>(d1, d2, origin.difference(vertex(4)), rest_A, lambda, mu, item, block);
    const UV d3 = origin.difference(vertex(3));
    gather_tet<kViscous>(d1, d2, d3, rest_B, lambda, mu, item + 1, block);
    gather_tet<kViscous>(d1, d3, origin.difference(vertex(5)), rest_C, lambda, mu, item + 2, block);
  }
}

/// Displacement and velocity gradients of one tet.
HWY_INLINE void gather_tet_rates(const UV& d1, const UV& d2, const UV& d3, const float* rest, std::size_t item,
                                 Block& block, float* rate) {
  F s[3][3];
  load_gradients(rest, s);
  store_gradient(gradient(d1.u, d2.u, d3.u, s), block.gradient + item * 9 * kLanes);
  store_gradient(gradient(d1.v, d2.v, d3.v, s), rate + item * 9 * kLanes);
}

inline void gather_rates(const Elements& e, std::size_t begin, std::size_t n, Block& block, float* rate) {
  for (std::size_t b = 0; b < n; ++b) {
    if (e.prefetch) prefetch_batch(e, begin + b + kBlockBatches);
    const std::uint16_t* index = index_of(e, begin + b);
    const float* rest = rest_of(e, begin + b);
    const std::size_t item = kChainTets * b;
    const auto vertex = [&](std::size_t a) { return Indices(index + a * kLanes); };
    const Origin<true> origin(e.states, vertex(0));
    const UV d1 = origin.difference(vertex(1)), d2 = origin.difference(vertex(2)), d3 = origin.difference(vertex(3));
    gather_tet_rates(d1, d2, origin.difference(vertex(4)), rest, item, block, rate);
    gather_tet_rates(d1, d2, d3, rest + kTetRest * kLanes, item + 1, block, rate);
    gather_tet_rates(d1, d3, origin.difference(vertex(5)), rest + 2 * kTetRest * kLanes, item + 2, block, rate);
  }
}

template <DeformationMeasure M>
inline bool measure(const Elements& e, std::size_t begin, std::size_t n, Block& block) {
  const Lanes d;
  F lowest = hn::Set(d, 1.0F);
  for (std::size_t item = 0; item < kChainTets * n; ++item) {
    const Gradient<F> g = load_gradient(block.gradient + item * 9 * kLanes);
    const Invariants<F> inv = invariants(d, g);
    Measured<F> m;
    if constexpr (M == DeformationMeasure::intensity) {
      m = measure_intensity(d, inv, e.tissue.bulk_over_two_mu);
    } else if constexpr (M == DeformationMeasure::one_minus_q) {
      m = measure_one_minus_q(d, inv, e.tissue.bulk_over_two_mu);
    } else {
      F s[3][3];
      load_gradients(e.rest + (begin * kChainTets + item) * kTetRest * kLanes, s);
      m = measure_regular_mean_ratio(d, g, inv, s, e.tissue.bulk_over_two_mu);
    }
    lowest = hn::Min(lowest, inv.volume_change);
    hn::Store(m.x, d, block.x + item * kLanes);
    hn::Store(m.y, d, block.y + item * kLanes);
  }
  return !hn::AllTrue(d, hn::Gt(lowest, hn::Set(d, -1.0F)));
}

/// Forces of a batch from the stresses of its three tets (−V included), joined on the vertices they share.
template <class T>
HWY_INLINE void push_chain(float* forces, const std::uint16_t* index, const float* rest, const T& A, const T& B,
                           const T& C) {
  const auto vertex = [&](std::size_t a) { return Indices(index + a * kLanes); };
  F s[3][3];
  load_gradients(rest, s);
  const Xyz f4 = force<F, Xyz>(A, s[2]);
  add_forces(forces, vertex(4), f4);
  Xyz f1 = force<F, Xyz>(A, s[0]), f2 = force<F, Xyz>(A, s[1]);
  load_gradients(rest + kTetRest * kLanes, s);
  f2 = force_beside(B, s[1], f2);
  add_forces(forces, vertex(2), f2);
  f1 = force_beside(B, s[0], f1);
  Xyz f3 = force<F, Xyz>(B, s[2]);
  load_gradients(rest + 2 * kTetRest * kLanes, s);
  f3 = force_beside(C, s[1], f3);
  add_forces(forces, vertex(3), f3);
  const Xyz f5 = force<F, Xyz>(C, s[2]);
  add_forces(forces, vertex(5), f5);
  f1 = force_beside(C, s[0], f1);
  add_forces(forces, vertex(1), f1);
  const auto minus = [](F a, F b, F c, F d, F e) { return hn::Neg(((a + b) + (c + d)) + e); };
  add_forces(forces, vertex(0),
             Xyz{minus(f4.x, f2.x, f3.x, f5.x, f1.x), minus(f4.y, f2.y, f3.y, f5.y, f1.y),
                 minus(f4.z, f2.z, f3.z, f5.z, f1.z)});
}

/// Pushes n batches; `stress_of(item, −V)` is the stress of an item, −V included.
template <class StressOf>
HWY_INLINE void push_batches(const Elements& e, std::size_t begin, std::size_t n, float* forces,
                             const StressOf& stress_of) {
  for (std::size_t b = 0; b < n; ++b) {
    const float* rest = rest_of(e, begin + b);
    const auto minus_volume = [&](std::size_t tet) { return hn::Load(Lanes(), rest + (tet * kTetRest + 9) * kLanes); };
    const std::size_t item = kChainTets * b;
    push_chain(forces, index_of(e, begin + b), rest, stress_of(item, minus_volume(0)),
               stress_of(item + 1, minus_volume(1)), stress_of(item + 2, minus_volume(2)));
  }
}

/// Whose stress a push carries.
enum class Push { elastic, viscous, merged };

/// −V σ of one tet of a batch.
template <Push P>
struct WeightedStress {
  const Elements& e;
  const Block& block;

  HWY_INLINE Stress<F> operator()(std::size_t item, F minus_volume) const {
    const Lanes d;
    if constexpr (P == Push::viscous) return scaled(load_stress(block.viscous + item * 6 * kLanes), minus_volume);
    const F lambda = hn::Set(d, e.tissue.lambda) * hn::Load(d, block.value[0] + item * kLanes);
    const F mu = hn::Set(d, e.tissue.mu) * hn::Load(d, block.value[e.mu_law] + item * kLanes);
    const Stress<F> elastic = stress(load_gradient(block.gradient + item * 9 * kLanes), lambda, mu);
    if constexpr (P == Push::elastic) return scaled(elastic, minus_volume);
    return scaled(sum(elastic, load_stress(block.viscous + item * 6 * kLanes)), minus_volume);
  }
};

/// −V P of one tet of a batch.
struct WeightedPiola {
  const float* piola;

  HWY_INLINE Piola<F> operator()(std::size_t item, F minus_volume) const {
    Piola<F> p;
    for (std::size_t k = 0; k < 9; ++k) {
      p.p[k / 3][k % 3] = hn::Load(Lanes(), piola + (item * 9 + k) * kLanes) * minus_volume;
    }
    return p;
  }
};

template <Push P>
inline void push(const Elements& e, std::size_t begin, std::size_t n, const Block& block) {
  push_batches(e, begin, n, P == Push::viscous ? e.viscous : e.elastic, WeightedStress<P>{e, block});
}

inline void push_piola(const Elements& e, std::size_t begin, std::size_t n, const float* piola, float* forces) {
  push_batches(e, begin, n, forces, WeightedPiola{piola});
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_ELEMENT_STAGES_INL_H_
