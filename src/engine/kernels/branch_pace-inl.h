// branch_pace-inl.h — Maxwell branches whose times follow the deformation, in lanes.
//
//   o = S − q:   o(t + h) = e^(−ξ) o(t) + ½ (1 + e^(−ξ)) (S(t + h) − S(t)),   ξ = ½ h (1/τ(t) + 1/τ(t + h))
//
// by the weights of branch_weights.h that take energy in every step.
//
// ξ is known at the end of the step alone, so the memory keeps what the weights act on: o of each branch, S, and 1/τ of each
// branch. o rather than q, because its float then decays by a rounding of its own size, however short the step is.
//
// Included once per instruction set, never from outside response_kernels.cpp and response_flops.cpp.
#if defined(GLISSON_BRANCH_PACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_BRANCH_PACE_INL_H_
#undef GLISSON_BRANCH_PACE_INL_H_
#else
#define GLISSON_BRANCH_PACE_INL_H_
#endif

#include <array>
#include <tuple>
#include <type_traits>
#include <variant>

#include "engine/kernels/lane_scalar-inl.h"
#include "engine/kernels/viscous_response-inl.h"
#include "material/time_formulas.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

/// 1/τ = e^(−ln φ)/τ₀.
template <class Law>
inline void pace_of(const LanePace& pace, const float* x, std::size_t n, float* value) {
  std::array<float, std::tuple_size_v<decltype(Law().numbers())>> numbers;
  std::copy_n(pace.numbers.begin(), numbers.size(), numbers.begin());
  const LaneScalar plain(pace.plain);
  for (std::size_t i = 0; i < n; i += kLanes) {
    const LaneScalar logarithm = Law::at(numbers, LaneScalar(hn::Load(Lanes(), x + i))).value;
    hn::Store((plain * exp(-logarithm)).v, Lanes(), value + i);
  }
}
inline void constant_pace(const LanePace& pace, const float*, std::size_t n, float* value) {
  for (std::size_t i = 0; i < n; i += kLanes) hn::Store(number(pace.plain), Lanes(), value + i);
}
template <class... Laws>
constexpr PaceStages pace_stages(std::type_identity<std::variant<Laws...>>) {
  return {pace_of<Laws>..., constant_pace};
}

inline void following(const ResponseItems& in, const LaneResponse& r, const MaxwellStep& step, ResponseBlock& out) {
  const Lanes d;
  const F one = number(1.0F), none = hn::Zero(d), half_step = number(step.relaxed ? 0.0F : 0.5F * step.since);
  const std::size_t n = r.branches, numbers = 7 * n + 6;
  for (std::size_t item = 0; item < in.items; ++item) {
    const Tensor H = load_tensor(in.gradient + item * 9 * kLanes);
    const Tensor P = load_tensor(out.piola + item * 9 * kLanes);
    const Symmetric S = relaxing_stress(r, H, P);
    float* memory = in.memory + item * numbers * kLanes;
    float* before = memory + 6 * n * kLanes;
    float* paces = before + 6 * kLanes;
    const Symmetric change = plus(S, number(-1.0F), load_symmetric(before));
    Symmetric over = times(none, S);
    for (std::size_t k = 0; k < n; ++k) {
      const F pace = hn::Load(d, out.pace[k] + item * kLanes);
      Symmetric o = times(none, S);
      if (!step.relaxed) {
        const F xi = hn::Max(half_step * (hn::Load(d, paces + k * kLanes) + pace), none);
        const F rise = hn::Neg(hn::Expm1(d, hn::Neg(xi)));  // 1 − e^(−ξ)
        const Symmetric held = load_symmetric(memory + 6 * k * kLanes);
        o = plus(plus(held, hn::Neg(rise), held), hn::NegMulAdd(number(0.5F), rise, one), change);
      }
      over = plus(over, number(r.share[k]), o);
      if (!step.moves) continue;
      store_symmetric(o, memory + 6 * k * kLanes);
      hn::Store(pace, d, paces + k * kLanes);
    }
    if (step.moves) store_symmetric(S, before);
    store_tensor(carried(r, H, over), out.viscous + item * 9 * kLanes);
    store_tensor(plus(P, number(-r.relaxing), carried(r, H, S)), out.piola + item * 9 * kLanes);
  }
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_BRANCH_PACE_INL_H_
