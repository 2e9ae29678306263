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

#include "engine/kernels/kernels.h"
#include "engine/kernels/tensor_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

HWY_INLINE Xyz sum(const Xyz& a, const Xyz& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
/// A product of edges of a batch, from a row of its rest data.
HWY_INLINE void load_product(const float* rest, std::size_t row, F (&s)[3]) {
  for (std::size_t i = 0; i < 3; ++i) s[i] = hn::Load(Lanes(), rest + (row + i) * kLanes);
}
/// w of a tet, 0 where there is none.
HWY_INLINE F rest_scale(const float* rest, std::size_t tet) {
  return hn::Load(Lanes(), rest + (kRestScale + tet) * kLanes);
}
HWY_INLINE void scale(F factor, F (&s)[3]) { s[0] = s[0] * factor, s[1] = s[1] * factor, s[2] = s[2] * factor; }

/// The shape gradients of a tet between two spokes: of vertex 1, of that behind and of that ahead. Spokes are told by
/// batch and vertex, since a fan's last one may be of its first batch.
HWY_INLINE void shape_gradients(const float* rest, std::size_t tet, const float* behind, const float* ahead,
                                F (&s)[3][3]) {
  const F w = rest_scale(rest, tet);
  load_product(rest, kRestAcross + 3 * tet, s[0]);
  load_product(ahead, 0, s[1]);
  load_product(behind, 0, s[2]);
  scale(w, s[0]), scale(hn::Neg(w), s[1]), scale(w, s[2]);
}

/// The vertices beside the edge of tets A, B, C.
inline constexpr std::size_t kVertexBehind[kChainTets] = {4, 2, 3}, kVertexAhead[kChainTets] = {2, 3, 5};

/// n of a vertex of a batch.
HWY_INLINE const float* spoke(const float* rest, std::size_t vertex) { return rest + kRestSpoke[vertex] * kLanes; }

HWY_INLINE Stress<F> sum(const Stress<F>& a, const Stress<F>& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.yz + b.yz, a.zx + b.zx};
}

/// Two stresses that are kept apart.
template <class T>
struct StressPair {
  T elastic, viscous;
};

// What a stress leaves on a vertex, and two stresses.
template <class T>
HWY_INLINE Xyz force_by(const T& stress, const F (&s)[3]) {
  return force<F, Xyz>(stress, s);
}
template <class T>
HWY_INLINE ForcePair force_by(const StressPair<T>& t, const F (&s)[3]) {
  return {force_by(t.elastic, s), force_by(t.viscous, s)};
}
template <class T>
HWY_INLINE ForcePair add_force(const StressPair<T>& t, const F (&s)[3], const ForcePair& f) {
  return {add_force(t.elastic, s, f.elastic), add_force(t.viscous, s, f.viscous)};
}
template <class T>
HWY_INLINE ForcePair force_against(const StressPair<T>& t, const F (&s)[3], const ForcePair& f) {
  return {force_against(t.elastic, s, f.elastic), force_against(t.viscous, s, f.viscous)};
}
HWY_INLINE ForcePair sum(const ForcePair& a, const ForcePair& b) {
  return {sum(a.elastic, b.elastic), sum(a.viscous, b.viscous)};
}
HWY_INLINE ForcePair negative(const ForcePair& f) { return {negative(f.elastic), negative(f.viscous)}; }
HWY_INLINE void set_zero(Xyz& f) { f.x = f.y = f.z = hn::Zero(Lanes()); }
HWY_INLINE void set_zero(ForcePair& f) { set_zero(f.elastic), set_zero(f.viscous); }

HWY_INLINE const std::uint16_t* index_of(const Elements& e, std::size_t batch) {
  return e.index + batch * kChainVertices * kLanes;
}
HWY_INLINE const float* rest_of(const Elements& e, std::size_t batch) { return e.rest + batch * kChainRest * kLanes; }

/// Asks for a batch's rest data and indices while those of a block before are worked on. They are gone through
/// once a step, in many short streams, which hardware finds too late.
HWY_INLINE void prefetch_batch(const Elements& e, std::size_t batch) {
  constexpr std::size_t kLine = 64;
  const float* rest = rest_of(e, batch);
  const std::uint16_t* index = index_of(e, batch);
  for (std::size_t k = 0; k < kChainRest * kLanes; k += kLine / sizeof(float)) hwy::Prefetch(rest + k);
  for (std::size_t k = 0; k < kChainVertices * kLanes; k += kLine / sizeof(std::uint16_t)) hwy::Prefetch(index + k);
}

