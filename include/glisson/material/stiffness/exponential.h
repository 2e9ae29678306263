// exponential.h — toe and steep rise of collagenous tissue.
#pragma once

#include <array>
#include <string_view>

#include "glisson/field.h"
#include "glisson/material/scalar.h"

namespace glisson {

/// M(x) = M₀ + A (e^{b x} − 1), kept at 0 where it would be negative. The exponent is limited to 60, so
/// that an inverted tetrahedron cannot make the modulus infinite.
struct ExponentialLaw {
  double amplitude = 0.0;  ///< A [Pa]
  double rate = 0.0;       ///< b, per unit of the measure [-]

  static constexpr std::string_view kName = "exponential";
  static constexpr std::string_view kHelp = "M(x) = M₀ + A (exp(b x) − 1) (not below 0, exponent at most 60)";
  static constexpr double kLargestExponent = 60.0;
  template <class Take>
  static constexpr auto fields(Take take) {
    return take(
        field("amplitude", &ExponentialLaw::amplitude, "Pa", "A").must(),
        field("rate", &ExponentialLaw::rate, "-", between(0, 1000), "b, growth per unit of the argument").must());
  }

  /// M₀, A, b
  std::array<double, 3> numbers(double base) const { return {base, amplitude, rate}; }
  template <class C, class T>
  static ValueSlope<T> at(const C& numbers, T x);

  bool operator==(const ExponentialLaw&) const = default;
};

}  // namespace glisson
