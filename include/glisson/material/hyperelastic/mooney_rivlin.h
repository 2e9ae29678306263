// mooney_rivlin.h — rubber whose stress depends on both invariants.
#pragma once

#include <string>
#include <string_view>

#include "glisson/material/hyperelastic/bulk_modulus.h"
#include "glisson/material/scalar.h"

namespace glisson {

/// W = c₁₀ (Ī₁ − 3) + c₀₁ (Ī₂ − 3) + κ/2 (J − 1)²,  μ = 2 (c₁₀ + c₀₁)
struct MooneyRivlin {
  double c10 = 0.0, c01 = 0.0;  ///< [Pa]
  double bulk_modulus = 0.0;    ///< κ [Pa]

  static constexpr std::string_view kName = "mooney_rivlin";
  static constexpr std::string_view kHelp = "W = c₁₀ (Ī₁ − 3) + c₀₁ (Ī₂ − 3) + κ/2 (J − 1)², μ = 2 (c₁₀ + c₀₁)";
  static constexpr SecondInvariant kSecond = SecondInvariant::proportional;
  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("c10", &MooneyRivlin::c10, "Pa", "c₁₀").must(),
                field("c01", &MooneyRivlin::c01, "Pa", "c₀₁").must(), bulk_modulus_field<MooneyRivlin>());
  }

  double shear_modulus() const { return 2.0 * (c10 + c01); }
  template <class T>
  T energy(T i1, T i2) const;
  template <class T>
  InvariantSlopes<T> slopes(T i1, T i2) const;
  std::string check() const {
    return c10 + c01 > 0.0 ? "" : "c10 + c01 must be above 0, it is half the shear modulus at rest";
  }

  bool operator==(const MooneyRivlin&) const = default;
};

}  // namespace glisson
