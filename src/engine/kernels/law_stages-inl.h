// law_stages-inl.h — the laws of stiffness run over an array of lanes: the modulus and its slope.
//
// A law is its own formula (src/material/stiffness_formulas.h) on LaneScalar; lane_law() has made its numbers ready.
//
// Included once per instruction set, never from outside kernels.cpp.
#if defined(GLISSON_LAW_STAGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_LAW_STAGES_INL_H_
#undef GLISSON_LAW_STAGES_INL_H_
#else
#define GLISSON_LAW_STAGES_INL_H_
#endif

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

#include "engine/kernels/kernels.h"
#include "engine/kernels/lane_scalar-inl.h"
#include "engine/kernels/stiff_list-inl.h"
#include "material/stiffness_formulas.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

/// A law's numbers for its formula: where their count is known a copy, which stores cannot change, so that the compiler
/// takes them out of loops.
template <class Law>
HWY_INLINE auto numbers_of(const LaneLaw& law) {
  using Made = decltype(std::declval<Law>().numbers(0.0));
  if constexpr (std::is_same_v<Made, std::vector<double>>) {
    return std::span<const float>(law.numbers);
  } else {
    std::array<float, std::tuple_size_v<Made>> copy;
    std::copy_n(law.numbers.begin(), copy.size(), copy.begin());
    return copy;
  }
}

/// Runs a law over n arguments and hands on what it gives; n is a multiple of the lanes.
template <class Law, class Take>
HWY_INLINE void run_law(const LaneLaw& law, const float* x, std::size_t n, Take& take) {
  const auto numbers = numbers_of<Law>(law);
  for (std::size_t i = 0; i < n; i += kLanes) {
    const ValueSlope<LaneScalar> m = Law::at(numbers, LaneScalar(hn::Load(Lanes(), x + i)));
    take(i, m.value.v, m.slope.v);
  }
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
  HWY_INLINE void operator()(std::size_t i, F modulus, F rise) const {
    hn::Store(modulus, Lanes(), value + i);
    hn::Store(rise, Lanes(), slope + i);
  }
};

/// Keeps the values of a law on E, which are stiffnesses, and looks how large they are.
struct WatchLaw {
  const float* y;
  float* value;
  Largest largest;
  HWY_INLINE void operator()(std::size_t i, F modulus, F rise) {
    hn::Store(modulus, Lanes(), value + i);
    largest.take(modulus, rise, hn::Load(Lanes(), y + i));
  }
};

template <class Law>
inline void store_law(const LaneLaw& law, const float* x, std::size_t n, float* value, float* slope) {
  StoreLaw take{value, slope};
  run_law<Law>(law, x, n, take);
}

template <class Law>
inline bool watch_law(const LaneLaw& law, Block& block, std::size_t n, float limit, StiffnessSeen& seen) {
  WatchLaw take{block.y, block.value[0], {}};
  run_law<Law>(law, block.x, n, take);
  return take.largest.add_to(seen, limit);
}

/// The stages of all laws, in the order of their list.
template <class... Laws>
constexpr std::array<LawStage, sizeof...(Laws)> store_laws(std::type_identity<std::variant<Laws...>>) {
  return {store_law<Laws>...};
}
template <class... Laws>
constexpr std::array<Kernels::WatchLaw, sizeof...(Laws)> watch_laws(std::type_identity<std::variant<Laws...>>) {
  return {watch_law<Laws>...};
}

/// Stiffness of a vector of tets over that at rest, and its slope.
struct Rise {
  F stiffness, slope;
};

/// A tensor λ A + μ B is at most max(μ/μ₀, K/K₀) times that at rest, K = λ + ⅔ μ; its slope likewise.
class LameRise {
 public:
  HWY_INLINE LameRise(const Block& block, const LaneTissue& tissue)
      : block_(block), per_mu_(hn::Set(Lanes(), 1.0F / tissue.rest_mu)),
        per_bulk_(hn::Set(Lanes(), 1.0F / (tissue.bulk_over_two_mu * 2.0F * tissue.rest_mu))) {}
  HWY_INLINE Rise operator()(std::size_t i) const {
    const Lanes d;
    const auto of = [&](F lambda, F mu) GLISSON_INLINED {
      return hn::Max(mu * per_mu_, hn::MulAdd(hn::Set(d, 2.0F / 3.0F), mu, lambda) * per_bulk_);
    };
    return {of(hn::Load(d, block_.value[0] + i), hn::Load(d, block_.value[1] + i)),
            of(hn::Abs(hn::Load(d, block_.slope[0] + i)), hn::Abs(hn::Load(d, block_.slope[1] + i)))};
  }

 private:
  const Block& block_;
  F per_mu_, per_bulk_;
};

/// The same of a law on E, whose value it is.
struct YoungRise {
  const Block& block;
  HWY_INLINE Rise operator()(std::size_t i) const {
    return {hn::Load(Lanes(), block.value[0] + i), hn::Load(Lanes(), block.slope[0] + i)};
  }
};

inline bool watch_lame(const Block& block, const LaneTissue& tissue, std::size_t n, float limit, StiffnessSeen& seen) {
  const LameRise rise(block, tissue);
  Largest largest;
  for (std::size_t i = 0; i < n; i += kLanes) {
    const Rise r = rise(i);
    largest.take(r.stiffness, r.slope, hn::Load(Lanes(), block.y + i));
  }
  return largest.add_to(seen, limit);
}

/// The limits of a vector of tets, each its own: of laws on moduli ratio and norm are one.
HWY_INLINE F single_limits(const ListLimits& limits, std::size_t i) {
  const Lanes d;
  const F own = hn::GatherIndex(d, &limits.single->ratio, place_of_limits(limits, i));
  return hn::Max(hn::Set(d, limits.block), own * hn::Set(d, kBelowLimit));
}

template <class RiseOf>
HWY_INLINE std::size_t list_above(const Block& block, const RiseOf& rise, std::size_t n, const ListLimits& limits,
                                  std::uint16_t* which) {
  const Lanes d;
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; i += kLanes) {
    const Rise r = rise(i);
    const F y = hn::Load(d, block.y + i);
    const auto is_above = [&](F limit) GLISSON_INLINED {
      const F left = limit - r.stiffness;
      return hn::Or(hn::Lt(left, hn::Zero(d)), hn::Gt(r.slope * r.slope * y, left * left));
    };
    auto above = is_above(hn::Set(d, limits.block));
    if (hn::AllFalse(d, above)) continue;
    if (limits.single != nullptr) above = is_above(single_limits(limits, i));
    count = put_places(above, i, which, count);
  }
  return count;
}

inline std::size_t list_stiff(const Block& block, const LaneTissue& tissue, std::size_t laws, std::size_t n,
                              const ListLimits& limits, std::uint16_t* which) {
  return laws == 1 ? list_above(block, YoungRise{block}, n, limits, which)
                   : list_above(block, LameRise(block, tissue), n, limits, which);
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_LAW_STAGES_INL_H_
