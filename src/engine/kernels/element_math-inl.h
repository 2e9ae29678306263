// element_math-inl.h — the arithmetic of one tetrahedron, written once for lanes of any kind.
//
// V is a vector of floats, one lane a tet, or a number that counts its operations (counted.h); D is its
// Highway tag. Calls are unqualified, so that the lanes' own namespace provides Set, MulAdd and so on.
//
// The measure is that of glisson/material/shape_measure.h, rearranged to need no division but one. With t = tr H,
// m₂ the sum of its principal minors, j = J − 1 = t + m₂ + det H and ψ(j) = −3 (J^⅔ − 1 − ⅔ j + ⅑ j²),
//
//   1 − q = N / I₁,   N  = 2 ‖dev ε‖² + ⅓ (m₂ + det H)(j + t) − 2 det H + ψ(j)
//                     I₁ = 3 + 2 t + ‖H‖²,   ‖H‖² = 2 ‖dev ε‖² − ⅓ t² + 2 m₂
//
// in which every term that cancels is cancelled on paper. ψ is of third order: near rest a polynomial.
//
// Included once per instruction set, never from outside kernels.cpp.
#if defined(GLISSON_ELEMENT_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_ELEMENT_MATH_INL_H_
#undef GLISSON_ELEMENT_MATH_INL_H_
#else
#define GLISSON_ELEMENT_MATH_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "engine/kernels/inlined.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

/// H = Σ u_a ⊗ s_a of the three vertices that are not the origin: h[i][j] = ∂u_i/∂x_j.
template <class V>
struct Gradient {
  V h[3][3];
};

/// σ, symmetric.
template <class V>
struct Stress {
  V xx, yy, zz, xy, yz, zx;
};

/// Largest |J − 1| for which ψ is taken from its polynomial: ten times what tissue does, inside 2.4e-9 of ψ.
inline constexpr float kSmallVolumeChange = 0.3F;

template <class V, class Point>
HWY_INLINE Gradient<V> gradient(const Point& u1, const Point& u2, const Point& u3, const V (&s)[3][3]) {
  Gradient<V> g;
  for (std::size_t j = 0; j < 3; ++j) {
    g.h[0][j] = MulAdd(u3.x, s[2][j], MulAdd(u2.x, s[1][j], u1.x * s[0][j]));
    g.h[1][j] = MulAdd(u3.y, s[2][j], MulAdd(u2.y, s[1][j], u1.y * s[0][j]));
    g.h[2][j] = MulAdd(u3.z, s[2][j], MulAdd(u2.z, s[1][j], u1.z * s[0][j]));
  }
  return g;
}

template <class V>
HWY_INLINE V trace(const Gradient<V>& g) {
  return g.h[0][0] + g.h[1][1] + g.h[2][2];
}

/// σ = λ tr(ε) I + 2 μ ε.
template <class V>
HWY_INLINE Stress<V> stress(const Gradient<V>& g, V lambda, V mu) {
  const V p = lambda * trace(g), two_mu = mu + mu;
  const auto& h = g.h;
  return {MulAdd(two_mu, h[0][0], p), MulAdd(two_mu, h[1][1], p), MulAdd(two_mu, h[2][2], p),
          mu * (h[0][1] + h[1][0]),   mu * (h[1][2] + h[2][1]),   mu * (h[2][0] + h[0][2])};
}

/// P, not symmetric: p[i][j].
template <class V>
struct Piola {
  V p[3][3];
};

template <class V>
HWY_INLINE Stress<V> scaled(const Stress<V>& s, V f) {
  return {s.xx * f, s.yy * f, s.zz * f, s.xy * f, s.yz * f, s.zx * f};
}

/// f = σ s, for a stress that carries −V already.
template <class V, class Point>
HWY_INLINE Point force(const Stress<V>& t, const V (&s)[3]) {
  return {MulAdd(t.zx, s[2], MulAdd(t.xy, s[1], t.xx * s[0])), MulAdd(t.yz, s[2], MulAdd(t.yy, s[1], t.xy * s[0])),
          MulAdd(t.zz, s[2], MulAdd(t.yz, s[1], t.zx * s[0]))};
}

