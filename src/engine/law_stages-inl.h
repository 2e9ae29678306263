// law_stages-inl.h — each law of the tissue room in lanes: the modulus and its slope.
//
// Parameters come from lane_law() in that order (lane_law.cpp). A law there and here is the same formula as
// its file under include/glisson/laws; law_lanes_test.cpp holds them together.
//
// Included once per instruction set, never from outside kernels.cpp.
#if defined(GLISSON_LAW_STAGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_LAW_STAGES_INL_H_
#undef GLISSON_LAW_STAGES_INL_H_
#else
#define GLISSON_LAW_STAGES_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>

#include "engine/kernels.h"
#include "engine/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

struct ValueSlope {
  F value, slope;
};

/// Runs `f` over n numbers; n is a multiple of the lanes.
template <class Law>
HWY_INLINE void for_lanes(const float* x, std::size_t n, float* value, float* slope, const Law& f) {
  for (std::size_t i = 0; i < n; i += kLanes) {
    const ValueSlope m = f(hn::Load(Lanes(), x + i));
    hn::Store(m.value, Lanes(), value + i);
    hn::Store(m.slope, Lanes(), slope + i);
  }
}

/// A modulus below 0 is 0, and stays there.
HWY_INLINE ValueSlope not_below_zero(F value, F slope) {
  const F zero = hn::Zero(Lanes());
  const auto positive = hn::Gt(value, zero);
  return {hn::IfThenElse(positive, value, zero), hn::IfThenElse(positive, slope, zero)};
}

inline void constant_law(const LaneLaw& law, const float* x, std::size_t n, float* value, float* slope) {
  const ValueSlope rest{hn::Set(Lanes(), law.base), hn::Zero(Lanes())};
  for_lanes(x, n, value, slope, [&](F) GLISSON_INLINED { return rest; });
}

/// numbers: rise (M above − M₀), threshold, width (0: sharp)
inline void step_law(const LaneLaw& law, const float* x, std::size_t n, float* value, float* slope) {
  const Lanes d;
  const F base = hn::Set(d, law.base), rise = hn::Set(d, law.numbers[0]), threshold = hn::Set(d, law.numbers[1]);
  const F zero = hn::Zero(d), one = hn::Set(d, 1.0F), half = hn::Set(d, 0.5F), three = hn::Set(d, 3.0F);
  const float width = law.numbers[2];
  if (!(width > 0.0F)) {
    for_lanes(x, n, value, slope, [&](F a) GLISSON_INLINED {
      return ValueSlope{hn::IfThenElse(hn::Lt(a, threshold), base, base + rise), zero};
    });
    return;
  }
  const F inverse_width = hn::Set(d, 1.0F / width), six_rise = hn::Set(d, 6.0F / width) * rise;
  for_lanes(x, n, value, slope, [&](F a) GLISSON_INLINED {
    const F t = hn::Min(hn::Max(hn::MulAdd(a - threshold, inverse_width, half), zero), one);
    return ValueSlope{hn::MulAdd(rise, t * t * (three - (t + t)), base), six_rise * t * (one - t)};
  });
}

/// numbers: slope
inline void linear_law(const LaneLaw& law, const float* x, std::size_t n, float* value, float* slope) {
  const F k = hn::Set(Lanes(), law.numbers[0]), base = hn::Set(Lanes(), law.base);
  for_lanes(x, n, value, slope, [&](F a) GLISSON_INLINED { return not_below_zero(hn::MulAdd(k, a, base), k); });
}

/// numbers: c₁, c₂, …
inline void polynomial_law(const LaneLaw& law, const float* x, std::size_t n, float* value, float* slope) {
  const Lanes d;
  const F base = hn::Set(d, law.base);
  for_lanes(x, n, value, slope, [&](F a) GLISSON_INLINED {
    F m = hn::Zero(d), dm = hn::Zero(d);  // c₁ + c₂ x + …, and its derivative
    for (std::size_t i = law.numbers.size(); i-- > 0;) {
      dm = hn::MulAdd(dm, a, m);
      m = hn::MulAdd(m, a, hn::Set(d, law.numbers[i]));
    }
    return not_below_zero(hn::MulAdd(m, a, base), hn::MulAdd(dm, a, m));
  });
}

