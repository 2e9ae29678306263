// hyper_response-inl.h — hyperelastic laws in lanes: src/material/hyperelastic_response.h, and the bounds of
// src/material/stiffness_bound.h.
//
// The slopes of a law of the invariants are its own (src/material/hyperelastic_formulas.h) on LaneScalar. Ogden's powers are
// a series of the strain where stretches are close to each other (src/material/stretch_series.h). Else they need principal
// stretches, but not their directions: S is the polynomial in E that takes the right values at its eigenvalues.
//
// Included once per instruction set, never from outside response_kernels.cpp.
#if defined(GLISSON_HYPER_RESPONSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_HYPER_RESPONSE_INL_H_
#undef GLISSON_HYPER_RESPONSE_INL_H_
#else
#define GLISSON_HYPER_RESPONSE_INL_H_
#endif

#include <type_traits>
#include <variant>

#include "engine/kernels/elastic_response-inl.h"
#include "engine/kernels/lane_scalar-inl.h"
#include "material/hyperelastic_formulas.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

/// I₁, I₂ and J for the bounds, and λ_max² of them.
struct LaneInvariants {
  F I1, I2, J;
  HWY_INLINE F stretch_squared() const { return hn::NegMulAdd(number(2.0F) * J, number(1.0F) / hn::Sqrt(I1), I1); }
};
HWY_INLINE F volume_bound(const LaneInvariants& i, F bulk) {
  const F more = i.J - number(1.0F);
  const F bend = hn::IfThenElse(hn::Gt(more, hn::Zero(Lanes())), i.I1 + i.I1, i.stretch_squared());
  return bulk * hn::MulAdd(hn::Abs(more), hn::Sqrt(bend), i.I2);
}
/// The larger of the two parts' growth since rest, and both over all that the tangent is at rest.
HWY_INLINE void see_parts(const LaneResponse& r, std::size_t item, F isochoric, F volume, ResponseBlock& out) {
  const F larger = hn::Max(isochoric * number(r.rest_isochoric), volume * number(r.rest_volume));
  see_stiffness(out, item, larger, (isochoric + volume) * number(r.rest_bound));
}
/// Of F, with J^(−⅔); of cof F too.
HWY_INLINE F first_invariant_bend(const LaneInvariants& i, F power) {
  const F per_J = number(1.0F) / i.J, product = i.I1 * i.I2 * per_J * per_J;
  const F inner = hn::MulAdd(number(10.0F / 9.0F), product, number(2.0F)) +
                  hn::MulAdd(number(2.0F / 3.0F) * i.I1 * per_J, hn::Sqrt(i.stretch_squared()),
                             number(4.0F / 3.0F) * (hn::Sqrt(product) - number(3.0F)));
  return inner * power;
}
HWY_INLINE F first_invariant_slope_squared(const LaneInvariants& i, F power) {
  const F inner = hn::MulSub(i.I1 * i.I1, i.I2 / (number(9.0F) * i.J * i.J), i.I1);
  return number(4.0F) * power * power * hn::Max(inner, hn::Zero(Lanes()));
}

/// ‖∂Ī₂/∂F‖². @param power  J^(−⅔)
HWY_INLINE F second_invariant_slope_squared(const LaneInvariants& i, F power) {
  const F J2 = i.J * i.J, square = power * power;
  const F inner = hn::MulAdd(i.I2, hn::MulSub(number(4.0F / 9.0F) * i.I2, i.I2 / J2, number(5.0F / 3.0F) * i.I1),
                             number(3.0F) * J2);
  return number(4.0F) * square * square * hn::Max(inner, hn::Zero(Lanes()));
}

