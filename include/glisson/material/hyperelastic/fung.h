// fung.h — Fung's exponential in its isotropic form, as Demiray wrote it.
#pragma once

#include <cmath>
#include <string_view>

#include "glisson/material/hyperelastic/bulk_modulus.h"
#include "glisson/material/scalar.h"

namespace glisson {

/// W = μ/(2b) (e^{b (Ī₁ − 3)} − 1) + κ/2 (J − 1)²     [Demiray1972]
/// Beyond an exponent of 12, 1.6·10⁵ times as stiff as at rest, W goes on along its tangent: tets that are crushed or
/// scrambled find back, and sums of forces keep their digits (docs/integrators.md, "Far from rest").
struct Fung {
  double mu = 0.0, b = 0.0;   ///< [Pa], [-]
  double bulk_modulus = 0.0;  ///< κ [Pa]

  static constexpr std::string_view kName = "fung";
  static constexpr std::string_view kHelp = "W = μ/(2b) (exp(b (Ī₁ − 3)) − 1) + κ/2 (J − 1)² (exponent at most 12)";
  static constexpr double kLargestExponent = 12.0;
  static constexpr SecondInvariant kSecond = SecondInvariant::none;
  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("mu", &Fung::mu, "Pa", at_least(kSmallestModulus), "μ, shear modulus at rest").must(),
                field("b", &Fung::b, "-", between(1e-6, 1000), "b, rate of stiffening").must(),
                bulk_modulus_field<Fung>());
  }

  double shear_modulus() const { return mu; }
  template <class T>
  T energy(T i1, T i2) const;
  template <class T>
  InvariantSlopes<T> slopes(T i1, T i2) const;

  bool operator==(const Fung&) const = default;
};

}  // namespace glisson