/// Gradient and viscous stress of one tet from the differences of its vertices. Moduli times kForceScale.
template <bool kViscous>
struct GatherTet {
  static constexpr bool kVelocity = kViscous;
  Block& block;
  F lambda, mu;

  HWY_INLINE void operator()(const UV& d1, const UV& d2, const UV& d3, const F (&s)[3][3], std::size_t item) const {
    store_tensor(gradient(d1.u, d2.u, d3.u, s), block.gradient + item * 9 * kLanes);
    if constexpr (kViscous) {
      store_symmetric(stress(gradient(d1.v, d2.v, d3.v, s), lambda, mu), block.viscous + item * 6 * kLanes);
    }
  }
};

/// Displacement and velocity gradients of one tet.
struct GatherTetRates {
  static constexpr bool kVelocity = true;
  Block& block;
  float* rate;

  HWY_INLINE void operator()(const UV& d1, const UV& d2, const UV& d3, const F (&s)[3][3], std::size_t item) const {
    store_tensor(gradient(d1.u, d2.u, d3.u, s), block.gradient + item * 9 * kLanes);
    store_tensor(gradient(d1.v, d2.v, d3.v, s), rate + item * 9 * kLanes);
  }
};

/// Viscous stress of one tet, velocities in the place of displacements. Moduli times kForceScale.
struct GatherTetDrag {
  static constexpr bool kVelocity = false;
  Block& block;
  F lambda, mu;

  HWY_INLINE void operator()(const UV& d1, const UV& d2, const UV& d3, const F (&s)[3][3], std::size_t item) const {
    store_symmetric(stress(gradient(d1.u, d2.u, d3.u, s), lambda, mu), block.viscous + item * 6 * kLanes);
  }
};

enum class Run { chain, fan, closed_fan };

/// Goes round the edge 0–1 of a fan, from tet to tet.
template <class Tet>
class Gathering {
 public:
  /// A vertex beside the edge: what it has moved against the origin, and its spoke.
  struct Corner {
    UV difference;
    const float* spoke;
  };

  HWY_INLINE Gathering(const Elements& e, std::size_t batch, const Tet& tet)
      : tet_(tet), origin_(e.states, Indices(index_of(e, batch))),
        difference_1_(origin_.difference(Indices(index_of(e, batch) + kLanes))) {}

  HWY_INLINE Corner corner(const std::uint16_t* index, const float* rest, std::size_t vertex) const {
    return {origin_.difference(Indices(index + vertex * kLanes)), spoke(rest, vertex)};
  }
  HWY_INLINE void between(const Corner& behind, const Corner& ahead, const float* rest, std::size_t which,
                          std::size_t item) const {
    F s[3][3];
    shape_gradients(rest, which, behind.spoke, ahead.spoke, s);
    tet_(difference_1_, behind.difference, ahead.difference, s, item + which);
  }

 private:
  const Tet& tet_;
  Origin<Tet::kVelocity> origin_;
  UV difference_1_;
};

/// A batch of chains, or two of fans.
template <Run R, class Tet>
HWY_INLINE void gather_run(const Elements& e, std::size_t batch, std::size_t item, const Tet& tet) {
  const std::uint16_t* index = index_of(e, batch);
  const float* rest = rest_of(e, batch);
  if (e.prefetch) prefetch_batch(e, batch + kBlockBatches);
  const Gathering<Tet> around(e, batch, tet);
  const auto c4 = around.corner(index, rest, 4), c2 = around.corner(index, rest, 2);
  around.between(c4, c2, rest, 0, item);
  const auto c3 = around.corner(index, rest, 3);
  around.between(c2, c3, rest, 1, item);
  const auto c5 = around.corner(index, rest, 5);
  around.between(c3, c5, rest, 2, item);
  if constexpr (R != Run::chain) {
    const std::uint16_t* next = index_of(e, batch + 1);
    const float* next_rest = rest_of(e, batch + 1);
    if (e.prefetch) prefetch_batch(e, batch + 1 + kBlockBatches);
    const auto n2 = around.corner(next, next_rest, 2);
    around.between(c5, n2, next_rest, 0, item + kChainTets);
    const auto n3 = around.corner(next, next_rest, 3);
    around.between(n2, n3, next_rest, 1, item + kChainTets);
    if constexpr (R == Run::closed_fan) {
      around.between(n3, c4, next_rest, 2, item + kChainTets);
    } else {
      around.between(n3, around.corner(next, next_rest, 5), next_rest, 2, item + kChainTets);
    }
  }
}

