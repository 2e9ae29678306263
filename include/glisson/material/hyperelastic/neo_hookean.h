// neo_hookean.h — rubber at its simplest: one modulus, stresses linear in stretch squared.
#pragma once

#include <string_view>

#include "glisson/material/hyperelastic/bulk_modulus.h"
#include "glisson/material/scalar.h"

namespace glisson {

/// W = μ/2 (Ī₁ − 3) + κ/2 (J − 1)²
struct NeoHookean {
  double mu = 1285.714;       ///< μ [Pa]
  double bulk_modulus = 0.0;  ///< κ [Pa]

  static constexpr std::string_view kName = "neo_hookean";
  static constexpr std::string_view kHelp = "W = μ/2 (Ī₁ − 3) + κ/2 (J − 1)²";
  static constexpr SecondInvariant kSecond = SecondInvariant::none;
  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("mu", &NeoHookean::mu, "Pa", at_least(kSmallestModulus), "μ, shear modulus at rest").must(),
                bulk_modulus_field<NeoHookean>());
  }

  double shear_modulus() const { return mu; }
  template <class T>
  T energy(T i1, T i2) const;
  template <class T>
  InvariantSlopes<T> slopes(T i1, T i2) const;

  bool operator==(const NeoHookean&) const = default;
};

}  // namespace glisson
