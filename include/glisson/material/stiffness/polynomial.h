// polynomial.h — the modulus as a polynomial of the measure.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "glisson/field.h"
#include "glisson/material/scalar.h"

namespace glisson {

/// M(x) = M₀ + c₁ x + c₂ x² + …, kept at 0 where it would be negative.
struct PolynomialLaw {
  std::vector<double> coefficients;  ///< c₁, c₂, … [Pa]

  static constexpr std::string_view kName = "polynomial";
  static constexpr std::string_view kHelp = "M(x) = M₀ + c₁ x + c₂ x² + … (not below 0)";
  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("coefficients", &PolynomialLaw::coefficients, "Pa", "c₁, c₂, …").must());
  }

  /// M₀, c₁, c₂, …
  std::vector<double> numbers(double base) const {
    std::vector<double> c{base};
    c.insert(c.end(), coefficients.begin(), coefficients.end());
    return c;
  }
  template <class C, class T>
  static ValueSlope<T> at(const C& numbers, T x);
  std::string check() const {
    return coefficients.empty() ? "`coefficients_Pa` needs at least one number" : std::string{};
  }

  bool operator==(const PolynomialLaw&) const = default;
};

}  // namespace glisson
