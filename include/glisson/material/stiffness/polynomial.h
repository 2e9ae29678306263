// polynomial.h — the modulus as a polynomial of the measure.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "glisson/material/stiffness/law_field.h"

namespace glisson {

/// M(x) = M₀ + c₁ x + c₂ x² + …, kept at 0 where it would be negative.
struct PolynomialLaw {
  std::vector<double> coefficients;  ///< c₁, c₂, … [Pa]

  static constexpr std::string_view kName = "polynomial";
  static constexpr std::string_view kHelp = "M(x) = M₀ + c₁ x + c₂ x² + … (not below 0)";
  static constexpr std::array<LawField<PolynomialLaw>, 1> kFields{
      {{.key = "coefficients_Pa", .member = &PolynomialLaw::coefficients, .unit = "Pa", .help = "c₁, c₂, …"}}};

  template <class T>
  T value(T base, T x) const {
    const T m = raw(base, x);
    return m > T(0) ? m : T(0);
  }
  template <class T>
  T derivative(T base, T x) const {
    if (!(raw(base, x) > T(0))) return T(0);
    T d(0);
    for (std::size_t i = coefficients.size(); i-- > 0;) d = d * x + T(i + 1) * T(coefficients[i]);
    return d;
  }
  std::string check() const {
    return coefficients.empty() ? "`coefficients_Pa` needs at least one number" : std::string{};
  }

  bool operator==(const PolynomialLaw&) const = default;

 private:
  template <class T>
  T raw(T base, T x) const {
    T sum(0);
    for (std::size_t i = coefficients.size(); i-- > 0;) sum = (sum + T(coefficients[i])) * x;
    return base + sum;
  }
};

}  // namespace glisson
