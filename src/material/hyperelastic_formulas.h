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

template <class T>
inline T Fung::energy(T i1, T /*i2*/) const {
  using std::expm1;
  const T e = T(b) * i1;
  const double top = std::exp(kLargestExponent);
  const T growth = e < T(kLargestExponent) ? expm1(e) : T(top - 1.0) + T(top) * (e - T(kLargestExponent));
  return T(0.5 * mu / b) * growth;
}

template <class T>
GLISSON_FORMULA InvariantSlopes<T> Fung::slopes(T i1, T /*i2*/) const {
  using namespace scalar;
  const T most(kLargestExponent), e = T(b) * i1, w = T(0.5 * mu) * exp(min(e, most));
  return {w, T(0), select(e < most, w * T(b), T(0))};
}

template <class T>
inline T VerondaWestmann::energy(T i1, T i2) const {
  using std::expm1;
  const T e = T(b) * i1;
  const double top = std::exp(kLargestExponent);
  const T growth = e < T(kLargestExponent) ? expm1(e) : T(top - 1.0) + T(top) * (e - T(kLargestExponent));
  return T(c) * growth - T(0.5 * c * b) * i2;
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
