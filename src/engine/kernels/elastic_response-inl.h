// elastic_response-inl.h — tensor-mass tissues of large deformation in lanes: P of their kinematics and laws.
//
// The corotational strain B = U − I without eigenvectors: the invariants x = tr U and y = ½ (x² − tr C) solve
//   x² − 2 y = I₁,   y² − 2 J x = I₂
// by Newton from x₀ = √(3 I₁), y₀ = √(3 I₂), which lie above them; four steps reach the last digit of a float for
// stretches from 0.2 to 3.3. Then U = [ x J I + (x² − y) C − C² ] / (x y − J) [HogerCarlson1984], and B = 2 E (U + I)⁻¹ keeps
// the digits of small strain.
//
// Included once per instruction set, never from outside response_kernels.cpp.
#if defined(GLISSON_ELASTIC_RESPONSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_ELASTIC_RESPONSE_INL_H_
#undef GLISSON_ELASTIC_RESPONSE_INL_H_
#else
#define GLISSON_ELASTIC_RESPONSE_INL_H_
#endif

#include "engine/kernels/response_kernels.h"
#include "engine/kernels/tensor_lanes-inl.h"
#include "material/stiffness_bound.h"
#include "material/volume_powers.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

/// λ and μ of the laws, their slopes, and what those mean for the tangent.
struct LaneModuli {
  F lambda, mu, lambda_slope, mu_slope;
  F ratio, slope;  ///< over those at rest, the larger of shear and bulk
};

/// Without kLaw those at rest.
template <bool kLaw>
HWY_INLINE LaneModuli moduli_of(const LaneResponse& r, const Block& block, std::size_t item) {
  const Lanes d;
  const auto at = [&](const float* values, float rest) GLISSON_INLINED {
    if constexpr (kLaw) return hn::Load(d, values + item * kLanes);
    return number(rest);
  };
  const F l = number(r.moduli.lambda), m = number(r.moduli.mu), third = number(2.0F / 3.0F);
  LaneModuli k;
  k.lambda = l * at(block.value[0], 1.0F), k.mu = m * at(block.value[r.mu_law], 1.0F);
  k.lambda_slope = l * at(block.slope[0], 0.0F), k.mu_slope = m * at(block.slope[r.mu_law], 0.0F);
  const F per_mu = number(1.0F / r.moduli.rest_mu);
  const F per_bulk = number(1.0F / (2.0F * r.moduli.bulk_over_two_mu * r.moduli.rest_mu));
  const F dl = hn::Abs(k.lambda_slope), dm = hn::Abs(k.mu_slope);
  k.ratio = hn::Max(k.mu * per_mu, hn::MulAdd(third, k.mu, k.lambda) * per_bulk);
  k.slope = hn::Max(dm * per_mu, hn::MulAdd(third, dm, dl) * per_bulk);
  return k;
}

/// How stiff a tet of a law is over rest: its modulus, and its slope over the strain. @param squares  ‖ε‖²
HWY_INLINE F law_bound(const LaneResponse& r, const LaneModuli& k, F trace, F squares, F x) {
  F slope = k.slope;
  if (r.measure == DeformationMeasure::one_minus_q) {
    slope = slope * number(4.0F / 3.0F) * hn::Sqrt(x * number(1.5F));
  } else if (r.measure != DeformationMeasure::equivalent_shear_strain) {
    slope = slope * x * number(1.64F);
  }
  if (r.energy) slope = slope * number(6.0F);
  const F square = trace * trace;
  const F deviator = hn::Max(hn::MulAdd(square, number(-1.0F / 3.0F), squares), hn::Zero(Lanes()));
  return hn::MulAdd(slope, hn::Sqrt(hn::MulAdd(square, number(r.moduli.bulk_over_two_mu), deviator)), k.ratio);
}