template <class Tet>
HWY_INLINE void gather_batches(const Elements& e, std::size_t begin, std::size_t n, const Tet& tet) {
  std::size_t b = 0;
  for (; b < n && begin + b < 2 * e.closed_pairs; b += 2)
    gather_run<Run::closed_fan>(e, begin + b, kChainTets * b, tet);
  for (; b < n && begin + b < 2 * e.pairs; b += 2) gather_run<Run::fan>(e, begin + b, kChainTets * b, tet);
  for (; b < n; ++b) gather_run<Run::chain>(e, begin + b, kChainTets * b, tet);
}

template <bool kViscous>
inline void gather(const Elements& e, std::size_t begin, std::size_t n, Block& block) {
  const F lambda = hn::Set(Lanes(), kForceScale * e.tissue.viscous_lambda),
          mu = hn::Set(Lanes(), kForceScale * e.tissue.viscous_mu);
  gather_batches(e, begin, n, GatherTet<kViscous>{block, lambda, mu});
}

inline void gather_drag(const Elements& e, std::size_t begin, std::size_t n, Block& block) {
  const F lambda = hn::Set(Lanes(), kForceScale * e.tissue.viscous_lambda),
          mu = hn::Set(Lanes(), kForceScale * e.tissue.viscous_mu);
  gather_batches(e, begin, n, GatherTetDrag{block, lambda, mu});
}

inline void gather_rates(const Elements& e, std::size_t begin, std::size_t n, Block& block, float* rate) {
  gather_batches(e, begin, n, GatherTetRates{block, rate});
}

template <DeformationMeasure M>
inline bool measure(const Elements& e, std::size_t begin, std::size_t n, Block& block) {
  const Lanes d;
  F lowest = hn::Set(d, 1.0F);
  for (std::size_t item = 0; item < kChainTets * n; ++item) {
    const Gradient<F> g = load_tensor(block.gradient + item * 9 * kLanes);
    const Invariants<F> inv = invariants(d, g);
    Measured<F> m;
    if constexpr (M == DeformationMeasure::equivalent_shear_strain) {
      m = measure_intensity(d, inv, e.tissue.bulk_over_two_mu);
    } else if constexpr (M == DeformationMeasure::one_minus_q) {
      m = measure_one_minus_q(d, inv, e.tissue.bulk_over_two_mu);
    } else {
      const float* rest = rest_of(e, begin + item / kChainTets);
      const std::size_t tet = item % kChainTets;
      F s[3][3];
      shape_gradients(rest, tet, spoke(rest, kVertexBehind[tet]), spoke(rest, kVertexAhead[tet]), s);
      m = measure_regular_mean_ratio(d, g, inv, s, e.tissue.bulk_over_two_mu);
    }
    lowest = hn::Min(lowest, inv.volume_change);
    hn::Store(m.x, d, block.x + item * kLanes);
    hn::Store(m.y, d, block.y + item * kLanes);
  }
  return !hn::AllTrue(d, hn::Gt(lowest, hn::Set(d, -1.0F)));
}

/// Goes round the edge 0–1 of a fan and leaves the forces of its tets on their vertices.
template <class Force>
class Pushing {
 public:
  HWY_INLINE explicit Pushing(float* forces) : forces_(forces) { set_zero(on_1_), set_zero(others_); }