/// The same, added to what another tet exerts on the vertex.
template <class V, class Point>
HWY_INLINE Point add_force(const Stress<V>& t, const V (&s)[3], const Point& f) {
  return {MulAdd(t.zx, s[2], MulAdd(t.xy, s[1], MulAdd(t.xx, s[0], f.x))),
          MulAdd(t.yz, s[2], MulAdd(t.yy, s[1], MulAdd(t.xy, s[0], f.y))),
          MulAdd(t.zz, s[2], MulAdd(t.yz, s[1], MulAdd(t.zx, s[0], f.z)))};
}

/// The same with −s.
template <class V, class Point>
HWY_INLINE Point force_against(const Stress<V>& t, const V (&s)[3], const Point& f) {
  return {NegMulAdd(t.zx, s[2], NegMulAdd(t.xy, s[1], NegMulAdd(t.xx, s[0], f.x))),
          NegMulAdd(t.yz, s[2], NegMulAdd(t.yy, s[1], NegMulAdd(t.xy, s[0], f.y))),
          NegMulAdd(t.zz, s[2], NegMulAdd(t.yz, s[1], NegMulAdd(t.zx, s[0], f.z)))};
}

/// f = P s, for a stress that carries −V already.
template <class V, class Point>
HWY_INLINE Point force(const Piola<V>& t, const V (&s)[3]) {
  const auto row = [&](const V(&p)[3]) GLISSON_INLINED { return MulAdd(p[2], s[2], MulAdd(p[1], s[1], p[0] * s[0])); };
  return {row(t.p[0]), row(t.p[1]), row(t.p[2])};
}
template <class V, class Point>
HWY_INLINE Point add_force(const Piola<V>& t, const V (&s)[3], const Point& f) {
  const auto row = [&](const V(&p)[3], V beside)
                       GLISSON_INLINED { return MulAdd(p[2], s[2], MulAdd(p[1], s[1], MulAdd(p[0], s[0], beside))); };
  return {row(t.p[0], f.x), row(t.p[1], f.y), row(t.p[2], f.z)};
}

template <class V, class Point>
HWY_INLINE Point force_against(const Piola<V>& t, const V (&s)[3], const Point& f) {
  const auto row = [&](const V(&p)[3], V beside) GLISSON_INLINED {
    return NegMulAdd(p[2], s[2], NegMulAdd(p[1], s[1], NegMulAdd(p[0], s[0], beside)));
  };
  return {row(t.p[0], f.x), row(t.p[1], f.y), row(t.p[2], f.z)};
}

/// What the measure and the stable step need of H.
template <class V>
struct Invariants {
  V trace, minors, determinant, twice_deviator, volume_change;  ///< t, m₂, det H, 2 ‖dev ε‖², j
};

template <class D, class V>
HWY_INLINE Invariants<V> invariants(D d, const Gradient<V>& g) {
  const auto& h = g.h;
  const V c00 = NegMulAdd(h[1][2], h[2][1], h[1][1] * h[2][2]);
  const V c11 = NegMulAdd(h[0][2], h[2][0], h[0][0] * h[2][2]);
  const V c22 = NegMulAdd(h[0][1], h[1][0], h[0][0] * h[1][1]);
  const V c01 = NegMulAdd(h[1][2], h[2][0], h[1][0] * h[2][2]);
  const V c02 = NegMulAdd(h[1][1], h[2][0], h[1][0] * h[2][1]);
  const V minors = c00 + c11 + c22;
  const V determinant = MulAdd(h[0][0], c00, NegMulAdd(h[0][1], c01, h[0][2] * c02));
  const V t = trace(g), third = t * Set(d, 1.0F / 3.0F);
  const V a = h[0][0] - third, b = h[1][1] - third, c = h[2][2] - third;
  const V xy = h[0][1] + h[1][0], yz = h[1][2] + h[2][1], zx = h[2][0] + h[0][2];
  const V diagonal = MulAdd(a, a, MulAdd(b, b, c * c)), off = MulAdd(xy, xy, MulAdd(yz, yz, zx * zx));
  return {t, minors, determinant, MulAdd(diagonal, Set(d, 2.0F), off), t + (minors + determinant)};
}

