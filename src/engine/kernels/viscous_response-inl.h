// viscous_response-inl.h — fibres, Maxwell branches and Kelvin–Voigt viscosity of large deformation in lanes.
//
// A branch's memory is r = decay q(t) + from S(t): all of q(t + h) but what S(t + h) adds, so that S itself need not be
// kept (weights: element/tissue_operator.cpp).
//
// Included once per instruction set, never from outside response_kernels.cpp.
#if defined(GLISSON_VISCOUS_RESPONSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_VISCOUS_RESPONSE_INL_H_
#undef GLISSON_VISCOUS_RESPONSE_INL_H_
#else
#define GLISSON_VISCOUS_RESPONSE_INL_H_
#endif

#include "engine/kernels/elastic_response-inl.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

/// F S, or S for small strain.
HWY_INLINE Tensor carried(const LaneResponse& r, const Tensor& H, const Symmetric& S) {
  return r.small ? full_tensor(S) : tensor_product(plus_identity(H, number(1.0F)), S);
}

inline void fibres(const ResponseItems& in, const LaneResponse& r, ResponseBlock& out) {
  const Lanes d;
  const F c = number(r.fibre), rest = number(r.rest_bound);
  for (std::size_t item = 0; item < in.items; ++item) {
    const Tensor H = load_tensor(in.gradient + item * 9 * kLanes);
    const F a[3] = {hn::Load(d, in.fibre + item * 3 * kLanes), hn::Load(d, in.fibre + (item * 3 + 1) * kLanes),
                    hn::Load(d, in.fibre + (item * 3 + 2) * kLanes)};
    F Ha[3], carried_a[3];
    for (std::size_t i = 0; i < 3; ++i) {
      Ha[i] = hn::MulAdd(H.h[i][2], a[2], hn::MulAdd(H.h[i][1], a[1], H.h[i][0] * a[0]));
      carried_a[i] = r.small ? a[i] : a[i] + Ha[i];
    }
    const F linear = hn::MulAdd(a[2], Ha[2], hn::MulAdd(a[1], Ha[1], a[0] * Ha[0]));
    const F square = hn::MulAdd(Ha[2], Ha[2], hn::MulAdd(Ha[1], Ha[1], Ha[0] * Ha[0]));
    const F along = r.small ? linear : hn::MulAdd(number(0.5F), square, linear);  // a·E a
    Tensor P = load_tensor(out.piola + item * 9 * kLanes);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) P.h[i][k] = hn::MulAdd(c * along, carried_a[i] * a[k], P.h[i][k]);
    }
    store_tensor(P, out.piola + item * 9 * kLanes);
    const Symmetric E = green_strain(H);
    const F stretch = hn::MulAdd(number(2.0F), hn::Sqrt(contraction(E, E)), number(1.0F));
    const F more = rest * (r.small ? c : c * (stretch + hn::Abs(along)));
    see_stiffness(out, item, hn::Load(d, out.ratio + item * kLanes) + more,
                  hn::Load(d, out.norm + item * kLanes) + more);
  }
}

/// S = F⁻¹ P without its part p I in the frame of the strain: of Cauchy's stress, of S, of σ = Rᵀ P (spherical_part of response.cpp).
HWY_INLINE Symmetric deviator_of_strain(const LaneResponse& r, const Tensor& H, const Symmetric& S, const Tensor& cof,
                                        F safe) {
  const F third = number(1.0F / 3.0F);
  if (r.volume == VolumeKind::green) return plus_identity(S, hn::Neg(trace_of(S) * third));
  const Symmetric E = green_strain(H);
  if (r.volume == VolumeKind::hyperelastic) {
    const Symmetric inverse = times(number(1.0F) / (safe * safe), symmetric_product(cof, cof));  // C⁻¹
    const F pressure = hn::MulAdd(number(2.0F), contraction(S, E), trace_of(S)) * third;
    return plus(S, hn::Neg(pressure), inverse);
  }
  const StretchTensors u = stretch_tensors(E, H, safe - number(1.0F), 0.5 * kSmallestVolume);
  const F pressure = (trace_of(S) + contraction(S, u.strain)) * third;  // S : U / 3
  return plus(S, hn::Neg(pressure), u.inverse);
}

