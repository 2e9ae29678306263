// vertex_stages-inl.h — the state in double and back: narrow to float records, kick and drift, book the work.
//
// Included once per instruction set, never from outside kernels.cpp.
#if defined(GLISSON_VERTEX_STAGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_VERTEX_STAGES_INL_H_
#undef GLISSON_VERTEX_STAGES_INL_H_
#else
#define GLISSON_VERTEX_STAGES_INL_H_
#endif

#include <hwy/cache_control.h>

#include <algorithm>

#include "engine/kernels/kernels.h"
#include "engine/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

/// Up to four doubles: one of the two halves of a state record, or a part of it.
using Doubles = hn::CappedTag<double, 4>;
using D4 = hn::Vec<Doubles>;
using Narrow = hn::Rebind<float, Doubles>;
inline constexpr std::size_t kDoubles = HWY_TARGET == HWY_SCALAR ? 1 : (HWY_MAX_BYTES >= 32 ? 4 : 2);

/// A whole state record, or as much of it as a vector holds.
using Record = hn::CappedTag<double, kStateDoubles>;
using NarrowRecord = hn::Rebind<float, Record>;
inline constexpr std::size_t kRecordLanes = HWY_TARGET == HWY_SCALAR ? 1 : HWY_MAX_BYTES / sizeof(double);

/// Only differences against `origin` reach float, so that a body far from rest loses no digits.
HWY_INLINE void narrow_one(const double* state, const double* origin, float* out) {
  for (std::size_t k = 0; k < kStateDoubles; k += kRecordLanes) {
    const auto difference = hn::Sub(hn::Load(Record(), state + k), hn::Load(Record(), origin + k));
    hn::Store(hn::DemoteTo(NarrowRecord(), difference), NarrowRecord(), out + k);
  }
}

inline void narrow(const double* state, const double* origin, std::size_t n, float* out) {
  for (std::size_t i = 0; i < n; ++i) narrow_one(state + i * kStateDoubles, origin, out + i * kStateFloats);
}

inline void narrow_chosen(const double* state, const std::uint32_t* which, const double* origin, std::size_t n,
                          float* out) {
  constexpr std::size_t kAhead = 8;
  for (std::size_t i = 0; i < n; ++i) {
    hwy::Prefetch(state + which[std::min(i + kAhead, n - 1)] * kStateDoubles);
    narrow_one(state + which[i] * kStateDoubles, origin, out + i * kStateFloats);
  }
}

inline void narrow_vectors(const double* vectors, const std::uint32_t* which, const double* origin, std::size_t n,
                           float* out) {
  const Doubles d;
  for (std::size_t i = 0; i < n; ++i) {
    const double* v = vectors + (which != nullptr ? which[i] : i) * 4;
    for (std::size_t k = 0; k < 4; k += kDoubles) {
      hn::Store(hn::DemoteTo(Narrow(), hn::Sub(hn::Load(d, v + k), hn::Load(d, origin + k))), Narrow(),
                out + i * kStateFloats + k);
    }
  }
}

inline void add(float* a, const float* b, std::size_t n) {
  const Lanes d;
  for (std::size_t i = 0; i < n; i += kLanes) hn::Store(hn::Load(d, a + i) + hn::Load(d, b + i), d, a + i);
}

/// 0 · value is NaN for those that are not finite. Four sums, so that none waits for the other.
inline bool all_finite(const float* values, std::size_t n) {
  const Lanes d;
  const F zero = hn::Zero(d);
  F sum[4] = {zero, zero, zero, zero};
  for (std::size_t i = 0; i < n; i += 4 * kLanes) {
    for (std::size_t k = 0; k < 4 && i + k * kLanes < n; ++k) {
      sum[k] = hn::MulAdd(hn::Load(d, values + i + k * kLanes), zero, sum[k]);
    }
  }
  const F all = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  return hn::AllTrue(d, hn::Eq(all, all));
}

/// One force record, or as much of it as a vector holds.
using ForceLanes = hn::CappedTag<float, kForceFloats>;
inline constexpr std::size_t kForceLanes = HWY_TARGET == HWY_SCALAR ? 1 : kForceFloats;

inline void part_forces(const float* pairs, std::size_t n, float* elastic, float* viscous) {
  const ForceLanes d;
  for (std::size_t i = 0; i < kForceFloats * n; i += kForceFloats) {
    for (std::size_t k = 0; k < kForceFloats; k += kForceLanes) {
      hn::Store(hn::Load(d, pairs + 2 * i + k), d, elastic + i + k);
      hn::Store(hn::Load(d, pairs + 2 * i + kForceFloats + k), d, viscous + i + k);
    }
  }
}

inline void sum_slots(const float* slots, const std::uint32_t* begin, const std::uint32_t* which, std::size_t n,
                      float* out) {
  const ForceLanes d;
  for (std::size_t v = 0; v < n; ++v) {
    for (std::size_t k = 0; k < kForceFloats; k += kForceLanes) {
      auto sum = hn::Zero(d);
      for (std::uint32_t i = begin[v]; i < begin[v + 1]; ++i) {
        sum = hn::Add(sum, hn::Load(d, slots + which[i] * kForceFloats + k));
      }
      hn::Store(sum, d, out + v * kForceFloats + k);
    }
  }
}