/// J^(−⅓) for J > 0: the exponent divided by −3 as an integer, then three Newton steps; within 2e-7.
template <class D, class V>
HWY_INLINE V inverse_cube_root(D d, V J) {
  V y = guess_inverse_cube_root(d, J);
  const V third = J * Set(d, 1.0F / 3.0F), four_thirds = Set(d, 4.0F / 3.0F);
  for (int i = 0; i < 3; ++i) y = NegMulAdd(y * y * y, y * third, y * four_thirds);
  return y;
}

/// ψ(j) where j may be anything above −1, from δ = J^⅓ − 1: ψ = −δ³ (4 + 5 δ + 2 δ² + ⅓ δ³).
template <class D, class V>
HWY_INLINE V psi_of_cube_root(D d, V volume_change) {
  const V J = Max(volume_change + Set(d, 1.0F), Set(d, 1e-12F));
  const V y = inverse_cube_root(d, J);
  const V delta = J * y * y - Set(d, 1.0F);
  const V p =
      MulAdd(MulAdd(MulAdd(delta, Set(d, 1.0F / 3.0F), Set(d, 2.0F)), delta, Set(d, 5.0F)), delta, Set(d, 4.0F));
  return Set(d, 0.0F) - delta * delta * delta * p;
}

/// ψ(j) for |j| ≤ kSmallVolumeChange: j³ times a polynomial through seven Chebyshev points.
template <class D, class V>
HWY_INLINE V psi_of_small(D d, V j) {
  const V j2 = j * j;
  const V p01 = MulAdd(j, Set(d, 0.0864212829F), Set(d, -0.148148148F));
  const V p23 = MulAdd(j, Set(d, 0.0414746496F), Set(d, -0.057614471F));
  const V p45 = MulAdd(j, Set(d, 0.0280206095F), Set(d, -0.0315877073F));
  const V p456 = MulAdd(j2, Set(d, -0.0229359121F), p45);
  return j2 * j * MulAdd(MulAdd(p456, j2, p23), j2, p01);
}

template <class D, class V>
HWY_INLINE V one_minus_q(D d, const Invariants<V>& e) {
  const V j = e.volume_change, md = e.minors + e.determinant;
  V psi = psi_of_small(d, j);
  const auto small = Lt(Abs(j), Set(d, kSmallVolumeChange));
  if (!AllTrue(d, small)) psi = IfThenElse(small, psi, psi_of_cube_root(d, j));
  const V N =
      MulAdd(md * Set(d, 1.0F / 3.0F), j + e.trace, MulAdd(e.determinant, Set(d, -2.0F), e.twice_deviator)) + psi;
  const V squares = MulAdd(e.minors, Set(d, 2.0F), MulAdd(e.trace * e.trace, Set(d, -1.0F / 3.0F), e.twice_deviator));
  const V I1 = squares + MulAdd(e.trace, Set(d, 2.0F), Set(d, 3.0F));
  const V x = Min(Max(N / I1, Set(d, 0.0F)), Set(d, 1.0F));
  return IfThenElse(Gt(j, Set(d, -1.0F)), x, Set(d, 1.0F));
}

/// A law's argument x, and y = g² (‖dev ε‖² + (K/2μ) t²) with g ≥ ‖∂x/∂ε‖: the square of what the law's slope
/// is multiplied by in the bound of the tangent (element/local_stiffness.h, its two equal halves taken at
/// the larger one, so that no lane needs a root).
template <class V>
struct Measured {
  V x, y;
};

