// lanes-inl.h — vertex records into lanes and back, without gather or scatter instructions.
//
// A vertex is one record, [x y z w] or [x y z w | x y z w]; an element kernel wants all x in one vector, all
// y in another. A whole record is loaded at once and records are transposed in registers:
//
//   records of lanes 0…3      interleave twice            vectors of 4 lanes
//   x0 y0 z0 w0               x0 x1 y0 y1 | …             x0 x1 x2 x3
//   x1 y1 z1 w1        ──▶    x2 x3 y2 y3 | …      ──▶    y0 y1 y2 y3
//   …                                                     z0 z1 z2 z3
//
// Wider vectors do this in each of their 128-bit blocks at the same time; which record goes into which block
// is chosen so that lane l of a batch is tet l of the batch on every instruction set.
//
// Included once per instruction set (Highway's foreach_target), never from outside kernels.cpp.
#if defined(GLISSON_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_LANES_INL_H_
#undef GLISSON_LANES_INL_H_
#else
#define GLISSON_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "engine/kernels/inlined.h"
#include "engine/layout/layout.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using F = hn::Vec<Floats>;
/// The same tag in this namespace, so that element_math-inl.h finds the few functions below by its argument.
struct Lanes : Floats {};
inline constexpr std::size_t kLanes = HWY_TARGET == HWY_SCALAR ? 1 : HWY_MAX_BYTES / sizeof(float);

/// J^(−⅓) to some percent: the float's bits, read as a number, are near its logarithm.
HWY_INLINE F guess_inverse_cube_root(Lanes, F J) {
  const Floats d;
  const hn::RebindToSigned<Floats> bits;
  const F logarithm = hn::ConvertTo(d, hn::BitCast(bits, J));
  const F guess = hn::NegMulAdd(logarithm, hn::Set(d, 1.0F / 3.0F), hn::Set(d, 1419967116.0F));
  return hn::BitCast(d, hn::ConvertTo(bits, guess));
}

/// x, y, z of a vertex quantity, one lane a tet.
struct Xyz {
  F x, y, z;
};

/// Displacement and velocity of a vertex relative to another.
struct UV {
  Xyz u, v;
  UV() = default;
  HWY_INLINE explicit UV(const Xyz& displacement) : u(displacement) {}
  HWY_INLINE UV(const Xyz& displacement, const Xyz& velocity) : u(displacement), v(velocity) {}
};

HWY_INLINE const float* state_record(const float* records, std::size_t index) { return records + kStateFloats * index; }
HWY_INLINE float* force_record(float* records, std::size_t index) { return records + kForceFloats * index; }
/// Records of two forces side by side.
HWY_INLINE float* pair_record(float* records, std::size_t index) { return records + 2 * kForceFloats * index; }

HWY_INLINE Xyz negative(const Xyz& v) { return {hn::Neg(v.x), hn::Neg(v.y), hn::Neg(v.z)}; }

/// Elastic and viscous force on a vertex, kept apart.
struct ForcePair {
  Xyz elastic, viscous;
};

#if HWY_TARGET != HWY_SCALAR

/// Even and odd lanes as pairs: interleaves 64-bit units within each block.
HWY_INLINE F pairs_lower(F a, F b) {
  const hn::RepartitionToWide<hn::RebindToUnsigned<Floats>> wide;
  return hn::BitCast(Floats(), hn::InterleaveLower(wide, hn::BitCast(wide, a), hn::BitCast(wide, b)));
}
HWY_INLINE F pairs_upper(F a, F b) {
  const hn::RepartitionToWide<hn::RebindToUnsigned<Floats>> wide;
  return hn::BitCast(Floats(), hn::InterleaveUpper(wide, hn::BitCast(wide, a), hn::BitCast(wide, b)));
}

/// Transposes 4 records in every block: x, y, z of each (w is dropped).
HWY_INLINE Xyz transpose(F r0, F r1, F r2, F r3) {
  const Floats d;
  const F xy01 = hn::InterleaveLower(d, r0, r1), xy23 = hn::InterleaveLower(d, r2, r3);
  const F zw01 = hn::InterleaveUpper(d, r0, r1), zw23 = hn::InterleaveUpper(d, r2, r3);
  return {pairs_lower(xy01, xy23), pairs_upper(xy01, xy23), pairs_lower(zw01, zw23)};
}

