// exponential.h — toe and steep rise of collagenous tissue.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "glisson/material/stiffness/law_field.h"

namespace glisson {

/// M(x) = M₀ + A (e^{b x} − 1), kept at 0 where it would be negative. The exponent is limited to 60, so
/// that an inverted tetrahedron cannot make the modulus infinite.
struct ExponentialLaw {
  double amplitude = 0.0;  ///< A [Pa]
  double rate = 0.0;       ///< b, per unit of the measure [-]

  static constexpr std::string_view kName = "exponential";
  static constexpr std::string_view kHelp = "M(x) = M₀ + A (exp(b x) − 1) (not below 0, exponent at most 60)";
  static constexpr double kLargestExponent = 60.0;
  static constexpr std::array<LawField<ExponentialLaw>, 2> kFields{
      {{.key = "amplitude_Pa", .member = &ExponentialLaw::amplitude, .unit = "Pa", .help = "A"},
       {.key = "rate",
        .member = &ExponentialLaw::rate,
        .unit = "-",
        .min = 0.0,
        .max = 1000.0,
        .help = "b, growth per unit of the argument"}}};

  template <class T>
  T value(T base, T x) const {
    using std::expm1;
    const T m = base + T(amplitude) * expm1(exponent(x));
    return m > T(0) ? m : T(0);
  }
  template <class T>
  T derivative(T base, T x) const {
    if (T(rate) * x > T(kLargestExponent) || !(value(base, x) > T(0))) return T(0);
    using std::exp;
    return T(amplitude) * T(rate) * exp(exponent(x));
  }
  std::string check() const { return {}; }

  bool operator==(const ExponentialLaw&) const = default;

 private:
  template <class T>
  T exponent(T x) const {
    const T e = T(rate) * x;
    return e < T(kLargestExponent) ? e : T(kLargestExponent);
  }
};

}  // namespace glisson
