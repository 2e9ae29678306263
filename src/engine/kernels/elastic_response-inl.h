// elastic_response-inl.h — tensor-mass tissues of large deformation in lanes: P of their kinematics and laws.
//
// Included once per instruction set, never from outside response_kernels.cpp.
#if defined(GLISSON_ELASTIC_RESPONSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_ELASTIC_RESPONSE_INL_H_
#undef GLISSON_ELASTIC_RESPONSE_INL_H_
#else
#define GLISSON_ELASTIC_RESPONSE_INL_H_
#endif

#include "engine/kernels/response_kernels.h"
#include "engine/kernels/stretch_lanes-inl.h"
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

/// What the stages of an item share.
struct TensorMass {
  const Tensor& H;
  const Invariants<F>& inv;
  const LaneModuli& moduli;
};
/// The bound by the moduli alone.
template <bool kLaw>
HWY_INLINE F moduli_bound(const LaneResponse& r, const Block& block, std::size_t item, const LaneModuli& moduli,
                          const StrainNorms& strain) {
  if constexpr (!kLaw) return moduli.ratio;
  return law_bound(r, moduli, strain.trace, strain.squares, hn::Load(Lanes(), block.x + item * kLanes));
}
/// The volume change that carries λ, its own or shared.
HWY_INLINE F volume_change_of(const ResponseItems& in, std::size_t item, F own) {
  return in.mean != nullptr ? hn::Load(Lanes(), in.mean + item * kLanes) : own;
}
template <bool kLaw>
HWY_INLINE void store_tensor_mass(const LaneResponse& r, const Block& block, std::size_t item, const TensorMass& t,
                                  const StrainNorms& strain, const Tensor& P, F bound, ResponseBlock& out) {
  const Lanes d;
  if constexpr (kLaw) bound = hn::IfThenZeroElse(hn::Lt(hn::Load(d, block.y + item * kLanes), hn::Zero(d)), bound);
  see_stiffness(out, item, bound, bound);
  float* piola = out.piola + item * 9 * kLanes;
  if (!kLaw || !r.energy) return store_tensor(P, piola);
  const LaneModuli& k = t.moduli;
  const F work = hn::MulAdd(number(0.5F) * k.lambda_slope * strain.trace, strain.trace, k.mu_slope * strain.squares);
  const F x = hn::Load(d, block.x + item * kLanes);
  store_tensor(plus(P, number(1.0F), measure_gradient(r, t.H, t.inv, x, work)), piola);
}

/// Of small or Green strain.
template <Kinematics K, bool kLaw>
bool tensor_mass(const ResponseItems& in, const LaneResponse& r, const Rescue& to, const Block& block,
                 ResponseBlock& out) {
  const F one = number(1.0F), two = number(2.0F);
  F lowest = one;
  for (std::size_t item = 0; item < in.items; ++item) {
    const Tensor H = load_tensor(in.gradient + item * 9 * kLanes);
    const Invariants<F> inv = invariants(Lanes(), H);
    const LaneModuli k = moduli_of<kLaw>(r, block, item);
    lowest = hn::Min(lowest, inv.volume_change);
    const Symmetric strain = K == Kinematics::green ? green_strain(H) : symmetric_part(H);
    const StrainNorms norms{trace_of(strain), contraction(strain, strain)};
    const Symmetric S = plus_identity(times(two * k.mu, strain), k.lambda * volume_change_of(in, item, norms.trace));
    F bound = moduli_bound<kLaw>(r, block, item, k, norms);
    if constexpr (K == Kinematics::green) {
      const F stretch = hn::MulAdd(two, hn::Sqrt(norms.squares), one);
      bound = hn::MulAdd(bound, stretch, hn::Sqrt(contraction(S, S)) * number(r.rest_bound));
      const Tensor P = tensor_product(plus_identity(H, one), S);
      store_tensor_mass<kLaw>(r, block, item, {H, inv, k}, norms, P, bound, out);
    } else {
      store_tensor_mass<kLaw>(r, block, item, {H, inv, k}, norms, full_tensor(S), bound, out);
    }
    if (kLaw && r.energy) rescue_if_small(in, to, item, inv.volume_change + one, out);
  }
  return is_inverted(lowest);
}