/// κ (J − 1) cof F, and what all laws share.
struct HyperState {
  Tensor H, K;
  Invariants<F> inv;
  F J, I1, I2, power;  ///< J^(−⅔)
};
HWY_INLINE HyperState hyper_state(const float* gradient) {
  const Lanes d;
  HyperState s;
  s.H = load_tensor(gradient);
  s.K = cofactor_change(s.H);
  s.inv = invariants(d, s.H);
  s.J = hn::Max(s.inv.volume_change + number(1.0F), number(float(kSmallestVolume)));
  s.I1 = hn::MulAdd(number(2.0F), s.inv.trace, squares_of(s.H)) + number(3.0F);
  s.I2 = hn::MulAdd(number(2.0F), trace(s.K), squares_of(s.K)) + number(3.0F);
  const F root = inverse_cube_root(d, s.J);
  s.power = root * root;
  return s;
}
/// κ times the volume change, of its own or shared.
HWY_INLINE F pressure_of(const ResponseItems& in, const LaneResponse& r, std::size_t item, F own) {
  return number(r.bulk) * (in.mean != nullptr ? hn::Load(Lanes(), in.mean + item * kLanes) : own);
}
/// Ī₁ − 3 from 1 − q.
HWY_INLINE F excess(const Invariants<F>& inv) {
  const F p = one_minus_q(Lanes(), inv);
  return number(3.0F) * p / (number(1.0F) - hn::Min(p, number(0.999F)));
}
/// Of K = cof F − I, for Ī₂ − 3 is Ī₁ − 3 of cof F. With those of H nothing cancels:
///   m₂(K) = m₂ + 3 det H + j t,   det K = j (m₂ + det H) − det H,   det(I + K) − 1 = j (2 + j)
HWY_INLINE Invariants<F> cofactor_invariants(const HyperState& s) {
  const Invariants<F>& h = s.inv;
  const F j = h.volume_change, t = trace(s.K), two = number(2.0F);
  const Tensor D = plus_identity(s.K, t * number(-1.0F / 3.0F));
  const F xy = D.h[0][1] + D.h[1][0], yz = D.h[1][2] + D.h[2][1], zx = D.h[2][0] + D.h[0][2];
  const F diagonal = hn::MulAdd(D.h[0][0], D.h[0][0], hn::MulAdd(D.h[1][1], D.h[1][1], D.h[2][2] * D.h[2][2]));
  const F off = hn::MulAdd(xy, xy, hn::MulAdd(yz, yz, zx * zx));
  return {t, hn::MulAdd(j, h.trace, hn::MulAdd(number(3.0F), h.determinant, h.minors)),
          hn::MulSub(j, h.minors + h.determinant, h.determinant), hn::MulAdd(diagonal, two, off), j * (two + j)};
}
template <class Law>
GLISSON_FORMULA InvariantSlopes<LaneScalar> lane_slopes(const Law& law, const HyperState& s) {
  const LaneScalar first(excess(s.inv));
  if constexpr (Law::kSecond == SecondInvariant::general) {
    return law.slopes(first, LaneScalar(excess(cofactor_invariants(s))));
  } else {
    return law.slopes(first, LaneScalar(0.0));
  }
}

template <class Law>
bool invariant_law(const ResponseItems& in, const LaneResponse& r, const Rescue& to, const Block&, ResponseBlock& out) {
  const Law law = std::get<Law>(*r.law);  // a copy, which stores cannot change
  F lowest = number(1.0F);
  for (std::size_t item = 0; item < in.items; ++item) {
    const HyperState s = hyper_state(in.gradient + item * 9 * kLanes);
    const F j = s.inv.volume_change, one = number(1.0F), pressure = pressure_of(in, r, item, j);
    lowest = hn::Min(lowest, j);
    const InvariantSlopes<LaneScalar> slopes = lane_slopes(law, s);
    const F first = slopes.first.v, second = slopes.second.v, bend = slopes.bend.v;
    Tensor P = times(number(2.0F) * first * s.power, deviatoric_direction(s.H, s.K, j, squares_of(s.H)));
    P = plus(plus_identity(P, pressure), pressure, s.K);
    const LaneInvariants i{s.I1, s.I2, s.J};
    const F first_squared = first_invariant_slope_squared(i, s.power);
    F bound = hn::MulAdd(hn::Abs(first), first_invariant_bend(i, s.power), hn::Abs(bend) * first_squared);
    if constexpr (Law::kSecond == SecondInvariant::general) {
      const F second_squared = second_invariant_slope_squared(i, s.power);
      bound = hn::MulAdd(hn::Abs(slopes.second_bend.v), second_squared, bound);
      bound = hn::MulAdd(number(2.0F) * hn::Abs(slopes.mixed.v), hn::Sqrt(first_squared * second_squared), bound);
    }
    if constexpr (Law::kSecond != SecondInvariant::none) {
      const Symmetric E = green_strain(s.H);
      const Tensor F1 = plus_identity(s.H, one);
      const F three_J = number(3.0F) * s.J, t = trace_of(E);
      const F left = hn::NegMulAdd(number(2.0F), trace(s.K), hn::MulSub(number(3.0F), j, squares_of(s.K))) / three_J;
      Tensor D = plus_identity(plus(s.H, left - one, s.K), left);
      D = plus(plus(D, t, F1), number(-1.0F), tensor_product(F1, E));
      P = plus(P, number(4.0F) * second * s.power * s.power, D);
      const LaneInvariants c{s.I2, s.I1 * s.J * s.J, s.J * s.J};
      const F power = s.power * s.power;
      const F most = hn::MulAdd(first_invariant_bend(c, power), i.stretch_squared(),
                                number(2.0F) * hn::Sqrt(first_invariant_slope_squared(c, power)));
      bound = hn::MulAdd(hn::Abs(second), most, bound);
    }
    see_parts(r, item, bound, volume_bound(i, number(r.bulk)), out);
    store_tensor(P, out.piola + item * 9 * kLanes);
    rescue_if_small(in, to, item, j + one, out);
  }
  return is_inverted(lowest);
}

