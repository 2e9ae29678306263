// stiff_list-inl.h — which tets of a block are above their limits, a vector at a time.
//
// Included once per instruction set (Highway's foreach_target), never from outside kernels.cpp and response_kernels.cpp.
#if defined(GLISSON_STIFF_LIST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_STIFF_LIST_INL_H_
#undef GLISSON_STIFF_LIST_INL_H_
#else
#define GLISSON_STIFF_LIST_INL_H_
#endif

#include <array>
#include <bit>
#include <cstdint>

#include "engine/kernels/lanes-inl.h"
#include "engine/kernels/response_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

/// Where the limits of a vector of tets lie, in floats from the first.
HWY_INLINE auto place_of_limits(const ListLimits& limits, std::size_t i) {
  static_assert(sizeof(StiffLimit) == 2 * sizeof(float));
  const hn::RebindToSigned<Floats> whole;
  const auto element = hn::BitCast(whole, hn::LoadU(hn::RebindToUnsigned<Floats>(), limits.element + i));
  const auto there = hn::Max(element, hn::Zero(whole));  // none is −1
  return hn::Add(there, there);
}

/// Appends the numbers of a mask's lanes, from i on. @return how many there are by now
template <class Mask>
HWY_INLINE std::size_t put_places(Mask mask, std::size_t i, std::uint16_t* which, std::size_t count) {
  std::array<std::uint8_t, sizeof(std::uint64_t)> bytes{};
  hn::StoreMaskBits(Floats(), mask, bytes.data());
  for (auto bits = std::bit_cast<std::uint64_t>(bytes); bits != 0; bits &= bits - 1) {
    which[count++] = static_cast<std::uint16_t>(i + static_cast<std::size_t>(std::countr_zero(bits)));
  }
  return count;
}

inline std::size_t list_above(std::size_t items, const ResponseBlock& out, const ListLimits& limits,
                              std::uint16_t* which) {
  const Floats d;
  std::size_t count = 0;
  for (std::size_t i = 0; i < items * kLanes; i += kLanes) {
    const F ratio = hn::Load(d, out.ratio + i);
    auto above = hn::Gt(ratio, hn::Set(d, limits.block));
    if (hn::AllFalse(d, above)) continue;
    if (limits.single != nullptr) {
      const auto place = place_of_limits(limits, i);
      const auto over = [&](const float* value, const float* limit) GLISSON_INLINED {
        return hn::Gt(hn::Load(d, value + i), hn::GatherIndex(d, limit, place));
      };
      above = hn::And(above, hn::Or(over(out.ratio, &limits.single->ratio), over(out.norm, &limits.single->norm)));
    }
    count = put_places(above, i, which, count);
  }
  return count;
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_STIFF_LIST_INL_H_
