// compare_linear-inl.h — a tissue's stress beside that of its linear twin, for the choice of precision (precision_choice.h).
//
// Included once per instruction set, never from outside response_kernels.cpp.
#if defined(GLISSON_COMPARE_LINEAR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_COMPARE_LINEAR_INL_H_
#undef GLISSON_COMPARE_LINEAR_INL_H_
#else
#define GLISSON_COMPARE_LINEAR_INL_H_
#endif

#include "engine/kernels/viscous_response-inl.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

/// Branches of small strain between two looks, where the tet is linear: q = decay q₀ + from S₀ + to S, which is kept, as S is. Of
/// others q is what the next step will find. The stresses as from maxwell().
inline void follow_branches(const ResponseItems& in, const LaneResponse& r, const MaxwellStep& step, bool linear,
                            float* stress, ResponseBlock& out) {
  for (std::size_t item = 0; item < in.items; ++item) {
    const Tensor H = load_tensor(in.gradient + item * 9 * kLanes);
    const Tensor P = load_tensor(out.piola + item * 9 * kLanes);
    const Symmetric S = relaxing_stress(r, H, P), before = load_symmetric(stress + item * 6 * kLanes);
    Symmetric over = times(hn::Zero(Lanes()), S);
    for (std::size_t k = 0; k < r.branches; ++k) {
      float* memory = in.memory + (item * r.branches + k) * 6 * kLanes;
      const LaneWeights& w = step.previous[k];
      Symmetric q = S;
      if (!step.relaxed) q = plus(load_symmetric(memory), number(w.to), S);
      if (linear) {
        q = plus(times(number(w.decay), load_symmetric(memory)), number(w.from), before);
        q = plus(q, number(w.to), S);
        store_symmetric(q, memory);
      }
      over = plus(over, number(r.share[k]), plus(S, number(-1.0F), q));
    }
    store_symmetric(S, stress + item * 6 * kLanes);
    store_tensor(full_tensor(over), out.viscous + item * 9 * kLanes);
    store_tensor(plus(P, number(-r.relaxing), full_tensor(S)), out.piola + item * 9 * kLanes);
  }
}

/// P of small strain as it is once all branches have relaxed.
inline void relax_all(const ResponseItems& in, const LaneResponse& r, ResponseBlock& out) {
  for (std::size_t item = 0; item < in.items; ++item) {
    const Tensor P = load_tensor(out.piola + item * 9 * kLanes);
    const Symmetric S = relaxing_stress(r, load_tensor(in.gradient + item * 9 * kLanes), P);
    store_tensor(plus(P, number(-r.relaxing), full_tensor(S)), out.piola + item * 9 * kLanes);
  }
}

HWY_INLINE F contraction(const Tensor& a, const Tensor& b) {
  F sum = hn::Zero(Lanes());
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) sum = hn::MulAdd(a.h[i][j], b.h[i][j], sum);
  }
  return sum;
}

/// λ tr H I + 2 μ sym H.
HWY_INLINE Tensor linear_stress(float lambda, float mu, const Tensor& H) {
  const Symmetric e = symmetric_part(H);
  return full_tensor(plus_identity(times(number(2.0F * mu), e), number(lambda) * trace_of(e)));
}

inline void compare_linear(const ResponseItems& in, const float* rest, const LaneTissue& twin, bool late,
                           const ResponseBlock& out, WorkSeen& seen) {
  const Lanes d;
  const F none = hn::Zero(d);
  F work = hn::Load(d, seen.work.data()), error = hn::Load(d, seen.error.data());
  F elastic = hn::Load(d, seen.elastic.data());
  for (std::size_t item = 0; item < in.items; ++item) {
    const float* scale = rest + (item / kChainTets * kChainRest + kRestScale + item % kChainTets) * kLanes;
    const F w = hn::Load(d, scale);  // 1/6V
    const F volume = hn::IfThenElse(hn::Ne(w, none), number(1.0F / 6.0F) / w, none);
    const Tensor H = load_tensor(in.gradient + item * 9 * kLanes);
    const Tensor P = load_tensor(out.piola + item * 9 * kLanes);
    const F own = contraction(P, H), linear = contraction(linear_stress(twin.lambda, twin.mu, H), H);
    F beside = none, drag = none;
    if (late) beside = contraction(load_tensor(out.viscous + item * 9 * kLanes), H);
    if (in.rate != nullptr) {
      const Tensor rate = load_tensor(in.rate + item * 9 * kLanes);
      drag = contraction(linear_stress(twin.viscous_lambda, twin.viscous_mu, rate), H);
    }
    work = hn::MulAdd(volume, own + beside, work);
    elastic = hn::MulAdd(volume, linear - own, elastic);
    error = hn::MulAdd(volume, (linear - own) + (drag - beside), error);
  }
  hn::Store(work, d, seen.work.data()), hn::Store(error, d, seen.error.data());
  hn::Store(elastic, d, seen.elastic.data());
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_COMPARE_LINEAR_INL_H_