template <class D, class V>
HWY_INLINE V strain_bound_squared(D d, const Invariants<V>& e, float bulk_over_two_mu) {
  return MulAdd(e.trace * e.trace, Set(d, bulk_over_two_mu), e.twice_deviator * Set(d, 0.5F));
}

template <class D, class V>
HWY_INLINE Measured<V> measure_intensity(D d, const Invariants<V>& e, float bulk_over_two_mu) {
  return {Sqrt(one_minus_q(d, e) * Set(d, 1.5F)), strain_bound_squared(d, e, bulk_over_two_mu)};
}

template <class D, class V>
HWY_INLINE Measured<V> measure_one_minus_q(D d, const Invariants<V>& e, float bulk_over_two_mu) {
  const V p = one_minus_q(d, e);
  return {p, p * Set(d, 8.0F / 3.0F) * strain_bound_squared(d, e, bulk_over_two_mu)};  // g² = (4 s/3)², s² = 3p/2
}

/// The paper's raw mean ratio 12 (3V)^⅔ / Σ l², from the deformed edges: with e_a = d_a + u_a the three edges
/// from the origin, Σ l² over six edges is 4 Σ |e_a|² − |Σ e_a|². Rest edges d_a follow from the gradients:
/// d₁ = (s₂ × s₃) / (s₁ · s₂ × s₃). Tets that are not there (all gradients 0) give x = 0, and y = −1: x = 0
/// would be the largest deformation of all.
template <class D, class V>
HWY_INLINE Measured<V> measure_regular_mean_ratio(D d, const Gradient<V>& g, const Invariants<V>& e, const V (&s)[3][3],
                                                  float bulk_over_two_mu) {
  const auto cross = [&](std::size_t a, std::size_t b, std::size_t i) {
    const std::size_t k = (i + 1) % 3, l = (i + 2) % 3;
    return NegMulAdd(s[a][l], s[b][k], s[a][k] * s[b][l]);
  };
  V area[3][3], sum[3], squares = Set(d, 0.0F);
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t i = 0; i < 3; ++i) area[a][i] = cross((a + 1) % 3, (a + 2) % 3, i);
  }
  const V det = MulAdd(s[0][0], area[0][0], MulAdd(s[0][1], area[0][1], s[0][2] * area[0][2]));
  const auto present = Gt(Abs(det), Set(d, 0.0F));
  const V scale = Set(d, 1.0F) / IfThenElse(present, det, Set(d, 1.0F));
  for (std::size_t i = 0; i < 3; ++i) {
    sum[i] = Set(d, 0.0F);
    for (std::size_t a = 0; a < 3; ++a) {
      const V* A = area[a];
      const V edge = scale * (A[i] + MulAdd(g.h[i][0], A[0], MulAdd(g.h[i][1], A[1], g.h[i][2] * A[2])));
      sum[i] = sum[i] + edge;
      squares = MulAdd(edge, edge, squares);
    }
  }
  const V total = squares * Set(d, 4.0F) - MulAdd(sum[0], sum[0], MulAdd(sum[1], sum[1], sum[2] * sum[2]));
  // 3 V = |J| / (2 det S)
  const V J = e.volume_change + Set(d, 1.0F);
  const V volume = Max(J * Abs(scale) * Set(d, 0.5F), Set(d, 1e-36F));
  const V root = inverse_cube_root(d, volume) * volume;  // (3V)^⅔ = (3V · (3V)^(−⅓))
  const V ratio = Set(d, 12.0F) * root / Max(total, Set(d, 1e-30F));
  const V x = IfThenElse(Gt(J, Set(d, 0.0F)), Min(ratio, Set(d, 1.0F)), Set(d, 0.0F));
  const V y = x * x * Set(d, 1.64F * 1.64F) * strain_bound_squared(d, e, bulk_over_two_mu);
  return {IfThenElse(present, x, Set(d, 0.0F)), IfThenElse(present, y, Set(d, -1.0F))};
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_ELEMENT_MATH_INL_H_
