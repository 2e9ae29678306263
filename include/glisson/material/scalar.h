// scalar.h — the operations in which a law is written, so that one formula serves a number, a number with a derivative
// (src/material/dual.h) and a vector of lanes (src/engine/kernels/lane_scalar-inl.h).
//
//   + − * /   <  >  >=   select(choice, yes, no)   min  max   mul_add(a, b, c) = a b + c   exp  expm1  log   T(constant)
//
// A formula does not branch on its argument: lanes compute both sides and select. mul_add marks where a vector rounds once.
#pragma once

#include <cmath>
#include <concepts>

/// Precedes each formula. Otherwise the compiler would emit a function for the oldest processor, which cannot take the
/// vectors of a newer one.
#define GLISSON_FORMULA [[gnu::always_inline]] inline

namespace glisson {

/// A function and its derivative.
template <class T>
struct ValueSlope {
  T value, slope;
};

/// How W of a law of the invariants depends on Ī₂: not at all, in proportion, W = w(Ī₁ − 3) + c (Ī₂ − 3), or in any way. A law
/// states it as `kSecond`; lanes do not compute what it does not need.
enum class SecondInvariant { none, proportional, general };

/// Slopes of W(Ī₁, Ī₂) [Pa].
template <class T>
struct InvariantSlopes {
  T first, second;       ///< ∂W/∂Ī₁, ∂W/∂Ī₂
  T bend;                ///< ∂²W/∂Ī₁²
  T mixed = T(0);        ///< ∂²W/∂Ī₁∂Ī₂, 0 unless the law is `general`
  T second_bend = T(0);  ///< ∂²W/∂Ī₂², likewise
};

namespace scalar {

using std::exp, std::expm1, std::log;

/// Scalars that compare to true or false; lanes have their own overloads.
template <class T>
concept Single = requires(T a) {
  { a < a } -> std::same_as<bool>;  // NOLINT(misc-redundant-expression)
};

template <Single T>
constexpr T mul_add(T a, T b, T c) {
  return a * b + c;
}
template <Single T>
constexpr T select(bool choice, T yes, T no) {
  return choice ? yes : no;
}
template <Single T>
constexpr T min(T a, T b) {
  return a < b ? a : b;
}
template <Single T>
constexpr T max(T a, T b) {
  return a > b ? a : b;
}

/// Clamps a modulus to 0 from below, with slope 0 there.
template <class T>
GLISSON_FORMULA constexpr ValueSlope<T> not_below_zero(T value, T slope) {
  const auto positive = value > T(0);
  return {select(positive, value, T(0)), select(positive, slope, T(0))};
}

}  // namespace scalar
}  // namespace glisson