  /// The tet between two spokes, its stress times kForceScale: adds to what is on the vertex behind. @return the force on
  /// that ahead
  template <class T>
  HWY_INLINE Force between(const float* behind, const float* ahead, const float* rest, std::size_t which,
                           const T& stress, Force& on_behind) {
    F s[3];
    load_product(ahead, 0, s);
    on_behind = force_against(stress, s, on_behind);
    load_product(rest, kRestAcross + 3 * which, s);
    on_1_ = add_force(stress, s, on_1_);
    load_product(behind, 0, s);
    return force_by(stress, s);
  }
  HWY_INLINE void leave(const std::uint16_t* index, std::size_t vertex, const Force& f) {
    add_forces(forces_, Indices(index + vertex * kLanes), f);
    others_ = sum(others_, f);
  }
  /// Vertices 1 and 0 come last.
  HWY_INLINE void finish(const std::uint16_t* index) {
    leave(index, 1, on_1_);
    add_forces(forces_, Indices(index), negative(others_));
  }

 private:
  float* forces_;
  Force on_1_, others_;  // others: sum of what has been left
};

/// A batch of chains, or two of fans.
template <Run R, class StressOf>
HWY_INLINE void push_run(const Elements& e, std::size_t batch, float* forces, const StressOf& stress_of,
                         std::size_t item) {
  const std::uint16_t* index = index_of(e, batch);
  const float* rest = rest_of(e, batch);
  using Force = typename StressOf::Force;
  Pushing<Force> around(forces);
  Force f4;
  set_zero(f4);
  const float *s4 = spoke(rest, 4), *s2 = spoke(rest, 2), *s3 = spoke(rest, 3), *s5 = spoke(rest, 5);
  // What is on a vertex is left there while the tet after the next is reckoned.
  Force f2 = around.between(s4, s2, rest, 0, stress_of(item, rest_scale(rest, 0)), f4);
  Force f3 = around.between(s2, s3, rest, 1, stress_of(item + 1, rest_scale(rest, 1)), f2);
  if constexpr (R != Run::closed_fan) around.leave(index, 4, f4);
  Force f5 = around.between(s3, s5, rest, 2, stress_of(item + 2, rest_scale(rest, 2)), f3);
  around.leave(index, 2, f2);
  if constexpr (R == Run::chain) {
    around.leave(index, 3, f3);
    around.leave(index, 5, f5);
  } else {
    const std::uint16_t* next = index_of(e, batch + 1);
    const float* next_rest = rest_of(e, batch + 1);
    const float *n2 = spoke(next_rest, 2), *n3 = spoke(next_rest, 3);
    const float* n5 = R == Run::closed_fan ? s4 : spoke(next_rest, 5);
    Force g2 = around.between(s5, n2, next_rest, 0, stress_of(item + 3, rest_scale(next_rest, 0)), f5);
    around.leave(index, 3, f3);
    Force g3 = around.between(n2, n3, next_rest, 1, stress_of(item + 4, rest_scale(next_rest, 1)), g2);
    around.leave(index, 5, f5);
    const Force g5 = around.between(n3, n5, next_rest, 2, stress_of(item + 5, rest_scale(next_rest, 2)), g3);
    around.leave(next, 2, g2);
    around.leave(next, 3, g3);
    if constexpr (R == Run::closed_fan) {
      around.leave(index, 4, sum(f4, g5));
    } else {
      around.leave(next, 5, g5);
    }
  }
  around.finish(index);
}

/// f_a = −V σ s_a onto the vertices of n batches: [Schwartz2002, eq. 1] without its tensors.
/// `stress_of(item, w)` is the stress of an item times kForceScale.
template <class StressOf>
HWY_INLINE void push_batches(const Elements& e, std::size_t begin, std::size_t n, float* forces,
                             const StressOf& stress_of) {
  const auto item = [](std::size_t batch) GLISSON_INLINED { return kChainTets * batch; };
  std::size_t b = 0;
  for (; b < n && begin + b < 2 * e.closed_pairs; b += 2) {
    push_run<Run::closed_fan>(e, begin + b, forces, stress_of, item(b));
  }
  for (; b < n && begin + b < 2 * e.pairs; b += 2) push_run<Run::fan>(e, begin + b, forces, stress_of, item(b));
  for (; b < n; ++b) push_run<Run::chain>(e, begin + b, forces, stress_of, item(b));
}

/// Whose stress a push carries.
enum class Push { elastic, viscous, merged };

