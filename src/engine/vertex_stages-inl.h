// vertex_stages-inl.h — the state in double and back: narrow to float records, kick and drift, book the work.
//
// Included once per instruction set, never from outside kernels.cpp.
#if defined(GLISSON_VERTEX_STAGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_VERTEX_STAGES_INL_H_
#undef GLISSON_VERTEX_STAGES_INL_H_
#else
#define GLISSON_VERTEX_STAGES_INL_H_
#endif

#include "engine/kernels.h"
#include "engine/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

/// Up to four doubles: one of the two halves of a state record, or a part of it.
using Doubles = hn::CappedTag<double, 4>;
using D4 = hn::Vec<Doubles>;
using Narrow = hn::Rebind<float, Doubles>;
inline constexpr std::size_t kDoubles = HWY_TARGET == HWY_SCALAR ? 1 : (HWY_MAX_BYTES >= 32 ? 4 : 2);

/// Only differences against `origin` reach float, so that a body far from rest loses no digits.
HWY_INLINE void narrow_one(const double* state, const double* origin, float* out) {
  for (std::size_t k = 0; k < kStateDoubles; k += kDoubles) {
    const D4 difference = hn::Sub(hn::Load(Doubles(), state + k), hn::Load(Doubles(), origin + k));
    hn::Store(hn::DemoteTo(Narrow(), difference), Narrow(), out + k);
  }
}

inline void narrow(const double* state, const double* origin, std::size_t n, float* out) {
  for (std::size_t i = 0; i < n; ++i) narrow_one(state + i * kStateDoubles, origin, out + i * kStateFloats);
}

inline void narrow_chosen(const double* state, const std::uint32_t* which, const double* origin, std::size_t n,
                          float* out) {
  for (std::size_t i = 0; i < n; ++i) narrow_one(state + which[i] * kStateDoubles, origin, out + i * kStateFloats);
}

inline void add(float* a, const float* b, std::size_t n) {
  const Lanes d;
  for (std::size_t i = 0; i < n; i += kLanes) hn::Store(hn::Load(d, a + i) + hn::Load(d, b + i), d, a + i);
}

inline bool all_finite(const float* values, std::size_t n) {
  const Lanes d;
  F sum = hn::Zero(d);
  for (std::size_t i = 0; i < n; i += kLanes) sum = hn::MulAdd(hn::Load(d, values + i), hn::Zero(d), sum);
  return hn::AllTrue(d, hn::Eq(sum, sum));
}

/// The first three of every four doubles from position k.
HWY_INLINE hn::Mask<Doubles> is_xyz(std::size_t k) { return hn::FirstN(Doubles(), k < 3 ? 3 - k : 0); }

HWY_INLINE void accumulate(double& sum, D4 value) { sum += hn::GetLane(hn::SumOfLanes(Doubles(), value)); }

template <bool kAccounted>
HWY_INLINE void advance(double* state, const float* elastic, const float* viscous, const Kick& kick, VertexWork* work) {
  const Doubles d;
  const double c = state[3], damping = state[7];
  const D4 h = hn::Set(d, kick.step), zero = hn::Zero(d);
  for (std::size_t k = 0; k < 4; k += kDoubles) {
    const auto xyz = is_xyz(k);
    const D4 before = hn::Load(d, state + 4 + k), u = hn::Load(d, state + k);
    const D4 fe = hn::PromoteTo(d, hn::Load(Narrow(), elastic + k));
    const D4 fv = kAccounted ? hn::PromoteTo(d, hn::Load(Narrow(), viscous + k)) : zero;
    const D4 pull = hn::Mul(hn::Set(d, kick.step * (1.0 - damping)), hn::Load(d, kick.gravity.data() + k));
    const D4 change = hn::MulAdd(hn::Set(d, c), hn::Add(fe, fv), hn::NegMulAdd(hn::Set(d, damping), before, pull));
    const D4 after = hn::Add(before, change);
    hn::Store(hn::IfThenElse(xyz, after, before), d, state + 4 + k);
    hn::Store(hn::IfThenElse(xyz, hn::MulAdd(h, after, u), u), d, state + k);
    if constexpr (kAccounted) {
      const D4 v0 = hn::IfThenElseZero(xyz, before), v1 = hn::IfThenElseZero(xyz, after);
      const double mass = c > 0.0 ? kick.step * (1.0 - damping) / c : 0.0;
      const double gamma = c > 0.0 ? damping / c : 0.0;
      const D4 weight = hn::Mul(hn::Set(d, mass), hn::Load(d, kick.gravity.data() + k));
      const D4 drag = hn::Mul(hn::Set(d, -gamma), v1);
      accumulate(work->elastic_before, hn::Mul(fe, v0)), accumulate(work->elastic_after, hn::Mul(fe, v1));
      accumulate(work->viscous_before, hn::Mul(fv, v0)), accumulate(work->viscous_after, hn::Mul(fv, v1));
      accumulate(work->damping_before, hn::Mul(drag, v0)), accumulate(work->damping_after, hn::Mul(drag, v1));
      accumulate(work->loads_before, hn::Mul(weight, v0)), accumulate(work->loads_after, hn::Mul(weight, v1));
      accumulate(work->kinetic, hn::Mul(hn::Set(d, 0.5 * mass), hn::Mul(v0, v1)));
    }
  }
}

inline void integrate(double* state, const float* force, std::size_t n, const Kick& kick) {
  for (std::size_t i = 0; i < n; ++i) {
    advance<false>(state + i * kStateDoubles, force + i * kForceFloats, nullptr, kick, nullptr);
  }
}

inline void integrate_accounted(double* state, const float* elastic, const float* viscous, std::size_t n,
                                const Kick& kick, VertexWork& work) {
  for (std::size_t i = 0; i < n; ++i) {
    advance<true>(state + i * kStateDoubles, elastic + i * kForceFloats, viscous + i * kForceFloats, kick, &work);
  }
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_VERTEX_STAGES_INL_H_
