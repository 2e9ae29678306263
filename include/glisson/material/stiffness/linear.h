// linear.h — the paper's tissue 2: the modulus grows in proportion to the measure.
#pragma once

#include <array>
#include <string_view>

#include "glisson/field.h"
#include "glisson/material/scalar.h"

namespace glisson {

/// M(x) = M₀ + slope · x, kept at 0 where a negative slope would make it negative.
/// With the intensity s as argument the force grows close to second order, [Schwartz2002, fig. 2].
struct LinearLaw {
  double slope = 0.0;  ///< dM/dx [Pa]

  static constexpr std::string_view kName = "linear";
  static constexpr std::string_view kHelp = "M(x) = M₀ + slope · x (not below 0): tissue 2 of the paper";
  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("slope", &LinearLaw::slope, "Pa", "growth of the modulus per unit of the argument").must());
  }

  /// M₀, slope
  std::array<double, 2> numbers(double base) const { return {base, slope}; }
  template <class C, class T>
  static ValueSlope<T> at(const C& numbers, T x);

  bool operator==(const LinearLaw&) const = default;
};

}  // namespace glisson