/// All bits in x, y, z and none in w, for the part from position k. The w of a record are its coefficients: a
/// change that is masked and a drift by h where this is set leave them as they are.
HWY_INLINE D4 xyz_bits(std::size_t k) {
  const Doubles d;
  return hn::VecFromMask(d, hn::FirstN(d, k < 3 ? 3 - k : 0));
}

/// h w g of a vertex, from h g.
template <class V, class D>
HWY_INLINE V fall_of(D d, V fall, const double* weighs, std::size_t vertex) {
  return weighs == nullptr ? fall : hn::Mul(fall, hn::Set(d, weighs[vertex]));
}

inline void drag(const double* state, const DragStage& stage, std::size_t n, const float* force, double* delta) {
  const Doubles d;
  const Narrow narrow;
  const auto share = hn::Set(narrow, static_cast<float>(stage.tau));
  for (std::size_t i = 0; i < n; ++i, state += kStateDoubles) {
    for (std::size_t k = 0; k < 4; k += kDoubles) {
      const std::size_t at = kForceFloats * i + k;
      auto viscous = hn::Load(narrow, stage.viscous + at);
      if (!stage.first) {
        viscous = hn::Add(viscous, hn::Load(narrow, force + at));
        hn::Store(viscous, narrow, stage.viscous + at);
      }
      const auto part = hn::Mul(share, viscous);
      hn::Store(stage.first ? part : hn::Add(part, hn::Load(narrow, stage.sum + at)), narrow, stage.sum + at);
      if (delta == nullptr) continue;
      const D4 fall = fall_of(d, hn::Mul(hn::Set(d, stage.kick.step), hn::Load(d, stage.kick.gravity.data() + k)),
                              stage.kick.weighs, i);
      const D4 all = hn::PromoteTo(d, hn::Add(viscous, hn::Load(narrow, stage.elastic + at)));
      const D4 still = hn::NegMulAdd(hn::Set(d, state[7]), hn::Add(hn::Load(d, state + 4 + k), fall), fall);
      const D4 change = hn::MulAdd(hn::Set(d, state[3]), all, still);
      hn::Store(hn::And(xyz_bits(k), hn::Mul(hn::Set(d, stage.tau), change)), d, delta + 4 * i + k);
    }
  }
}

/// Sums of VertexWork, a component each.
struct WorkLanes {
  D4 elastic_before, elastic_after, viscous_before, viscous_after;
  D4 damping_before, damping_after, loads_before, loads_after, kinetic;

  HWY_INLINE WorkLanes() {
    const D4 zero = hn::Zero(Doubles());
    elastic_before = elastic_after = viscous_before = viscous_after = zero;
    damping_before = damping_after = loads_before = loads_after = kinetic = zero;
  }
  HWY_INLINE void book(D4 elastic, double half_mass, D4 before, D4 after) {
    elastic_before = hn::MulAdd(elastic, before, elastic_before),
    elastic_after = hn::MulAdd(elastic, after, elastic_after);
    kinetic = hn::MulAdd(hn::Mul(hn::Set(Doubles(), half_mass), before), after, kinetic);
  }
  HWY_INLINE void book_damping(D4 drag, D4 before, D4 after) {
    damping_before = hn::MulAdd(drag, before, damping_before), damping_after = hn::MulAdd(drag, after, damping_after);
  }
  HWY_INLINE void book_loads(D4 weight, D4 before, D4 after) {
    loads_before = hn::MulAdd(weight, before, loads_before), loads_after = hn::MulAdd(weight, after, loads_after);
  }
  HWY_INLINE void book_viscous(D4 viscous, D4 before, D4 after) {
    viscous_before = hn::MulAdd(viscous, before, viscous_before),
    viscous_after = hn::MulAdd(viscous, after, viscous_after);
  }
  HWY_INLINE void add_to(VertexWork& work) const {
    const auto sum = [](D4 v) GLISSON_INLINED { return hn::GetLane(hn::SumOfLanes(Doubles(), v)); };
    work.elastic_before += sum(elastic_before), work.elastic_after += sum(elastic_after);
    work.viscous_before += sum(viscous_before), work.viscous_after += sum(viscous_after);
    work.damping_before += sum(damping_before), work.damping_after += sum(damping_after);
    work.loads_before += sum(loads_before), work.loads_after += sum(loads_after);
    work.kinetic += sum(kinetic);
  }
};

/// What of a kick is booked.
enum class Booked { nothing, elastic, elastic_and_viscous };