/// numbers: A, b, largest exponent
inline void exponential_law(const LaneLaw& law, const float* x, std::size_t n, float* value, float* slope) {
  const Lanes d;
  const F A = hn::Set(d, law.numbers[0]), b = hn::Set(d, law.numbers[1]), most = hn::Set(d, law.numbers[2]);
  const F base = hn::Set(d, law.base), one = hn::Set(d, 1.0F), zero = hn::Zero(d);
  for_lanes(x, n, value, slope, [&](F a) GLISSON_INLINED {
    const F e = b * a, growth = hn::Expm1(d, hn::Min(e, most));
    const F rate = hn::IfThenElse(hn::Gt(e, most), zero, A * b * (growth + one));
    return not_below_zero(hn::MulAdd(A, growth, base), rate);
  });
}

/// numbers: x_i, then M_i, then the slope right of each x_i (0 for the last)
inline void table_law(const LaneLaw& law, const float* x, std::size_t n, float* value, float* slope) {
  const Lanes d;
  const std::size_t points = law.numbers.size() / 3;
  const float *at = law.numbers.data(), *modulus = at + points, *rise = modulus + points;
  for_lanes(x, n, value, slope, [&](F a) GLISSON_INLINED {
    F m = hn::Set(d, modulus[0]), k = hn::Zero(d), from = hn::Set(d, at[0]);
    for (std::size_t i = 0; i < points; ++i) {
      const F xi = hn::Set(d, at[i]);
      const auto right = hn::Ge(a, xi);
      m = hn::IfThenElse(right, hn::Set(d, modulus[i]), m);
      k = hn::IfThenElse(right, hn::Set(d, rise[i]), k);
      from = hn::IfThenElse(right, xi, from);
    }
    return ValueSlope{hn::MulAdd(k, a - from, m), k};
  });
}

HWY_INLINE void take_largest(F stiffness, F slope_squared, StiffnessSeen& seen) {
  seen.stiffness = std::max(seen.stiffness, hn::GetLane(hn::MaxOfLanes(Lanes(), stiffness)));
  seen.slope_squared = std::max(seen.slope_squared, hn::GetLane(hn::MaxOfLanes(Lanes(), slope_squared)));
}

/// A value of tets that are there; lanes without one have y < 0 where they could be mistaken for some.
HWY_INLINE F of_present(F y, F value) { return hn::IfThenZeroElse(hn::Lt(y, hn::Zero(Lanes())), value); }

inline void watch_young(const Block& block, const LaneTissue&, std::size_t n, StiffnessSeen& seen) {
  const Lanes d;
  F most = hn::Zero(d), steepest = hn::Zero(d);
  for (std::size_t i = 0; i < n; i += kLanes) {
    const F k = hn::Load(d, block.slope[0] + i), y = hn::Load(d, block.y + i);
    most = hn::Max(most, of_present(y, hn::Load(d, block.value[0] + i)));
    steepest = hn::Max(steepest, k * k * y);
  }
  take_largest(most, steepest, seen);
}

/// A tensor λ A + μ B is at most max(μ/μ₀, K/K₀) times that at rest, K = λ + ⅔ μ; its slope likewise.
inline void watch_lame(const Block& block, const LaneTissue& tissue, std::size_t n, StiffnessSeen& seen) {
  const Lanes d;
  const float bulk = tissue.bulk_over_two_mu * 2.0F * tissue.rest_mu;
  const F per_mu = hn::Set(d, 1.0F / tissue.rest_mu), per_bulk = hn::Set(d, 1.0F / bulk),
          part = hn::Set(d, 2.0F / 3.0F);
  F most = hn::Zero(d), steepest = hn::Zero(d);
  for (std::size_t i = 0; i < n; i += kLanes) {
    const F lambda = hn::Load(d, block.value[0] + i), mu = hn::Load(d, block.value[1] + i);
    const F dl = hn::Abs(hn::Load(d, block.slope[0] + i)), dm = hn::Abs(hn::Load(d, block.slope[1] + i));
    const F k = hn::Max(dm * per_mu, hn::MulAdd(part, dm, dl) * per_bulk);
    const F y = hn::Load(d, block.y + i);
    most = hn::Max(most, of_present(y, hn::Max(mu * per_mu, hn::MulAdd(part, mu, lambda) * per_bulk)));
    steepest = hn::Max(steepest, k * k * y);
  }
  take_largest(most, steepest, seen);
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_LAW_STAGES_INL_H_