/// The way back: four vectors of records [x y z 0].
struct Records {
  F r0, r1, r2, r3;
};
HWY_INLINE Records transpose_back(const Xyz& v) {
  const Floats d;
  const F zero = hn::Zero(d);
  const F xy_lower = hn::InterleaveLower(d, v.x, v.y), xy_upper = hn::InterleaveUpper(d, v.x, v.y);
  const F z_lower = hn::InterleaveLower(d, v.z, zero), z_upper = hn::InterleaveUpper(d, v.z, zero);
  return {pairs_lower(xy_lower, z_lower), pairs_upper(xy_lower, z_lower), pairs_lower(xy_upper, z_upper),
          pairs_upper(xy_upper, z_upper)};
}

HWY_INLINE void add_block(float* force, hn::Vec<hn::Full128<float>> f) {
  const hn::Full128<float> block;
  hn::Store(hn::Add(hn::Load(block, force), f), block, force);
}

#endif

/// The local vertices of a batch, one a lane, four to a word: a load for four indices leaves the load units to
/// the records.
class Indices {
 public:
  HWY_INLINE explicit Indices(const std::uint16_t* index) {
    constexpr std::size_t kBytes = std::min<std::size_t>(kLanes, 4) * sizeof(std::uint16_t);
    for (std::size_t k = 0; k < kWords; ++k) std::memcpy(&words_[k], index + 4 * k, kBytes);
  }
  HWY_INLINE std::size_t operator[](std::size_t lane) const { return words_[lane / 4] >> (16 * (lane % 4)) & 0xFFFFU; }

 private:
  static constexpr std::size_t kWords = (kLanes + 3) / 4;
  std::uint64_t words_[kWords] = {};
};

// Functions below take indices as they lie in memory, or as Indices: elements, which are held up by loads, gain a
// tenth from the latter; edges, which are not, lose as much.

// For each vector size: Origin, the records that differences are taken against, loaded once for all of them;
// of displacements only where kWithVelocity is false; and add_forces.
#if HWY_TARGET == HWY_SCALAR

template <bool kWithVelocity>
class Origin {
 public:
  template <class Index>
  HWY_INLINE Origin(const float* records, const Index& index)
      : records_(records), origin_(state_record(records, index[0])) {}
  template <class Index>
  HWY_INLINE UV difference(const Index& index) const {
    const float* a = state_record(records_, index[0]);
    const auto d = [&](std::size_t k) GLISSON_INLINED { return hn::Set(Floats(), a[k] - origin_[k]); };
    return {{d(0), d(1), d(2)}, {d(4), d(5), d(6)}};
  }

 private:
  const float *records_, *origin_;
};

template <class Index>
HWY_INLINE void add_forces(float* forces, const Index& index, const Xyz& f) {
  float* record = force_record(forces, index[0]);
  record[0] += hn::GetLane(f.x), record[1] += hn::GetLane(f.y), record[2] += hn::GetLane(f.z);
}
template <class Index>
HWY_INLINE void add_forces(float* pairs, const Index& index, const ForcePair& f) {
  add_forces(pairs, std::array<std::size_t, 1>{2 * index[0]}, f.elastic);
  add_forces(pairs, std::array<std::size_t, 1>{2 * index[0] + 1}, f.viscous);
}

#elif HWY_MAX_BYTES == 16

template <bool kWithVelocity>
class Origin {
 public:
  template <class Index>
  HWY_INLINE Origin(const float* records, const Index& index) : records_(records) {
    for (std::size_t l = 0; l < 4; ++l) {
      u_[l] = half(index, l, 0);
      if constexpr (kWithVelocity) v_[l] = half(index, l, 4);
    }
  }
  template <class Index>
  HWY_INLINE UV difference(const Index& index) const {
    const auto of = [&](const F* origin, std::size_t from) GLISSON_INLINED {
      const auto r = [&](std::size_t l) GLISSON_INLINED { return hn::Sub(half(index, l, from), origin[l]); };
      return transpose(r(0), r(1), r(2), r(3));
    };
    if constexpr (kWithVelocity) return {of(u_, 0), of(v_, 4)};
    return UV{of(u_, 0)};
  }

 private:
  template <class Index>
  HWY_INLINE F half(const Index& index, std::size_t lane, std::size_t from) const {
    return hn::Load(Floats(), state_record(records_, index[lane]) + from);
  }
  const float* records_;
  F u_[4], v_[4];
};