/// cos(⅓ arccos r) for −1 ≤ r ≤ 1, within 6e-8: with w = √(½(1 + r)), the cosine of half the angle, it is cos(⅔ arccos w), which
/// is smooth from w = 0 to 1 and taken from a polynomial through eight Chebyshev points.
HWY_INLINE F cosine_of_third(F r) {
  const Lanes d;
  const F half = number(0.5F);
  const F w = hn::Sqrt(hn::Max(hn::MulAdd(r, half, half), hn::Zero(d))), w2 = w * w;
  const F p01 = hn::MulAdd(w, number(0.577346917F), number(0.500000026F));
  const F p23 = hn::MulAdd(w, number(0.0528414091F), number(-0.111038511F));
  const F p45 = hn::MulAdd(w, number(0.0160472804F), number(-0.0302353976F));
  const F p67 = hn::MulAdd(w, number(0.00112763624F), number(-0.00608934568F));
  return hn::MulAdd(hn::MulAdd(p67, w2, p45), w2 * w2, hn::MulAdd(p23, w2, p01));
}

/// The three eigenvalues of a symmetric tensor, e₁ ≥ e₂ ≥ e₃, by the angle of its invariants. Two that are equal come out
/// up to 3e-4 of the third's distance apart, which an interpolation between them does not notice.
struct Eigenvalues {
  F e[3];
};
HWY_INLINE Eigenvalues eigenvalues(const Symmetric& E) {
  const Lanes d;
  const F mean = trace_of(E) * number(1.0F / 3.0F), one = number(1.0F);
  const Symmetric D = plus_identity(E, hn::Neg(mean));
  const F p = hn::Sqrt(contraction(D, D) * number(1.0F / 6.0F));
  const F cube = hn::Max(p * p * p, number(1e-36F));
  const F r = hn::Min(hn::Max(cofactors_of(D).determinant * number(0.5F) / cube, hn::Neg(one)), one);
  const F c = cosine_of_third(r);
  const F s = hn::Sqrt(hn::Max(hn::NegMulAdd(c, c, one), hn::Zero(d)));
  const F first = hn::MulAdd(p + p, c, mean);
  const F third = hn::NegMulAdd(p, hn::MulAdd(number(1.7320508F), s, c), mean);
  return {{first, number(3.0F) * mean - first - third, third}};
}

/// g of a principal direction, S = Σ g_i n_i ⊗ n_i, with its first two derivatives by the eigenvalue e of E.
struct PrincipalStress {
  F g, first, second;
};

/// The divided difference g[e_a, e_b] over d = e_a − e_b ≥ 0; where they are close by the derivatives at both ends,
/// ½ (g_a' + g_b') − d/12 (g_a'' − g_b''), which is off by d⁴/720 of the fifth derivative.
HWY_INLINE F divided_difference(const PrincipalStress& a, const PrincipalStress& b, F d) {
  const F limit = number(0.03F);
  const F near = hn::MulAdd(number(-1.0F / 12.0F) * d, a.second - b.second, number(0.5F) * (a.first + b.first));
  return hn::IfThenElse(hn::Lt(d, limit), near, (a.g - b.g) / hn::Max(d, limit));
}

/// S = g₁ I + g[e₁,e₂] (E − e₁ I) + g[e₁,e₂,e₃] (E − e₁ I)(E − e₂ I): no eigenvectors.
HWY_INLINE Symmetric isotropic_function(const Symmetric& E, const Eigenvalues& at, const PrincipalStress (&s)[3]) {
  const F upper = divided_difference(s[0], s[1], at.e[0] - at.e[1]);
  const F lower = divided_difference(s[1], s[2], at.e[1] - at.e[2]);
  const F bend = (upper - lower) / hn::Max(at.e[0] - at.e[2], number(1e-20F));
  const Symmetric first = plus_identity(E, hn::Neg(at.e[0])), second = plus_identity(E, hn::Neg(at.e[1]));
  return plus_identity(plus(times(upper, first), bend, commuting_product(first, second)), s[0].g);
}

