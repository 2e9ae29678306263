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

#include <type_traits>
#include <variant>

#include "engine/kernels/kernels.h"
#include "engine/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

struct ValueSlope {
  F value, slope;
};

/// Runs `f` over n numbers and hands on what it gives; n is a multiple of the lanes.
template <class Law, class Take>
HWY_INLINE void for_lanes(const float* x, std::size_t n, Take& take, const Law& f) {
  for (std::size_t i = 0; i < n; i += kLanes) take(i, f(hn::Load(Lanes(), x + i)));
}

/// A modulus below 0 is 0, and stays there.
HWY_INLINE ValueSlope not_below_zero(F value, F slope) {
  const F zero = hn::Zero(Lanes());
  const auto positive = hn::Gt(value, zero);
  return {hn::IfThenElse(positive, value, zero), hn::IfThenElse(positive, slope, zero)};
}

template <class Take>
HWY_INLINE void constant_law(const LaneLaw& law, const float* x, std::size_t n, Take& take) {
  const ValueSlope rest{hn::Set(Lanes(), law.base), hn::Zero(Lanes())};
  for_lanes(x, n, take, [&](F) GLISSON_INLINED { return rest; });
}

/// numbers: rise (M above − M₀), threshold, width (0: sharp)
template <class Take>
HWY_INLINE void step_law(const LaneLaw& law, const float* x, std::size_t n, Take& take) {
  const Lanes d;
  const F base = hn::Set(d, law.base), rise = hn::Set(d, law.numbers[0]), threshold = hn::Set(d, law.numbers[1]);
  const F zero = hn::Zero(d), one = hn::Set(d, 1.0F), half = hn::Set(d, 0.5F), three = hn::Set(d, 3.0F);
  const float width = law.numbers[2];
  if (!(width > 0.0F)) {
    for_lanes(x, n, take, [&](F a) GLISSON_INLINED {
      return ValueSlope{hn::IfThenElse(hn::Lt(a, threshold), base, base + rise), zero};
    });
    return;
  }
  const F inverse_width = hn::Set(d, 1.0F / width), six_rise = hn::Set(d, 6.0F / width) * rise;
  for_lanes(x, n, take, [&](F a) GLISSON_INLINED {
    const F t = hn::Min(hn::Max(hn::MulAdd(a - threshold, inverse_width, half), zero), one);
    return ValueSlope{hn::MulAdd(rise, t * t * (three - (t + t)), base), six_rise * t * (one - t)};
  });
}

/// numbers: slope
template <class Take>
HWY_INLINE void linear_law(const LaneLaw& law, const float* x, std::size_t n, Take& take) {
  const F k = hn::Set(Lanes(), law.numbers[0]), base = hn::Set(Lanes(), law.base);
  for_lanes(x, n, take, [&](F a) GLISSON_INLINED { return not_below_zero(hn::MulAdd(k, a, base), k); });
}

/// numbers: c₁, c₂, …
template <class Take>
HWY_INLINE void polynomial_law(const LaneLaw& law, const float* x, std::size_t n, Take& take) {
  const Lanes d;
  const F base = hn::Set(d, law.base);
  for_lanes(x, n, take, [&](F a) GLISSON_INLINED {
    F m = hn::Zero(d), dm = hn::Zero(d);  // c₁ + c₂ x + …, and its derivative
    for (std::size_t i = law.numbers.size(); i-- > 0;) {
      dm = hn::MulAdd(dm, a, m);
      m = hn::MulAdd(m, a, hn::Set(d, law.numbers[i]));
    }
    return not_below_zero(hn::MulAdd(m, a, base), hn::MulAdd(dm, a, m));
  });
}

/// numbers: A, b, largest exponent
template <class Take>
HWY_INLINE void exponential_law(const LaneLaw& law, const float* x, std::size_t n, Take& take) {
  const Lanes d;
  const F A = hn::Set(d, law.numbers[0]), b = hn::Set(d, law.numbers[1]), most = hn::Set(d, law.numbers[2]);
  const F base = hn::Set(d, law.base), one = hn::Set(d, 1.0F), zero = hn::Zero(d);
  for_lanes(x, n, take, [&](F a) GLISSON_INLINED {
    const F e = b * a, growth = hn::Expm1(d, hn::Min(e, most));
    const F rate = hn::IfThenElse(hn::Gt(e, most), zero, A * b * (growth + one));
    return not_below_zero(hn::MulAdd(A, growth, base), rate);
  });
}