template <class Index>
HWY_INLINE void add_forces(float* forces, const Index& index, const Xyz& f) {
  const Records r = transpose_back(f);
  add_block(force_record(forces, index[0]), r.r0);
  add_block(force_record(forces, index[1]), r.r1);
  add_block(force_record(forces, index[2]), r.r2);
  add_block(force_record(forces, index[3]), r.r3);
}
template <class Index>
HWY_INLINE void add_forces(float* pairs, const Index& index, const ForcePair& f) {
  const Records e = transpose_back(f.elastic), v = transpose_back(f.viscous);
  const auto add = [&](std::size_t lane, F elastic, F viscous) GLISSON_INLINED {
    float* pair = pair_record(pairs, index[lane]);
    add_block(pair, elastic), add_block(pair + kForceFloats, viscous);
  };
  add(0, e.r0, v.r0), add(1, e.r1, v.r1), add(2, e.r2, v.r2), add(3, e.r3, v.r3);
}

#elif HWY_MAX_BYTES == 32

template <bool kWithVelocity>
class Origin {
 public:
  template <class Index>
  HWY_INLINE Origin(const float* records, const Index& index) : records_(records) {
    for (std::size_t k = 0; k < kCount; ++k) r_[k] = load(index, k);
  }
  template <class Index>
  HWY_INLINE UV difference(const Index& index) const {
    const Floats d;
    const auto r = [&](std::size_t k) GLISSON_INLINED { return hn::Sub(load(index, k), r_[k]); };
    const Xyz a = transpose(r(0), r(1), r(2), r(3));
    if constexpr (!kWithVelocity) return UV{a};
    const Xyz b = transpose(r(4), r(5), r(6), r(7));  // blocks: u, v
    return {{hn::ConcatLowerLower(d, b.x, a.x), hn::ConcatLowerLower(d, b.y, a.y), hn::ConcatLowerLower(d, b.z, a.z)},
            {hn::ConcatUpperUpper(d, b.x, a.x), hn::ConcatUpperUpper(d, b.y, a.y), hn::ConcatUpperUpper(d, b.z, a.z)}};
  }

 private:
  static constexpr std::size_t kCount = kWithVelocity ? 8 : 4;
  /// u and v of lane k, or u of lanes k and k + 4.
  template <class Index>
  HWY_INLINE F load(const Index& index, std::size_t k) const {
    if constexpr (kWithVelocity) return hn::Load(Floats(), state_record(records_, index[k]));
    const hn::Full128<float> block;
    return hn::Combine(Floats(), hn::Load(block, state_record(records_, index[k + 4])),
                       hn::Load(block, state_record(records_, index[k])));
  }
  const float* records_;
  F r_[kCount];
};

template <class Index>
HWY_INLINE void add_forces(float* forces, const Index& index, const Xyz& f) {
  const Records r = transpose_back(f);
  const auto add = [&](std::size_t lane, F records) GLISSON_INLINED {
    add_block(force_record(forces, index[lane]), hn::LowerHalf(records));
    add_block(force_record(forces, index[lane + 4]), hn::UpperHalf(hn::Full128<float>(), records));
  };
  add(0, r.r0), add(1, r.r1), add(2, r.r2), add(3, r.r3);
}
template <class Index>
HWY_INLINE void add_forces(float* pairs, const Index& index, const ForcePair& f) {
  const Floats d;
  const Records e = transpose_back(f.elastic), v = transpose_back(f.viscous);
  const auto add = [&](std::size_t lane, F elastic, F viscous) GLISSON_INLINED {
    float *first = pair_record(pairs, index[lane]), *second = pair_record(pairs, index[lane + 4]);
    hn::Store(hn::Add(hn::Load(d, first), hn::ConcatLowerLower(d, viscous, elastic)), d, first);
    hn::Store(hn::Add(hn::Load(d, second), hn::ConcatUpperUpper(d, viscous, elastic)), d, second);
  };
  add(0, e.r0, v.r0), add(1, e.r1, v.r1), add(2, e.r2, v.r2), add(3, e.r3, v.r3);
}

#elif HWY_MAX_BYTES == 64

using Half = hn::Half<Floats>;