/// σ = λ(x) tr(ε) I + 2 μ(x) ε of one tet of a batch times kForceScale [Schwartz2002, eq. 6], plus the viscous stress
/// [Schwartz2002, eq. 7]; 0 where there is none, since its gradients are 0.
template <Push P>
struct ScaledStress {
  using Force = Xyz;
  const Elements& e;
  const Block& block;

  HWY_INLINE Stress<F> operator()(std::size_t item, F) const {
    const Lanes d;
    if constexpr (P == Push::viscous) return load_symmetric(block.viscous + item * 6 * kLanes);
    const F lambda = hn::Set(d, kForceScale * e.tissue.lambda) * hn::Load(d, block.value[0] + item * kLanes);
    const F mu = hn::Set(d, kForceScale * e.tissue.mu) * hn::Load(d, block.value[e.mu_law] + item * kLanes);
    const Stress<F> elastic = stress(load_tensor(block.gradient + item * 9 * kLanes), lambda, mu);
    if constexpr (P == Push::elastic) return elastic;
    return sum(elastic, load_symmetric(block.viscous + item * 6 * kLanes));
  }
};

/// P of one tet of a batch times kForceScale; 0 where there is none, whatever its branches remember.
struct ScaledPiola {
  using Force = Xyz;
  const float* piola;

  HWY_INLINE Piola<F> operator()(std::size_t item, F w) const {
    const Lanes d;
    const F factor = hn::IfThenElseZero(hn::Gt(w, hn::Zero(d)), hn::Set(d, kForceScale));
    Piola<F> p;
    for (std::size_t k = 0; k < 9; ++k) {
      p.p[k / 3][k % 3] = hn::Load(d, piola + (item * 9 + k) * kLanes) * factor;
    }
    return p;
  }
};

/// A stress that is scaled already; 0 where there is no tet, whatever its branches remember.
struct StoredStress {
  using Force = Xyz;
  const float* stress;

  HWY_INLINE Stress<F> operator()(std::size_t item, F w) const {
    const Lanes d;
    const auto present = hn::Gt(w, hn::Zero(d));
    const auto get = [&](std::size_t k)
                         GLISSON_INLINED { return hn::MaskedLoad(present, d, stress + (item * 6 + k) * kLanes); };
    return {get(0), get(1), get(2), get(3), get(4), get(5)};
  }
};

/// Two of these.
template <class Elastic, class Viscous>
struct StressesApart {
  using Force = ForcePair;
  Elastic elastic;
  Viscous viscous;

  HWY_INLINE auto operator()(std::size_t item, F w) const {
    return StressPair<decltype(elastic(item, w))>{elastic(item, w), viscous(item, w)};
  }
};

template <Push P>
inline void push(const Elements& e, std::size_t begin, std::size_t n, const Block& block) {
  push_batches(e, begin, n, P == Push::viscous ? e.viscous : e.elastic, ScaledStress<P>{e, block});
}

inline void push_piola(const Elements& e, std::size_t begin, std::size_t n, const float* piola, float* forces) {
  push_batches(e, begin, n, forces, ScaledPiola{piola});
}

inline void push_stress(const Elements& e, std::size_t begin, std::size_t n, const float* stress, float* forces) {
  push_batches(e, begin, n, forces, StoredStress{stress});
}

inline void push_apart(const Elements& e, std::size_t begin, std::size_t n, const Block& block) {
  const StressesApart<ScaledStress<Push::elastic>, ScaledStress<Push::viscous>> apart{{e, block}, {e, block}};
  push_batches(e, begin, n, e.pairs_of_forces, apart);
}
inline void push_piolas_apart(const Elements& e, std::size_t begin, std::size_t n, const float* elastic,
                              const float* viscous) {
  push_batches(e, begin, n, e.pairs_of_forces, StressesApart<ScaledPiola, ScaledPiola>{{elastic}, {viscous}});
}
inline void push_stresses_apart(const Elements& e, std::size_t begin, std::size_t n, const float* elastic,
                                const float* viscous) {
  push_batches(e, begin, n, e.pairs_of_forces, StressesApart<StoredStress, StoredStress>{{elastic}, {viscous}});
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_ELEMENT_STAGES_INL_H_
