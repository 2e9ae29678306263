// stretch_lanes-inl.h — the stretch U of tets in lanes, without eigenvectors, and the tets of which it takes longer.
//
// Where stretches are close to each other U⁻¹ and tr U are series of the strain (src/material/root_series.h). Else the invariants
// x = tr U and y = ½ (x² − tr C) solve
//   x² − 2 y = I₁,   y² − 2 J x = I₂
// by Newton from x₀ = √(3 I₁), y₀ = √(3 I₂), which lie above them; four steps reach the last digit of a float for
// stretches from 0.2 to 3.3. Then U = [ x J I + (x² − y) C − C² ] / (x y − J) [HogerCarlson1984], and B = U − I = 2 E (U + I)⁻¹
// keeps the digits of small strain.
//
// Included once per instruction set, never from outside response_kernels.cpp.
#if defined(GLISSON_STRETCH_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_STRETCH_LANES_INL_H_
#undef GLISSON_STRETCH_LANES_INL_H_
#else
#define GLISSON_STRETCH_LANES_INL_H_
#endif

#include "engine/kernels/lane_scalar-inl.h"
#include "engine/kernels/response_kernels.h"
#include "engine/kernels/tensor_lanes-inl.h"
#include "material/root_series.h"
#include "material/volume_powers.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

// Structures are flat: the compiler moves nested ones through memory in pieces.

/// X of C = m (I + X) (material/invariant_series.h). @param mean  ⅓ tr E  @param per_mean  1/m
HWY_INLINE Symmetric stretch_deviator(const Symmetric& E, F mean, F per_mean) {
  return times(per_mean + per_mean, plus_identity(E, hn::Neg(mean)));
}
HWY_INLINE F second_invariant(const Symmetric& X) { return number(0.5F) * contraction(X, X); }

/// Of m = ⅓ tr C.
struct MeanStretch {
  F third;         ///< ⅓ tr E
  F square, root;  ///< m, √m
  F per_root;      ///< 1/√m
  F above, below;  ///< √m − 1 and 1 − 1/√m, with the digits of small strain
};
HWY_INLINE MeanStretch mean_stretch(const Symmetric& E) {
  const F one = number(1.0F), third = trace_of(E) * number(1.0F / 3.0F), more = third + third;  // m − 1
  const F square = more + one, root = hn::Sqrt(square), below = more / (square + root);
  return {third, square, root, one - below, below * root, below};
}
/// What a strain's first two invariants are: tr ε, ‖ε‖².
struct StrainNorms {
  F trace, squares;
};
/// Of B = U − I. @param of_shape  tr U/√m − 3
HWY_INLINE StrainNorms norms_by_series(const MeanStretch& m, F of_shape) {
  const F trace = hn::MulAdd(m.root, of_shape, number(3.0F) * m.above);
  // ‖B‖² = ‖dev B‖² + ⅓ (tr B)², and ‖dev U‖² = tr C − ⅓ (tr U)²
  const F deviator = m.square * of_shape * hn::MulAdd(of_shape, number(1.0F / 3.0F), number(2.0F));
  return {trace, hn::MulSub(trace * trace, number(1.0F / 3.0F), deviator)};
}
/// a U⁻¹ + b (I − U⁻¹).
HWY_INLINE Symmetric stress_by_series(const RootSeries<float>& series, const MeanStretch& m, const Symmetric& X,
                                      const Symmetric& cof, LaneScalar J2, LaneScalar J3, F a, F b) {
  const F change = hn::NegMulAdd(m.per_root, series_at(series.whole, J2, J3).v, m.below);  // of I in I − U⁻¹
  const F bend = (a - b) * m.per_root;
  const Symmetric bent = times(bend * series_at(series.first, J2, J3).v, X);
  return plus_identity(plus(bent, bend * series_at(series.second, J2, J3).v, cof), hn::MulAdd(b - a, change, a));
}