/// F − (I₁/3J) cof F = H − r K + (1 − r) I, 1 − r = (3 j − 2 tr H − ‖H‖²)/(3J).
HWY_INLINE Tensor deviatoric_direction(const Tensor& H, const Tensor& K, F volume_change, F squares) {
  const F J = volume_change + number(1.0F);
  const F left =
      hn::NegMulAdd(number(2.0F), trace(H), hn::MulSub(number(3.0F), volume_change, squares)) / (number(3.0F) * J);
  return plus_identity(plus(H, left - number(1.0F), K), left);
}

/// ∂x/∂F of s or 1 − q, times a factor; 0 where s is.
HWY_INLINE Tensor measure_gradient(const LaneResponse& r, const Tensor& H, const Invariants<F>& inv, F x, F factor) {
  const F squares = squares_of(H), I1 = hn::MulAdd(number(2.0F), inv.trace, squares) + number(3.0F);
  const Tensor D = deviatoric_direction(H, cofactor_change(H), inv.volume_change, squares);
  const bool intensity = r.measure == DeformationMeasure::equivalent_shear_strain;
  const F p = intensity ? x * x * number(2.0F / 3.0F) : x;  // 1 − q
  F scale = number(2.0F) * (number(1.0F) - p) / I1;         // −∂q = 2 q/I₁ D
  if (intensity) scale = scale * number(0.75F) / hn::Max(x, number(1e-12F));
  return times(hn::IfThenElse(hn::Gt(x, number(1e-12F)), scale * factor, hn::Zero(Lanes())), D);
}

/// Tensors of a corotational tet.
struct Stretch {
  Symmetric strain, inverse;  ///< B = U − I, U⁻¹
};
HWY_INLINE Stretch stretch_of(const Symmetric& E, F J, F I2) {
  const F I1 = hn::MulAdd(number(2.0F), trace_of(E), number(3.0F));
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

/// How stiff the tets of an item are; what is no number counts as without bound.
HWY_INLINE void see_stiffness(ResponseBlock& out, std::size_t item, F ratio, F norm) {
  const F none = number(std::numeric_limits<float>::infinity());
  hn::Store(hn::IfThenElse(hn::IsNaN(ratio), none, ratio), Lanes(), out.ratio + item * kLanes);
  hn::Store(hn::IfThenElse(hn::IsNaN(norm), none, norm), Lanes(), out.norm + item * kLanes);
}

inline float stiffest(std::size_t items, const ResponseBlock& out) {
  F most = hn::Zero(Lanes());
  for (std::size_t item = 0; item < items; ++item) most = hn::Max(most, hn::Load(Lanes(), out.ratio + item * kLanes));
  return hn::GetLane(hn::MaxOfLanes(Lanes(), most));
}

/// Asks the scalar formulas for the tets of an item that lanes do not answer.
HWY_NOINLINE void rescue_lanes(const ResponseItems& in, const Rescue& to, std::size_t item, const float* J,
                               ResponseBlock& out) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const std::uint32_t element = in.element[item * kLanes + lane];
    if (J[lane] > float(kSmallestVolume) || element == 0xFFFFFFFFU) continue;
    const float* mean = in.mean != nullptr ? in.mean + item * kLanes + lane : nullptr;
    const Stiffening stiff =
        rescue(to, element, in.gradient + item * 9 * kLanes + lane, out.piola + item * 9 * kLanes + lane, kLanes, mean);
    out.ratio[item * kLanes + lane] = static_cast<float>(stiff.ratio);
    out.norm[item * kLanes + lane] = static_cast<float>(stiff.norm);
  }
}
HWY_INLINE void rescue_if_small(const ResponseItems& in, const Rescue& to, std::size_t item, F J, ResponseBlock& out) {
  const Lanes d;
  if (hn::AllTrue(d, hn::Gt(J, number(float(kSmallestVolume))))) return;
  alignas(64) float volume[kMaxLanes];
  hn::Store(J, d, volume);
  rescue_lanes(in, to, item, volume, out);
}

/// Whether a volume change of some tets is J ≤ 0.
HWY_INLINE bool is_inverted(F lowest) { return !hn::AllTrue(Lanes(), hn::Gt(lowest, number(-1.0F))); }