/// λ_max of ∂P/∂F of P = F S in the principal frame (material/stiffness_bound.h), from t = ∂W/∂ln λ and the sums of
/// ∂²W/∂(ln λ̄)² of the terms, which make ∂t_i/∂ln λ_j = slope_i δ_ij − ⅓ (slope_i + slope_j) + ⅑ Σ slope.
HWY_INLINE F stiffest_direction(const Eigenvalues& at, const PrincipalStress (&s)[3], const F (&t)[3],
                                const F (&slope)[3], const F (&c)[3]) {
  const F third = number(1.0F / 3.0F), half = number(0.5F);
  F l[3], per[3], A[3][3];
  for (std::size_t i = 0; i < 3; ++i) l[i] = hn::Sqrt(c[i]), per[i] = number(1.0F) / l[i];
  const F ninth = (slope[0] + slope[1] + slope[2]) * number(1.0F / 9.0F);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j) {
      const F both = hn::NegMulAdd(third, slope[i] + slope[j], ninth);
      A[i][j] = per[i] * per[j] * (i == j ? both + slope[i] - t[i] : both);
    }
  }
  F most = eigenvalues({A[0][0], A[1][1], A[2][2], A[0][1], A[1][2], A[0][2]}).e[0];
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t first = i == 2 ? 0 : i, second = i == 2 ? 2 : i + 1;  // e of the first is the larger
    const F sum = l[first] + l[second];
    const F difference = divided_difference(s[first], s[second], at.e[first] - at.e[second]);
    const F even = hn::MulAdd(half * l[second] * sum, difference, s[first].g);
    const F odd = hn::MulAdd(s[first].g, l[first], s[second].g * l[second]) / sum;
    most = hn::Max(most, hn::Max(even, odd));
  }
  return most;
}

/// The isochoric part of a law of stretches.
struct IsochoricStress {
  Tensor P;
  F bound;     ///< of λ_max of ∂P/∂F
  F thinnest;  ///< λ₃² where stretches may be beyond where logarithms go on otherwise, else 1
};

/// From the principal stretches, for any.
HWY_INLINE IsochoricStress stress_of_stretches(const Ogden& law, const Tensor& H) {
  const Lanes d;
  const Symmetric E = green_strain(H);
  const F one = number(1.0F), two = number(2.0F), third = number(1.0F / 3.0F), zero = hn::Zero(d);
  const F most = number(float(Ogden::kLargestExponent));
  const Eigenvalues at = eigenvalues(E);
  F l[3], c[3], t[3] = {zero, zero, zero}, slope[3] = {zero, zero, zero}, bend[3] = {zero, zero, zero};
  for (std::size_t i = 0; i < 3; ++i) {
    const F twice = hn::Max(at.e[i] + at.e[i], number(-0.999F));
    c[i] = twice + one;
    l[i] = number(0.5F) * hn::Log1p(d, twice);
  }
  const F mean = (l[0] + l[1] + l[2]) * third;
  for (std::size_t k = 0; k < law.mu.size(); ++k) {
    const F alpha = number(float(law.alpha[k])), factor = number(float(2.0 * law.mu[k] / law.alpha[k]));
    F g[3];
    for (std::size_t i = 0; i < 3; ++i) g[i] = hn::Expm1(d, hn::Min(alpha * (l[i] - mean), most));
    const F average = (g[0] + g[1] + g[2]) * third;
    for (std::size_t i = 0; i < 3; ++i) {
      const F rise = factor * alpha * (g[i] + one);
      t[i] = hn::MulAdd(factor, g[i] - average, t[i]);
      slope[i] = slope[i] + rise;
      bend[i] = hn::MulAdd(alpha, rise, bend[i]);
    }
  }
  // g = τ/λ² and its derivatives by e, with dτ/d ln λ = slope, d²τ/d(ln λ)² = bend
  PrincipalStress s[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const F inverse = one / c[i], square = inverse * inverse;
    s[i].g = t[i] * inverse;
    s[i].first = hn::NegMulAdd(two, t[i], slope[i]) * square;
    s[i].second = hn::MulAdd(number(8.0F), t[i], hn::NegMulAdd(number(6.0F), slope[i], bend[i])) * square * inverse;
  }
  return {tensor_product(plus_identity(H, one), isotropic_function(E, at, s)), stiffest_direction(at, s, t, slope, c),
          c[2]};
}

