// hyperelastic_formulas.h — the energies of the hyperelastic laws, without κ/2 (J − 1)², and their slopes.
//
// Written once, as those of the laws of stiffness are (stiffness_formulas.h). i1 = Ī₁ − 3, i2 = Ī₂ − 3; Ogden's law takes
// the logarithms l of the isochoric stretches. The slopes of a law of the invariants run on vectors of lanes too.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "glisson/material/hyperelastic_law.h"

namespace glisson {

template <class T>
inline T NeoHookean::energy(T i1, T /*i2*/) const {
  return T(0.5 * mu) * i1;
}

template <class T>
GLISSON_FORMULA InvariantSlopes<T> NeoHookean::slopes(T /*i1*/, T /*i2*/) const {
  return {T(0.5 * mu), T(0), T(0)};
}

template <class T>
inline T MooneyRivlin::energy(T i1, T i2) const {
  return T(c10) * i1 + T(c01) * i2;
}

template <class T>
GLISSON_FORMULA InvariantSlopes<T> MooneyRivlin::slopes(T /*i1*/, T /*i2*/) const {
  return {T(c10), T(c01), T(0)};
}

template <class T>
inline T Yeoh::energy(T i1, T /*i2*/) const {
  return i1 * (T(c1) + i1 * (T(c2) + i1 * T(c3)));
}

template <class T>
GLISSON_FORMULA InvariantSlopes<T> Yeoh::slopes(T i1, T /*i2*/) const {
  using namespace scalar;
  const T two_c2(2.0 * c2), three_c3 = T(3) * T(c3);
  return {mul_add(i1, mul_add(i1, three_c3, two_c2), T(c1)), T(0), mul_add(i1, three_c3 + three_c3, two_c2)};
}

/// e^x − 1, along its tangent beyond `most`.
template <class T>
inline T limited_expm1(T x, double most) {
  using std::exp, std::expm1;
  const T inside = x < T(most) ? x : T(most);
  return expm1(inside) + exp(inside) * (x - inside);
}

template <class T>
inline T Fung::energy(T i1, T /*i2*/) const {
  return T(0.5 * mu / b) * limited_expm1(T(b) * i1, kLargestExponent);
}

template <class T>
GLISSON_FORMULA InvariantSlopes<T> Fung::slopes(T i1, T /*i2*/) const {
  using namespace scalar;
  const T most(kLargestExponent), e = T(b) * i1, w = T(0.5 * mu) * exp(min(e, most));
  return {w, T(0), select(e < most, w * T(b), T(0))};
}

template <class T>
inline T VerondaWestmann::energy(T i1, T i2) const {
  return T(c) * limited_expm1(T(b) * i1, kLargestExponent) - T(0.5 * c * b) * i2;
}

template <class T>
GLISSON_FORMULA InvariantSlopes<T> VerondaWestmann::slopes(T i1, T /*i2*/) const {
  using namespace scalar;
  const T most(kLargestExponent), e = T(b) * i1, w = T(c * b) * exp(min(e, most));
  return {w, T(-0.5 * c * b), select(e < most, w * T(b), T(0))};
}

template <class T>
inline T Gent::energy(T i1, T /*i2*/) const {
  using std::log1p;
  const T x = i1 * T(1.0 / limit), end(1.0 - kLeast);
  const T inside = x < end ? x : end, beyond = (x - inside) * T(1.0 / kLeast);
  return T(0.5 * mu * limit) * (beyond * (T(1.0) + T(0.5) * beyond) - log1p(-inside));
}

template <class T>
GLISSON_FORMULA InvariantSlopes<T> Gent::slopes(T i1, T /*i2*/) const {
  using namespace scalar;
  const T left = mul_add(T(-1.0 / limit), i1, T(1)), held = max(left, T(kLeast));
  const T longer = T(1) / held, w = T(0.5 * mu) * longer;
  return {mul_add(w * longer, held - left, w), T(0), w * longer * T(1.0 / limit)};
}

namespace detail {

/// The slope and the bend of a/(2 b) (e^{b x} − 1), added to those of other terms.
template <class T>
GLISSON_FORMULA void add_exponential(double a, double b, T x, T& slope, T& bend) {
  using namespace scalar;
  const T most(Invariants::kLargestExponent), e = T(b) * x, w = T(0.5 * a) * exp(min(e, most));
  slope = slope + w;
  bend = bend + select(e < most, w * T(b), T(0));
}
/// Of q/(2 r) (e^{r x²} − 1).
template <class T>
GLISSON_FORMULA void add_square_exponential(double q, double r, T x, T& slope, T& bend) {
  using namespace scalar;
  const T end(std::sqrt(Invariants::kLargestExponent / r)), inside = max(min(x, end), -end);
  const T e = T(r) * inside * inside, w = T(q) * exp(e);
  slope = mul_add(w, inside, slope);
  bend = bend + select(x * x < end * end, mul_add(w + w, e, w), T(0));
}
/// a/(2 b) (e^{b x} − 1).
template <class T>
inline T exponential_energy(double a, double b, T x) {
  return T(0.5 * a / b) * limited_expm1(T(b) * x, Invariants::kLargestExponent);
}
/// q/(2 r) (e^{r x²} − 1).
template <class T>
inline T square_exponential_energy(double q, double r, T x) {
  using std::exp, std::expm1;
  const double end = std::sqrt(Invariants::kLargestExponent / r);
  const T inside = scalar::max(scalar::min(x, T(end)), T(-end)), e = T(r) * inside * inside;
  return T(0.5 * q / r) * expm1(e) + T(q) * inside * exp(e) * (x - inside);
}

}  // namespace detail

template <class T>
inline T Invariants::energy(T i1, T i2) const {
  T W = i1 * (T(c10) + T(c11) * i2 + i1 * (T(c20) + i1 * T(c30))) + i2 * (T(c01) + T(c02) * i2);
  W += detail::exponential_energy(a1, b1, i1) + detail::exponential_energy(a2, b2, i2);
  return W + detail::square_exponential_energy(q1, r1, i1) + detail::square_exponential_energy(q2, r2, i2);
}

template <class T>
GLISSON_FORMULA InvariantSlopes<T> Invariants::slopes(T i1, T i2) const {
  using namespace scalar;
  const T mixed(c11), two_c20(2.0 * c20), two_c02(2.0 * c02), three_c30(3.0 * c30);
  T first = mul_add(i1, mul_add(i1, three_c30, two_c20), mul_add(mixed, i2, T(c10)));
  T second = mul_add(two_c02, i2, mul_add(mixed, i1, T(c01)));
  T bend = mul_add(i1, three_c30 + three_c30, two_c20), second_bend = two_c02;
  if (a1 > 0.0) detail::add_exponential(a1, b1, i1, first, bend);
  if (a2 > 0.0) detail::add_exponential(a2, b2, i2, second, second_bend);
  if (q1 > 0.0) detail::add_square_exponential(q1, r1, i1, first, bend);
  if (q2 > 0.0) detail::add_square_exponential(q2, r2, i2, second, second_bend);
  return {first, second, bend, mixed, second_bend};
}

template <class T>
inline T Ogden::growth(double a, T l) {
  using std::expm1;
  const T e = T(a) * l;
  return expm1(e < T(kLargestExponent) ? e : T(kLargestExponent));
}

template <class T>
inline T Ogden::energy(const std::array<T, 3>& l) const {
  T sum(0.0);
  for (std::size_t k = 0; k < mu.size(); ++k) {
    const T powers = growth(alpha[k], l[0]) + growth(alpha[k], l[1]) + growth(alpha[k], l[2]);
    sum += T(2.0 * mu[k] / (alpha[k] * alpha[k])) * powers;
  }
  return sum;
}

template <class T>
inline std::array<T, 3> Ogden::slopes(const std::array<T, 3>& l) const {
  std::array<T, 3> out{T(0.0), T(0.0), T(0.0)};
  for (std::size_t k = 0; k < mu.size(); ++k) {
    const std::array<T, 3> g{growth(alpha[k], l[0]), growth(alpha[k], l[1]), growth(alpha[k], l[2])};
    const T mean = (g[0] + g[1] + g[2]) * T(1.0 / 3.0);
    for (std::size_t i = 0; i < 3; ++i) out[i] += T(2.0 * mu[k] / alpha[k]) * (g[i] - mean);
  }
  return out;
}

}  // namespace glisson
