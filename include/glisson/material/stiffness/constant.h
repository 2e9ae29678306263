// constant.h — the linear tissue: the modulus does not depend on deformation.
#pragma once

#include <array>
#include <string_view>

#include "glisson/field.h"
#include "glisson/material/scalar.h"

namespace glisson {

/// M(x) = M₀.
struct ConstantLaw {
  static constexpr std::string_view kName = "constant";
  static constexpr std::string_view kHelp = "M(x) = M₀: a linear tissue";
  template <class Take>
  static constexpr auto fields(Take take) {
    return take();
  }

  /// M₀
  std::array<double, 1> numbers(double base) const { return {base}; }
  template <class C, class T>
  static ValueSlope<T> at(const C& numbers, T x);

  bool operator==(const ConstantLaw&) const = default;
};

}  // namespace glisson
