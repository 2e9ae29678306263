// dual.h — a number with its derivative in one direction: v + d ε, ε² = 0.
//
// The formulas of the tissue room are templates on their scalar. With this one they give ∂P/∂F : dF exactly, for
// every law and without a second set of formulas that could contradict the first; small strain has one for its speed
// (Response::small_tangent), which tests hold against the forces.
#pragma once

#include <cmath>

namespace glisson {

struct Dual {
  double v = 0.0, d = 0.0;

  constexpr Dual() = default;
  constexpr Dual(double value) : v(value) {}  // NOLINT(google-explicit-constructor): a constant is a dual
  constexpr Dual(double value, double derivative) : v(value), d(derivative) {}
  explicit constexpr operator double() const { return v; }

  friend constexpr Dual operator+(Dual a, Dual b) { return {a.v + b.v, a.d + b.d}; }
  friend constexpr Dual operator-(Dual a, Dual b) { return {a.v - b.v, a.d - b.d}; }
  friend constexpr Dual operator-(Dual a) { return {-a.v, -a.d}; }
  friend constexpr Dual operator*(Dual a, Dual b) { return {a.v * b.v, a.d * b.v + a.v * b.d}; }
  friend constexpr Dual operator/(Dual a, Dual b) {
    const double q = a.v / b.v;
    return {q, (a.d - q * b.d) / b.v};
  }
  constexpr Dual& operator+=(Dual b) { return *this = *this + b; }
  constexpr Dual& operator-=(Dual b) { return *this = *this - b; }
  constexpr Dual& operator*=(Dual b) { return *this = *this * b; }

  friend constexpr bool operator<(Dual a, Dual b) { return a.v < b.v; }
  friend constexpr bool operator>(Dual a, Dual b) { return a.v > b.v; }
  friend constexpr bool operator<=(Dual a, Dual b) { return a.v <= b.v; }
  friend constexpr bool operator>=(Dual a, Dual b) { return a.v >= b.v; }
};

/// The derivative at 0, where the root has none, is taken as 0: what stands behind it vanishes there.
inline Dual sqrt(Dual a) {
  const double r = std::sqrt(a.v);
  return {r, r > 0.0 ? 0.5 * a.d / r : 0.0};
}
inline Dual cbrt(Dual a) {
  const double r = std::cbrt(a.v);
  return {r, r != 0.0 ? a.d / (3.0 * r * r) : 0.0};
}
inline Dual exp(Dual a) {
  const double e = std::exp(a.v);
  return {e, e * a.d};
}
inline Dual expm1(Dual a) { return {std::expm1(a.v), std::exp(a.v) * a.d}; }
inline Dual log(Dual a) { return {std::log(a.v), a.d / a.v}; }
inline Dual log1p(Dual a) { return {std::log1p(a.v), a.d / (1.0 + a.v)}; }

/// The number without its derivative.
inline double value_of(double a) { return a; }
inline double value_of(Dual a) { return a.v; }

}  // namespace glisson