template <Kinematics K, bool kLaw>
bool tensor_mass(const ResponseItems& in, const LaneResponse& r, const Rescue& to, const Block& block,
                 ResponseBlock& out) {
  const Lanes d;
  const F one = number(1.0F), two = number(2.0F);
  F lowest = one;
  for (std::size_t item = 0; item < in.items; ++item) {
    const Tensor H = load_tensor(in.gradient + item * 9 * kLanes);
    const Invariants<F> inv = invariants(d, H);
    const F J = inv.volume_change + one;
    lowest = hn::Min(lowest, inv.volume_change);
    const LaneModuli k = moduli_of<kLaw>(r, block, item);
    const auto volume_change = [&](const Symmetric& e) GLISSON_INLINED {
      return in.mean != nullptr ? hn::Load(d, in.mean + item * kLanes) : trace_of(e);
    };
    Symmetric strain, S;
    Tensor P;
    F stretch = one;
    if constexpr (K == Kinematics::small) {
      strain = symmetric_part(H);
      S = plus_identity(times(two * k.mu, strain), k.lambda * volume_change(strain));
      P = full_tensor(S);
    } else {
      const Symmetric E = green_strain(H);
      const Tensor F1 = plus_identity(H, one);
      stretch = hn::MulAdd(two, hn::Sqrt(contraction(E, E)), one);
      if constexpr (K == Kinematics::green) {
        strain = E;
        S = plus_identity(times(two * k.mu, strain), k.lambda * volume_change(strain));
      } else {
        const F safe = hn::Max(J, number(float(kSmallestVolume)));
        const Tensor cof = plus_identity(cofactor_change(H), one);
        const Stretch u = stretch_of(E, safe, squares_of(cof));
        strain = u.strain;
        S = commuting_product(u.inverse, plus_identity(times(two * k.mu, strain), k.lambda * volume_change(strain)));
      }
      P = tensor_product(F1, S);
    }
    const F t = trace_of(strain), squares = contraction(strain, strain);
    F bound = k.ratio;
    if constexpr (kLaw) bound = law_bound(r, k, t, squares, hn::Load(d, block.x + item * kLanes));
    if constexpr (K == Kinematics::green) {
      bound = hn::MulAdd(bound, stretch, hn::Sqrt(contraction(S, S)) * number(r.rest_bound));
    } else if constexpr (K == Kinematics::corotational) {
      // turning_bound of material/stiffness_bound.h
      const F pull = hn::Max(hn::MulSub(k.lambda, volume_change(strain), two * k.mu), hn::Zero(d));
      const F length = hn::Sqrt(hn::Max(squares + hn::MulAdd(two, t, number(3.0F)), hn::Zero(d)));
      const F pair = hn::Max(t + number(3.0F) - length, number(float(kSmallestFlip)));
      bound = hn::MulAdd(two * pull / pair, number(r.rest_bound), bound);
      if (r.viscous) bound = hn::Max(bound, stretch);
    }
    if constexpr (kLaw) bound = hn::IfThenZeroElse(hn::Lt(hn::Load(d, block.y + item * kLanes), hn::Zero(d)), bound);
    see_stiffness(out, item, bound, bound);
    if (kLaw && r.energy) {
      const F work = hn::MulAdd(number(0.5F) * k.lambda_slope * t, t, k.mu_slope * squares);
      P = plus(P, one, measure_gradient(r, H, inv, hn::Load(d, block.x + item * kLanes), work));
    }
    store_tensor(P, out.piola + item * 9 * kLanes);
    if (K == Kinematics::corotational || (kLaw && r.energy)) rescue_if_small(in, to, item, J, out);
  }
  return is_inverted(lowest);
}

/// By Kinematics.
template <bool kLaw>
constexpr TensorMassStages tensor_mass_stages() {
  return {tensor_mass<Kinematics::small, kLaw>, tensor_mass<Kinematics::corotational, kLaw>,
          tensor_mass<Kinematics::green, kLaw>};
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_ELASTIC_RESPONSE_INL_H_