/// Blocks 0 and 2 of two vectors, then 1 and 3.
HWY_INLINE F even_blocks(F a, F b) { return F{_mm512_shuffle_f32x4(a.raw, b.raw, 0x88)}; }
HWY_INLINE F odd_blocks(F a, F b) { return F{_mm512_shuffle_f32x4(a.raw, b.raw, 0xDD)}; }

template <bool kWithVelocity>
class Origin {
 public:
  template <class Index>
  HWY_INLINE Origin(const float* records, const Index& index) : records_(records) {
    for (std::size_t k = 0; k < kCount; ++k) r_[k] = load(index, k);
  }
  template <class Index>
  HWY_INLINE UV difference(const Index& index) const {
    const auto r = [&](std::size_t k) GLISSON_INLINED { return hn::Sub(load(index, k), r_[k]); };
    const Xyz a = transpose(r(0), r(1), r(2), r(3));
    if constexpr (!kWithVelocity) return UV{a};
    const Xyz b = transpose(r(4), r(5), r(6), r(7));  // blocks: u, v, u, v
    return {{even_blocks(a.x, b.x), even_blocks(a.y, b.y), even_blocks(a.z, b.z)},
            {odd_blocks(a.x, b.x), odd_blocks(a.y, b.y), odd_blocks(a.z, b.z)}};
  }

 private:
  static constexpr std::size_t kCount = kWithVelocity ? 8 : 4;
  /// u and v of two lanes, four apart: k and k + 4 for k below 4, else k + 4 and k + 8; or u of four lanes.
  template <class Index>
  HWY_INLINE F load(const Index& index, std::size_t k) const {
    if constexpr (kWithVelocity) {
      const std::size_t lane = k < 4 ? k : k + 4;
      const auto state = [&](std::size_t l)
                             GLISSON_INLINED { return hn::Load(Half(), state_record(records_, index[l])); };
      return hn::Combine(Floats(), state(lane + 4), state(lane));
    } else {
      const auto u = [&](std::size_t l)
                         GLISSON_INLINED { return hn::Load(hn::Full128<float>(), state_record(records_, index[l])); };
      return hn::Combine(Floats(), hn::Combine(Half(), u(k + 12), u(k + 8)), hn::Combine(Half(), u(k + 4), u(k)));
    }
  }
  const float* records_;
  F r_[kCount];
};

template <class Index>
HWY_INLINE void add_forces(float* forces, const Index& index, const Xyz& f) {
  const Records r = transpose_back(f);
  const hn::Full128<float> block;
  const auto add = [&](std::size_t lane, F records) GLISSON_INLINED {
    const hn::Vec<Half> lower = hn::LowerHalf(records), upper = hn::UpperHalf(Half(), records);
    add_block(force_record(forces, index[lane]), hn::LowerHalf(lower));
    add_block(force_record(forces, index[lane + 4]), hn::UpperHalf(block, lower));
    add_block(force_record(forces, index[lane + 8]), hn::LowerHalf(upper));
    add_block(force_record(forces, index[lane + 12]), hn::UpperHalf(block, upper));
  };
  add(0, r.r0), add(1, r.r1), add(2, r.r2), add(3, r.r3);
}
template <class Index>
HWY_INLINE void add_forces(float* pairs, const Index& index, const ForcePair& f) {
  const Half d;
  const Records e = transpose_back(f.elastic), v = transpose_back(f.viscous);
  const auto two = [&](std::size_t lane, hn::Vec<Half> elastic, hn::Vec<Half> viscous) GLISSON_INLINED {
    float *first = pair_record(pairs, index[lane]), *second = pair_record(pairs, index[lane + 4]);
    hn::Store(hn::Add(hn::Load(d, first), hn::ConcatLowerLower(d, viscous, elastic)), d, first);
    hn::Store(hn::Add(hn::Load(d, second), hn::ConcatUpperUpper(d, viscous, elastic)), d, second);
  };
  const auto add = [&](std::size_t lane, F elastic, F viscous) GLISSON_INLINED {
    two(lane, hn::LowerHalf(elastic), hn::LowerHalf(viscous));
    two(lane + 8, hn::UpperHalf(d, elastic), hn::UpperHalf(d, viscous));
  };
  add(0, e.r0, v.r0), add(1, e.r1, v.r1), add(2, e.r2, v.r2), add(3, e.r3, v.r3);
}

#else
#error "lanes-inl.h: no transpose for this vector size yet; see Origin"
#endif

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_LANES_INL_H_