/// An item from S = λ tr(B) U⁻¹ + 2 μ (I − U⁻¹). @param volumetric  λ tr B  @param known  the tets whose stress it is
template <bool kLaw, class Known>
HWY_INLINE void store_corotational(const ResponseItems& in, const LaneResponse& r, const Rescue& to, const Block& block,
                                   std::size_t item, const TensorMass& t, const Symmetric& E, const StrainNorms& norms,
                                   F volumetric, const Symmetric& S, Known known, ResponseBlock& out) {
  const F one = number(1.0F), two = number(2.0F), three = number(3.0F), zero = hn::Zero(Lanes());
  const Tensor P = tensor_product(plus_identity(t.H, one), S);
  F bound = moduli_bound<kLaw>(r, block, item, t.moduli, norms);
  const F pull = hn::NegMulAdd(two, t.moduli.mu, volumetric);
  if (!hn::AllFalse(Lanes(), hn::Gt(pull, zero))) {  // turning_bound of material/stiffness_bound.h
    const F length = hn::Sqrt(hn::MulAdd(two, trace_of(E), three));
    const F pair = hn::Max(norms.trace + three - length, number(float(kSmallestFlip)));
    bound = hn::MulAdd(two * hn::Max(pull, zero) / pair, number(r.rest_bound), bound);
  }
  if (r.viscous) bound = hn::Max(bound, hn::MulAdd(two, hn::Sqrt(contraction(E, E)), one));
  store_tensor_mass<kLaw>(r, block, item, t, norms, P, bound, out);
  rescue_if_small(in, to, item, hn::IfThenElse(known, t.inv.volume_change + one, one), out);
}

/// An item, whatever its stretches.
template <bool kLaw>
HWY_NOINLINE void corotate_by_invariants(const ResponseItems& in, const LaneResponse& r, const Rescue& to,
                                         const Block& block, std::size_t item, ResponseBlock& out) {
  const Tensor H = load_tensor(in.gradient + item * 9 * kLanes);
  const Invariants<F> inv = invariants(Lanes(), H);
  const LaneModuli k = moduli_of<kLaw>(r, block, item);
  const Symmetric E = green_strain(H);
  const StretchTensors u = stretch_tensors(E, H, inv.volume_change);
  const StrainNorms norms{trace_of(u.strain), contraction(u.strain, u.strain)};
  const F volumetric = k.lambda * volume_change_of(in, item, norms.trace);
  const Symmetric S = commuting_product(u.inverse, plus_identity(times(number(2.0F) * k.mu, u.strain), volumetric));
  const auto all = hn::Gt(number(1.0F), hn::Zero(Lanes()));
  store_corotational<kLaw>(in, r, to, block, item, {H, inv, k}, E, norms, volumetric, S, all, out);
}

/// A tet's own strain decides how its stretches are found, not its neighbours'.
template <bool kLaw>
bool corotational_law(const ResponseItems& in, const LaneResponse& r, const Rescue& to, const Block& block,
                      ResponseBlock& out) {
  const RootSeries<float>& series = lane_root_series();
  FarTets far;
  F lowest = number(1.0F);
  for (std::size_t item = 0; item < in.items; ++item) {
    const Tensor H = load_tensor(in.gradient + item * 9 * kLanes);
    const Invariants<F> inv = invariants(Lanes(), H);
    lowest = hn::Min(lowest, inv.volume_change);
    const Symmetric E = green_strain(H);
    const MeanStretch m = mean_stretch(E);
    const Symmetric X = stretch_deviator(E, m.third, m.per_root * m.per_root);
    const LaneScalar J2(second_invariant(X));
    const auto close = hn::Lt(J2.v, number(series.largest_J2));
    if (hn::AllFalse(Lanes(), close)) {
      corotate_by_invariants<kLaw>(in, r, to, block, item, out);
      continue;
    }
    const LaneModuli k = moduli_of<kLaw>(r, block, item);
    const SymmetricCofactors c = cofactors_of(X);
    const LaneScalar J3(c.determinant);
    const StrainNorms norms = norms_by_series(m, series_at(series.trace, J2, J3).v);
    const F volumetric = k.lambda * volume_change_of(in, item, norms.trace);
    const Symmetric S = stress_by_series(series, m, X, c.cof, J2, J3, volumetric, number(2.0F) * k.mu);
    store_corotational<kLaw>(in, r, to, block, item, {H, inv, k}, E, norms, volumetric, S, close, out);
    if (!hn::AllTrue(Lanes(), close)) far.list(item, J2.v, series.largest_J2);
  }
  far.respond<kLaw>(in, block, out,
                    [&](const ResponseItems& some, const Block& of, ResponseBlock& found)
                        GLISSON_INLINED { corotate_by_invariants<kLaw>(some, r, to, of, 0, found); });
  return is_inverted(lowest);
}

/// By Kinematics.
template <bool kLaw>
constexpr TensorMassStages tensor_mass_stages() {
  return {tensor_mass<Kinematics::small, kLaw>, corotational_law<kLaw>, tensor_mass<Kinematics::green, kLaw>};
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_ELASTIC_RESPONSE_INL_H_
