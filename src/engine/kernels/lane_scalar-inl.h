// lane_scalar-inl.h — a vector of lanes with the words of include/glisson/material/scalar.h: what a law's formula runs on.
//
// These functions are inline, not always_inline: a formula is parsed outside of the instruction set's region, where what
// must be inlined would be refused. It is inlined itself (GLISSON_FORMULA), and takes them along into the kernel.
//
// Included once per instruction set, never from outside kernels.cpp and response_kernels.cpp.
#if defined(GLISSON_LANE_SCALAR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_LANE_SCALAR_INL_H_
#undef GLISSON_LANE_SCALAR_INL_H_
#else
#define GLISSON_LANE_SCALAR_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>

#include <concepts>

#include "engine/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

struct LaneScalar {
  F v;

  inline explicit LaneScalar(F lanes) : v(lanes) {}
  template <class Number>
  requires std::floating_point<Number> || std::integral<Number>
  inline explicit LaneScalar(Number x) : v(hn::Set(Lanes(), static_cast<float>(x))) {}
};
using LaneChoice = decltype(hn::Lt(F(), F()));

inline LaneScalar operator+(LaneScalar a, LaneScalar b) { return LaneScalar(a.v + b.v); }
inline LaneScalar operator-(LaneScalar a, LaneScalar b) { return LaneScalar(a.v - b.v); }
inline LaneScalar operator*(LaneScalar a, LaneScalar b) { return LaneScalar(a.v * b.v); }
inline LaneScalar operator/(LaneScalar a, LaneScalar b) { return LaneScalar(a.v / b.v); }
inline LaneScalar operator-(LaneScalar a) { return LaneScalar(hn::Neg(a.v)); }
inline LaneChoice operator<(LaneScalar a, LaneScalar b) { return hn::Lt(a.v, b.v); }
inline LaneChoice operator>(LaneScalar a, LaneScalar b) { return hn::Gt(a.v, b.v); }
inline LaneChoice operator>=(LaneScalar a, LaneScalar b) { return hn::Ge(a.v, b.v); }

inline LaneScalar select(LaneChoice choice, LaneScalar yes, LaneScalar no) {
  return LaneScalar(hn::IfThenElse(choice, yes.v, no.v));
}
inline LaneScalar min(LaneScalar a, LaneScalar b) { return LaneScalar(hn::Min(a.v, b.v)); }
inline LaneScalar max(LaneScalar a, LaneScalar b) { return LaneScalar(hn::Max(a.v, b.v)); }
inline LaneScalar mul_add(LaneScalar a, LaneScalar b, LaneScalar c) { return LaneScalar(hn::MulAdd(a.v, b.v, c.v)); }
inline LaneScalar exp(LaneScalar a) { return LaneScalar(hn::Exp(Lanes(), a.v)); }
inline LaneScalar log(LaneScalar a) { return LaneScalar(hn::Log(Lanes(), a.v)); }
inline LaneScalar expm1(LaneScalar a) { return LaneScalar(hn::Expm1(Lanes(), a.v)); }

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_LANE_SCALAR_INL_H_