/// P = F⁻ᵀ (q₁ X + q₂ dev X²), dev X² = cof X + ⅓ J₂ I, where the series hold. @param per_mean  1/m
HWY_INLINE IsochoricStress stress_of_series(const StretchSeries<float>& series, const Symmetric& X, F J2, F per_mean,
                                            const HyperState& state) {
  const SymmetricCofactors c = cofactors_of(X);
  const LaneScalar second(J2), third(c.determinant);
  const F q1 = series_at(series.first, second, third).v, q2 = series_at(series.second, second, third).v;
  const Symmetric T = plus(times(q1, X), q2, plus_identity(c.cof, J2 * number(1.0F / 3.0F)));
  const F delta = hn::Sqrt(J2 * number(4.0F / 3.0F)), one = number(1.0F);
  const F square = hn::MulAdd(delta, number(series.bound[2]), number(series.bound[1]));
  const F shape = number(series.bound[3]) * third.v / hn::Max(delta, number(1e-12F));
  const F bound = hn::MulAdd(delta, square, number(series.bound[0])) + shape;
  const Tensor cof = plus_identity(state.K, one);
  return {tensor_product(cof, times(one / state.J, T)), bound * per_mean, one};
}

/// Stores all that a stage says of an item. @param known  the tets whose stress this is
template <class Known>
HWY_INLINE void store_stretched(const ResponseItems& in, const LaneResponse& r, const Rescue& to, std::size_t item,
                                const HyperState& state, const IsochoricStress& stress, Known known,
                                ResponseBlock& out) {
  const F one = number(1.0F), pressure = pressure_of(in, r, item, state.inv.volume_change);
  const Tensor volumetric = plus_identity(times(pressure, state.K), pressure);
  store_tensor(plus(volumetric, one, stress.P), out.piola + item * 9 * kLanes);
  const LaneInvariants i{state.I1, state.I2, state.J};
  see_parts(r, item, stress.bound, volume_bound(i, number(r.bulk)), out);
  // a stretch below the limit where ln λ goes on otherwise counts as a lost volume
  const F limit = number(float(kSmallestStretch * kSmallestStretch));
  const F J = hn::IfThenElse(hn::Lt(stress.thinnest, limit), hn::Zero(Lanes()), state.inv.volume_change + one);
  rescue_if_small(in, to, item, hn::IfThenElse(known, J, one), out);
}

/// An item, whatever its stretches.
HWY_NOINLINE void respond_by_stretches(const ResponseItems& in, const LaneResponse& r, const Rescue& to,
                                       std::size_t item, ResponseBlock& out) {
  const HyperState state = hyper_state(in.gradient + item * 9 * kLanes);
  const auto all = hn::Gt(number(1.0F), hn::Zero(Lanes()));
  store_stretched(in, r, to, item, state, stress_of_stretches(std::get<Ogden>(*r.law), state.H), all, out);
}

/// A tet's own strain decides how its stress is found, not its neighbours'.
inline bool ogden_law(const ResponseItems& in, const LaneResponse& r, const Rescue& to, const Block& block,
                      ResponseBlock& out) {
  const StretchSeries<float>& series = *r.series;
  const float largest = series.largest_J2;
  FarTets far;
  const F one = number(1.0F);
  F lowest = one;
  for (std::size_t item = 0; item < in.items; ++item) {
    const HyperState state = hyper_state(in.gradient + item * 9 * kLanes);
    lowest = hn::Min(lowest, state.inv.volume_change);
    const Symmetric E = green_strain(state.H);
    const F mean = trace_of(E) * number(1.0F / 3.0F), per_mean = one / hn::MulAdd(number(2.0F), mean, one);
    const Symmetric X = stretch_deviator(E, mean, per_mean);
    const F J2 = second_invariant(X);
    const auto close = hn::Lt(J2, number(largest));
    if (hn::AllFalse(Lanes(), close)) {
      respond_by_stretches(in, r, to, item, out);
      continue;
    }
    store_stretched(in, r, to, item, state, stress_of_series(series, X, J2, per_mean, state), close, out);
    if (!hn::AllTrue(Lanes(), close)) far.list(item, J2, largest);
  }
  far.respond<false>(in, block, out,
                     [&](const ResponseItems& some, const Block&, ResponseBlock& found)
                         GLISSON_INLINED { respond_by_stretches(some, r, to, 0, found); });
  return is_inverted(lowest);
}

template <class Law>
constexpr RespondStage hyperelastic_stage() {
  if constexpr (std::is_same_v<Law, Ogden>) {
    return ogden_law;
  } else {
    return invariant_law<Law>;
  }
}
/// The stages of all laws, in the order of their list.
template <class... Laws>
constexpr HyperelasticStages hyperelastic_stages(std::type_identity<std::variant<Laws...>>) {
  return {hyperelastic_stage<Laws>()...};
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_HYPER_RESPONSE_INL_H_
