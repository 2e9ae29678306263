// yeoh.h — a cubic in the first invariant: soft, then stiffening.
#pragma once

#include <string_view>

#include "glisson/material/hyperelastic/bulk_modulus.h"
#include "glisson/material/scalar.h"

namespace glisson {

/// W = c₁ (Ī₁ − 3) + c₂ (Ī₁ − 3)² + c₃ (Ī₁ − 3)³ + κ/2 (J − 1)²,  μ = 2 c₁
struct Yeoh {
  double c1 = 0.0, c2 = 0.0, c3 = 0.0;  ///< [Pa]
  double bulk_modulus = 0.0;            ///< κ [Pa]

  static constexpr std::string_view kName = "yeoh";
  static constexpr std::string_view kHelp = "W = c₁ (Ī₁ − 3) + c₂ (Ī₁ − 3)² + c₃ (Ī₁ − 3)³ + κ/2 (J − 1)², μ = 2 c₁";
  static constexpr SecondInvariant kSecond = SecondInvariant::none;
  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("c1", &Yeoh::c1, "Pa", at_least(kSmallestModulus), "c₁, half the shear modulus at rest").must(),
                field("c2", &Yeoh::c2, "Pa", "c₂"), field("c3", &Yeoh::c3, "Pa", "c₃"), bulk_modulus_field<Yeoh>());
  }

  double shear_modulus() const { return 2.0 * c1; }
  template <class T>
  T energy(T i1, T i2) const;
  template <class T>
  InvariantSlopes<T> slopes(T i1, T i2) const;

  bool operator==(const Yeoh&) const = default;
};

}  // namespace glisson