/// numbers: x_i, then M_i, then the slope right of each x_i (0 for the last)
template <class Take>
HWY_INLINE void table_law(const LaneLaw& law, const float* x, std::size_t n, Take& take) {
  const Lanes d;
  const std::size_t points = law.numbers.size() / 3;
  const float *at = law.numbers.data(), *modulus = at + points, *rise = modulus + points;
  for_lanes(x, n, take, [&](F a) GLISSON_INLINED {
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

/// A value of tets that are there; lanes without one have y < 0 where they could be mistaken for some.
HWY_INLINE F of_present(F y, F value) { return hn::IfThenZeroElse(hn::Lt(y, hn::Zero(Lanes())), value); }

/// The largest stiffness and slope² y of a block, lane by lane.
class Largest {
 public:
  HWY_INLINE Largest() : stiffness_(hn::Zero(Lanes())), slope_squared_(hn::Zero(Lanes())) {}
  HWY_INLINE void take(F stiffness, F slope, F y) {
    stiffness_ = hn::Max(stiffness_, of_present(y, stiffness));
    slope_squared_ = hn::Max(slope_squared_, slope * slope * y);
  }
  /// Adds them to what has been seen. @return whether stiffness + √slope_squared of a lane is above the limit
  HWY_INLINE bool add_to(StiffnessSeen& seen, float limit) const {
    const Lanes d;
    hn::Store(hn::Max(stiffness_, hn::Load(d, seen.stiffness.data())), d, seen.stiffness.data());
    hn::Store(hn::Max(slope_squared_, hn::Load(d, seen.slope_squared.data())), d, seen.slope_squared.data());
    const F left = hn::Max(hn::Set(d, limit) - stiffness_, hn::Zero(d));
    return !hn::AllTrue(d, hn::And(hn::Le(stiffness_, hn::Set(d, limit)), hn::Le(slope_squared_, left * left)));
  }

 private:
  F stiffness_, slope_squared_;
};

/// Keeps what a law gives.
struct StoreLaw {
  float *value, *slope;
  HWY_INLINE void operator()(std::size_t i, const ValueSlope& m) const {
    hn::Store(m.value, Lanes(), value + i);
    hn::Store(m.slope, Lanes(), slope + i);
  }
};

/// Keeps the values of a law on E, which are stiffnesses, and looks how large they are.
struct WatchLaw {
  const float* y;
  float* value;
  Largest largest;
  HWY_INLINE void operator()(std::size_t i, const ValueSlope& m) {
    hn::Store(m.value, Lanes(), value + i);
    largest.take(m.value, m.slope, hn::Load(Lanes(), y + i));
  }
};

/// Calls the law that is the K-th of StiffnessLaw.
template <std::size_t K, class Take>
HWY_INLINE void run_law(const LaneLaw& law, const float* x, std::size_t n, Take& take) {
  using Law = std::variant_alternative_t<K, StiffnessLaw>;
  if constexpr (std::is_same_v<Law, ConstantLaw>) {
    constant_law(law, x, n, take);
  } else if constexpr (std::is_same_v<Law, StepLaw>) {
    step_law(law, x, n, take);
  } else if constexpr (std::is_same_v<Law, LinearLaw>) {
    linear_law(law, x, n, take);
  } else if constexpr (std::is_same_v<Law, PolynomialLaw>) {
    polynomial_law(law, x, n, take);
  } else if constexpr (std::is_same_v<Law, ExponentialLaw>) {
    exponential_law(law, x, n, take);
  } else {
    static_assert(std::is_same_v<Law, TableLaw>);
    table_law(law, x, n, take);
  }
}

template <std::size_t K>
inline void store_law(const LaneLaw& law, const float* x, std::size_t n, float* value, float* slope) {
  StoreLaw take{value, slope};
  run_law<K>(law, x, n, take);
}

template <std::size_t K>
inline bool watch_law(const LaneLaw& law, Block& block, std::size_t n, float limit, StiffnessSeen& seen) {
  WatchLaw take{block.y, block.value[0], {}};
  run_law<K>(law, block.x, n, take);
  return take.largest.add_to(seen, limit);
}

/// A tensor λ A + μ B is at most max(μ/μ₀, K/K₀) times that at rest, K = λ + ⅔ μ; its slope likewise.
inline bool watch_lame(const Block& block, const LaneTissue& tissue, std::size_t n, float limit, StiffnessSeen& seen) {
  const Lanes d;
  const float bulk = tissue.bulk_over_two_mu * 2.0F * tissue.rest_mu;
  const F per_mu = hn::Set(d, 1.0F / tissue.rest_mu), per_bulk = hn::Set(d, 1.0F / bulk),
          part = hn::Set(d, 2.0F / 3.0F);
  Largest largest;
  for (std::size_t i = 0; i < n; i += kLanes) {
    const F lambda = hn::Load(d, block.value[0] + i), mu = hn::Load(d, block.value[1] + i);
    const F dl = hn::Abs(hn::Load(d, block.slope[0] + i)), dm = hn::Abs(hn::Load(d, block.slope[1] + i));
    largest.take(hn::Max(mu * per_mu, hn::MulAdd(part, mu, lambda) * per_bulk),
                 hn::Max(dm * per_mu, hn::MulAdd(part, dm, dl) * per_bulk), hn::Load(d, block.y + i));
  }
  return largest.add_to(seen, limit);
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_LAW_STAGES_INL_H_
