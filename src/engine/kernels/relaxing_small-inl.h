// relaxing_small-inl.h — tissue of small strain with Maxwell branches in one pass: elastic, relaxing and viscous stress.
//
// With S the elastic stress, S′ the part of it that relaxes, q_k = r_k + to S′ what a branch has relaxed, and σ_v of
// [Schwartz2002, eq. 7]
//
//   P = S − Σ g_k q_k + σ_v,       r_k ← decay q_k + from S′
//
// All are symmetric: six numbers where the stages of viscous_response-inl.h take nine, and nothing is stored between them.
// Stresses are times kForceScale, which the moduli bring with them.
//
// Included once per instruction set, never from outside response_kernels.cpp.
#if defined(GLISSON_RELAXING_SMALL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_RELAXING_SMALL_INL_H_
#undef GLISSON_RELAXING_SMALL_INL_H_
#else
#define GLISSON_RELAXING_SMALL_INL_H_
#endif

#include "engine/kernels/elastic_response-inl.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

/// Goes through the branches of an item. @return −Σ g q
HWY_INLINE Symmetric relax(const LaneResponse& r, const MaxwellStep& step, float* memory, const Symmetric& S) {
  Symmetric relaxed = times(hn::Zero(Lanes()), S);
  for (std::size_t k = 0; k < r.branches; ++k, memory += 6 * kLanes) {
    const Symmetric q = plus(load_symmetric(memory), number(step.previous[k].to / kForceScale), S);
    relaxed = plus(relaxed, number(-kForceScale * r.share[k]), q);
    if (!step.moves) continue;
    store_symmetric(plus(times(number(step.next[k].decay), q), number(step.next[k].from / kForceScale), S), memory);
  }
  return relaxed;
}

/// The stages from H to the stresses: the elastic one into `out.piola`, six numbers an item, and the viscous one into
/// `block.viscous`; without kSplit their sum into `out.piola`. `block.viscous` brings −⅙ σ_v along where there is viscosity.
/// Without kLaw moduli are those at rest, and nobody has looked for inverted tets before.
template <bool kLaw, bool kSplit>
PassFound relaxing_small(const ResponseItems& in, const LaneResponse& r, const MaxwellStep& step, Block& block,
                         ResponseBlock& out) {
  const Lanes d;
  const F two = number(2.0F * kForceScale), scale = number(kForceScale), third = number(1.0F / 3.0F);
  F most = number(kLaw ? 0.0F : 1.0F), lowest = number(1.0F);
  for (std::size_t item = 0; item < in.items; ++item) {
    const Tensor H = load_tensor(in.gradient + item * 9 * kLanes);
    const Symmetric strain = symmetric_part(H);
    const F trace = trace_of(strain);
    F lambda = number(kForceScale * r.moduli.lambda), twice_mu = number(2.0F * kForceScale * r.moduli.mu);
    if constexpr (kLaw) {
      const LaneModuli k = moduli_of<true>(r, block, item);
      F bound = law_bound(r, k, trace, contraction(strain, strain), hn::Load(d, block.x + item * kLanes));
      bound = hn::IfThenZeroElse(hn::Lt(hn::Load(d, block.y + item * kLanes), hn::Zero(d)), bound);
      see_stiffness(out, item, bound, bound);
      most = hn::Max(most, hn::Load(d, out.ratio + item * kLanes));
      lambda = scale * k.lambda, twice_mu = two * k.mu;
    } else {
      lowest = hn::Min(lowest, invariants(d, H).volume_change);
    }
    const Symmetric S = plus_identity(times(twice_mu, strain), lambda * trace);
    const Symmetric part = r.deviator ? plus_identity(S, hn::Neg(trace_of(S) * third)) : S;
    Symmetric late = relax(r, step, in.memory + item * r.branches * 6 * kLanes, part);
    if (r.viscous) late = plus(late, number(1.0F), load_symmetric(block.viscous + item * 6 * kLanes));
    float* elastic = out.piola + item * 6 * kLanes;
    if constexpr (kSplit) {
      store_symmetric(plus(S, number(-r.relaxing), part), elastic);
      store_symmetric(plus(late, number(r.relaxing), part), block.viscous + item * 6 * kLanes);
    } else {
      store_symmetric(plus(S, number(1.0F), late), elastic);
    }
  }
  return {hn::GetLane(hn::MaxOfLanes(d, most)), is_inverted(lowest)};
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_RELAXING_SMALL_INL_H_