/// v₊ = v₋ + c f − d v₋ + h (1 − d) w g, u₊ = u + h v₊, one vertex  [Schwartz2002, eq. 4].
template <Booked B>
HWY_INLINE void advance(double* state, const float* elastic, const float* viscous, const Kick& kick, std::size_t vertex,
                        bool falls, WorkLanes& work) {
  const Doubles d;
  const double c = state[3], damping = state[7];
  for (std::size_t k = 0; k < 4; k += kDoubles) {
    const D4 xyz = xyz_bits(k), h = hn::And(xyz, hn::Set(d, kick.step));
    const D4 before = hn::Load(d, state + 4 + k), u = hn::Load(d, state + k);
    const D4 g = fall_of(d, hn::Load(d, kick.gravity.data() + k), kick.weighs, vertex);
    const D4 fall = hn::Mul(hn::Set(d, kick.step), g);
    const D4 fe = hn::PromoteTo(d, hn::Load(Narrow(), elastic + k));
    D4 force = fe;
    if constexpr (B == Booked::elastic_and_viscous) {
      force = hn::Add(fe, hn::PromoteTo(d, hn::Load(Narrow(), viscous + k)));
    }
    const D4 change = hn::MulAdd(hn::Set(d, c), force, hn::NegMulAdd(hn::Set(d, damping), hn::Add(before, fall), fall));
    const D4 after = hn::Add(before, hn::And(xyz, change));
    hn::Store(after, d, state + 4 + k);
    hn::Store(hn::MulAdd(h, after, u), d, state + k);
    if constexpr (B != Booked::nothing) {
      const D4 v0 = hn::And(xyz, before), v1 = hn::And(xyz, after);
      const double mass = kick.masses[vertex];
      work.book(fe, 0.5 * mass, v0, v1);
      if (damping != 0.0) work.book_damping(hn::Mul(hn::Set(d, -kick.damping[vertex]), v1), v0, v1);
      if (falls) work.book_loads(hn::Mul(hn::Set(d, mass), g), v0, v1);
      if constexpr (B == Booked::elastic_and_viscous) work.book_viscous(hn::Sub(force, fe), v0, v1);
    }
  }
}

#if HWY_TARGET != HWY_SCALAR && HWY_MAX_BYTES == 64

/// The same [Schwartz2002, eq. 4], a whole record at a time: both halves take the velocity's change, the lower one adds h times it to u.
///   [u c | v d]  →  v₊ in both halves  →  [h h h 0 | 1 1 1 1] [v₊ d | v₊ d] + [u c | 0]
inline void integrate(double* state, const float* force, std::size_t n, const Kick& kick) {
  const Record d;
  const auto lower = hn::VecFromMask(d, hn::FirstN(d, 4));
  const auto xyz = hn::Combine(d, xyz_bits(0), xyz_bits(0));
  const auto fall = hn::Mul(hn::Set(d, kick.step), hn::Combine(d, hn::Load(Doubles(), kick.gravity.data()),
                                                               hn::Load(Doubles(), kick.gravity.data())));
  const auto drift = hn::IfThenElse(hn::FirstN(d, 4), hn::And(xyz, hn::Set(d, kick.step)), hn::Set(d, 1.0));
  for (std::size_t i = 0; i < n; ++i, state += kStateDoubles, force += kForceFloats) {
    const auto record = hn::Load(d, state), before = hn::ConcatUpperUpper(d, record, record);
    const auto f = hn::PromoteTo(d, hn::LoadDup128(NarrowRecord(), force));
    const auto falls = fall_of(d, fall, kick.weighs, i);
    const auto drag = hn::NegMulAdd(hn::Set(d, state[7]), hn::Add(before, falls), falls);
    const auto change = hn::MulAdd(hn::Set(d, state[3]), f, drag);
    const auto after = hn::Add(before, hn::And(xyz, change));
    hn::Store(hn::MulAdd(drift, after, hn::And(lower, record)), d, state);
  }
}

#else

inline void integrate(double* state, const float* force, std::size_t n, const Kick& kick) {
  WorkLanes none;
  for (std::size_t i = 0; i < n; ++i) {
    advance<Booked::nothing>(state + i * kStateDoubles, force + i * kForceFloats, nullptr, kick, i, false, none);
  }
}

#endif

template <Booked B>
HWY_INLINE void integrate_booked(double* state, const float* elastic, const float* viscous, std::size_t n,
                                 const Kick& kick, VertexWork& work) {
  WorkLanes sums;
  const bool falls = kick.gravity != std::array<double, 4>{};
  for (std::size_t i = 0; i < n; ++i) {
    const float* beside = B == Booked::elastic_and_viscous ? viscous + i * kForceFloats : nullptr;
    advance<B>(state + i * kStateDoubles, elastic + i * kForceFloats, beside, kick, i, falls, sums);
  }
  sums.add_to(work);
}

inline void integrate_accounted(double* state, const float* elastic, const float* viscous, std::size_t n,
                                const Kick& kick, VertexWork& work) {
  if (viscous == nullptr) return integrate_booked<Booked::elastic>(state, elastic, nullptr, n, kick, work);
  integrate_booked<Booked::elastic_and_viscous>(state, elastic, viscous, n, kick, work);
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_VERTEX_STAGES_INL_H_