/// B and U⁻¹ of any tet with J > kSmallestVolume.
struct StretchTensors {
  Symmetric strain, inverse;
};
HWY_INLINE StretchTensors stretch_tensors(const Symmetric& E, const Tensor& H, F volume_change,
                                          double smallest = kSmallestVolume) {
  const F J = hn::Max(volume_change + number(1.0F), number(float(smallest)));
  const F I1 = hn::MulAdd(number(2.0F), trace_of(E), number(3.0F));
  const F I2 = squares_of(plus_identity(cofactor_change(H), number(1.0F)));
  F x = hn::Sqrt(number(3.0F) * I1), y = hn::Sqrt(number(3.0F) * I2);
  for (int k = 0; k < 4; ++k) {
    const F f = hn::MulSub(x, x, hn::MulAdd(number(2.0F), y, I1)), g = hn::MulSub(y, y, hn::MulAdd(J + J, x, I2));
    const F scale = number(0.5F) / hn::MulSub(x, y, J);
    const F dx = hn::MulAdd(y, f, g) * scale, dy = hn::MulAdd(J, f, x * g) * scale;
    x = x - dx, y = y - dy;
  }
  const Symmetric C = plus_identity(times(number(2.0F), E), number(1.0F)), C2 = commuting_product(C, C);
  const F scale = number(1.0F) / hn::MulSub(x, y, J);
  const Symmetric bend = plus(times(hn::MulSub(x, x, y), C), number(-1.0F), C2);
  const Symmetric U = times(scale, plus_identity(bend, x * J));
  const SymmetricCofactors of_u = cofactors_of(U), of_sum = cofactors_of(plus_identity(U, number(1.0F)));
  const F twice = number(2.0F) / of_sum.determinant;
  return {commuting_product(times(twice, E), of_sum.cof), times(number(1.0F) / of_u.determinant, of_u.cof)};
}
/// Tets of a block whose stretches are apart, answered as many at a time as there are lanes.
class FarTets {
 public:
  HWY_INLINE void list(std::size_t item, F J2, float largest) {
    alignas(64) float of[kMaxLanes];
    hn::Store(J2, Lanes(), of);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (!(of[lane] < largest)) which_[count_++] = static_cast<std::uint16_t>(item * kLanes + lane);
    }
  }
  /// @param answer  (items, block, out): answers the first item; kLaw: reads the measure and the moduli of its block
  template <bool kLaw, class Answer>
  HWY_INLINE void respond(const ResponseItems& in, const Block& block, ResponseBlock& out, const Answer& answer) const {
    for (std::size_t from = 0; from < count_; from += kLanes) {
      respond_some<kLaw>(in, block, which_ + from, std::min(kLanes, count_ - from), out, answer);
    }
  }

 private:
  /// Where the numbers of a tet begin that lie kLanes apart, `each` of them an item.
  HWY_INLINE static std::size_t place(std::size_t tet, std::size_t each) {
    return tet / kLanes * each * kLanes + tet % kLanes;
  }
  template <bool kLaw, class Answer>
  HWY_NOINLINE static void respond_some(const ResponseItems& in, const Block& block, const std::uint16_t* which,
                                        std::size_t n, ResponseBlock& out, const Answer& answer) {
    alignas(64) float gradient[9 * kMaxLanes], mean[kMaxLanes];
    std::uint32_t element[kMaxLanes];
    Block some;                                 // the first item of it
    for (std::size_t l = 0; l < kLanes; ++l) {  // lanes that are left repeat the first tet
      const std::size_t tet = which[l < n ? l : 0];
      for (std::size_t k = 0; k < 9; ++k) gradient[k * kLanes + l] = in.gradient[place(tet, 9) + k * kLanes];
      if (in.mean != nullptr) mean[l] = in.mean[tet];
      element[l] = l < n && in.element != nullptr ? in.element[tet] : 0xFFFFFFFFU;
      if constexpr (!kLaw) continue;
      some.x[l] = block.x[tet], some.y[l] = block.y[tet];
      for (std::size_t k = 0; k < 2; ++k) {
        some.value[k][l] = block.value[k][tet], some.slope[k][l] = block.slope[k][tet];
      }
    }
    ResponseItems packed;
    packed.gradient = gradient, packed.element = element, packed.items = 1;
    if (in.mean != nullptr) packed.mean = mean;
    ResponseBlock of;  // the first item of it
    answer(packed, some, of);
    for (std::size_t l = 0; l < n; ++l) {
      const std::size_t tet = which[l];
      for (std::size_t k = 0; k < 9; ++k) out.piola[place(tet, 9) + k * kLanes] = of.piola[k * kLanes + l];
      out.ratio[tet] = of.ratio[l], out.norm[tet] = of.norm[l];
    }
  }

  std::uint16_t which_[kBlockTets];
  std::size_t count_ = 0;
};

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_STRETCH_LANES_INL_H_
