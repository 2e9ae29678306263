// veronda_westmann.h — the exponential law of skin, much used for abdominal organs and breast.
#pragma once

#include <cmath>
#include <string_view>

#include "glisson/material/hyperelastic/bulk_modulus.h"
#include "glisson/material/scalar.h"

namespace glisson {

/// W = c (e^{b (Ī₁ − 3)} − 1) − ½ c b (Ī₂ − 3) + κ/2 (J − 1)²,  μ = c b     [VerondaWestmann1970]
/// Beyond an exponent of 12, 1.6·10⁵ times as stiff as at rest, W goes on along its tangent: tets that are crushed or
/// scrambled find back, and sums of forces keep their digits (docs/integrators.md, "Far from rest").
struct VerondaWestmann {
  double c = 0.0, b = 0.0;    ///< [Pa], [-]
  double bulk_modulus = 0.0;  ///< κ [Pa]

  static constexpr std::string_view kName = "veronda_westmann";
  static constexpr std::string_view kHelp =
      "W = c (exp(b (Ī₁ − 3)) − 1) − ½ c b (Ī₂ − 3) + κ/2 (J − 1)², μ = c b (exponent at most 12)";
  static constexpr double kLargestExponent = 12.0;
  static constexpr SecondInvariant kSecond = SecondInvariant::proportional;
  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("c", &VerondaWestmann::c, "Pa", at_least(kSmallestModulus), "c").must(),
                field("b", &VerondaWestmann::b, "-", between(1e-6, 1000), "b, rate of stiffening").must(),
                bulk_modulus_field<VerondaWestmann>());
  }

  double shear_modulus() const { return c * b; }
  template <class T>
  T energy(T i1, T i2) const;
  template <class T>
  InvariantSlopes<T> slopes(T i1, T i2) const;

  bool operator==(const VerondaWestmann&) const = default;
};

}  // namespace glisson