/// S = F⁻¹ P or its deviator, fading where J → 0; sym P for small strain.
HWY_INLINE Symmetric relaxing_stress(const LaneResponse& r, const Tensor& H, const Tensor& P) {
  const F third = number(1.0F / 3.0F);
  if (r.small) {
    const Symmetric S = symmetric_part(P);
    return r.deviator ? plus_identity(S, hn::Neg(trace_of(S) * third)) : S;
  }
  const F limit = number(float(kSmallestVolume)), J = invariants(Lanes(), H).volume_change + number(1.0F);
  const F safe = hn::Max(J, number(float(0.5 * kSmallestVolume)));
  const F fade = hn::Min(hn::MulSub(number(float(2.0 / kSmallestVolume)), safe, number(1.0F)), number(1.0F));
  const Tensor cof = plus_identity(cofactor_change(H), number(1.0F));
  Symmetric S = times(number(1.0F) / safe, symmetric_product(cof, P));
  if (r.deviator) S = deviator_of_strain(r, H, S, cof, safe);
  return times(hn::IfThenElse(hn::Lt(J, limit), hn::Max(fade, hn::Zero(Lanes())), number(1.0F)), S);
}

inline void maxwell(const ResponseItems& in, const LaneResponse& r, const MaxwellStep& step, ResponseBlock& out) {
  for (std::size_t item = 0; item < in.items; ++item) {
    const Tensor H = load_tensor(in.gradient + item * 9 * kLanes);
    const Tensor P = load_tensor(out.piola + item * 9 * kLanes);
    const Symmetric S = relaxing_stress(r, H, P);
    Symmetric over = times(hn::Zero(Lanes()), S);
    for (std::size_t k = 0; k < r.branches; ++k) {
      float* memory = in.memory + (item * r.branches + k) * 6 * kLanes;
      const Symmetric q = step.relaxed ? S : plus(load_symmetric(memory), number(step.previous[k].to), S);
      over = plus(over, number(r.share[k]), plus(S, number(-1.0F), q));
      if (step.moves) store_symmetric(plus(times(number(step.next[k].decay), q), number(step.next[k].from), S), memory);
    }
    store_tensor(carried(r, H, over), out.viscous + item * 9 * kLanes);
    store_tensor(plus(P, number(-r.relaxing), carried(r, H, S)), out.piola + item * 9 * kLanes);
  }
}

inline void viscous(const ResponseItems& in, const LaneResponse& r, bool add, ResponseBlock& out) {
  const F a = number(r.moduli.viscous_lambda), b = number(2.0F * r.moduli.viscous_mu), one = number(1.0F);
  for (std::size_t item = 0; item < in.items; ++item) {
    const Tensor H = load_tensor(in.gradient + item * 9 * kLanes), rate = load_tensor(in.rate + item * 9 * kLanes);
    Symmetric e = symmetric_part(rate);
    F stretch = one;
    if (!r.small) {
      const Symmetric E = green_strain(H);
      e = plus(e, one, symmetric_product(H, rate));
      stretch = hn::MulAdd(number(2.0F), hn::Sqrt(contraction(E, E)), one);
      if (r.pioletti) {
        const F excess = number(2.0F) * trace_of(E);
        stretch = stretch * (one + excess);
        e = times(hn::Max(excess, hn::Zero(Lanes())), e);
      }
    }
    Tensor P = carried(r, H, plus_identity(times(b, e), a * trace_of(e)));
    if (add) P = plus(P, one, load_tensor(out.viscous + item * 9 * kLanes));
    store_tensor(P, out.viscous + item * 9 * kLanes);
    if (r.small) continue;
    const F ratio = hn::Load(Lanes(), out.ratio + item * kLanes), norm = hn::Load(Lanes(), out.norm + item * kLanes);
    see_stiffness(out, item, hn::Max(ratio, stretch), hn::Max(norm, stretch));
  }
}

inline void merge(std::size_t items, ResponseBlock& out) {
  for (std::size_t k = 0; k < items * 9 * kLanes; k += kLanes) {
    hn::Store(hn::Load(Lanes(), out.piola + k) + hn::Load(Lanes(), out.viscous + k), Lanes(), out.piola + k);
  }
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_VISCOUS_RESPONSE_INL_H_
