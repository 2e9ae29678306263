// linear.h — the paper's tissue 2: the modulus grows in proportion to the measure.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "glisson/material/scalar.h"
#include "glisson/material/stiffness/law_field.h"

namespace glisson {

/// M(x) = M₀ + slope · x, kept at 0 where a negative slope would make it negative.
/// With the intensity s as argument the force grows close to second order, [Schwartz2002, fig. 2].
struct LinearLaw {
  double slope = 0.0;  ///< dM/dx [Pa]

  static constexpr std::string_view kName = "linear";
  static constexpr std::string_view kHelp = "M(x) = M₀ + slope · x (not below 0): tissue 2 of the paper";
  static constexpr std::array<LawField<LinearLaw>, 1> kFields{
      {{.key = "slope_Pa",
        .member = &LinearLaw::slope,
        .unit = "Pa",
        .help = "growth of the modulus per unit of the argument"}}};

  /// M₀, slope
  std::array<double, 2> numbers(double base) const { return {base, slope}; }
  template <class C, class T>
  GLISSON_FORMULA static ValueSlope<T> at(const C& c, T x) {
    using namespace scalar;
    const T k(c[1]);
    return not_below_zero(mul_add(k, x, T(c[0])), k);
  }
  std::string check() const { return {}; }

  bool operator==(const LinearLaw&) const = default;
};

}  // namespace glisson
