// gent.h — rubber whose chains have an end: the stress grows without bound at a finite stretch.
#pragma once

#include <string_view>

#include "glisson/material/hyperelastic/bulk_modulus.h"
#include "glisson/material/scalar.h"

namespace glisson {

/// W = −½ μ J_m ln(1 − (Ī₁ − 3)/J_m) + κ/2 (J − 1)²     [Gent1996]
/// Where less than a hundredth of the chains' length is left, 100 times the slope and 10⁴ times the curvature of rest, W goes on
/// as a parabola, and P as straight as it had become: tets that are crushed or scrambled find back, and no lane holds a
/// logarithm of what is below 0. Along its tangent, as an exponential law goes on (docs/integrators.md, "Far from rest"), it
/// would lose nearly all of its stiffness at once, and a step that had been short enough would not be after the next.
struct Gent {
  double mu = 0.0, limit = 0.0;  ///< μ [Pa], J_m [-]
  double bulk_modulus = 0.0;     ///< κ [Pa]

  static constexpr std::string_view kName = "gent";
  static constexpr std::string_view kHelp =
      "W = −½ μ Jₘ ln(1 − (Ī₁ − 3)/Jₘ) + κ/2 (J − 1)² (a parabola where 1 − (Ī₁ − 3)/Jₘ is below 0.01)";
  static constexpr double kLeast = 1e-2;  ///< of 1 − (Ī₁ − 3)/J_m for the logarithm
  static constexpr SecondInvariant kSecond = SecondInvariant::none;
  template <class Take>
  static constexpr auto fields(Take take) {
    return take(
        field("mu", &Gent::mu, "Pa", at_least(kSmallestModulus), "μ, shear modulus at rest").must(),
        field("limit", &Gent::limit, "-", between(1e-3, 1e6), "Jₘ, the Ī₁ − 3 at which chains are stretched out")
            .must(),
        bulk_modulus_field<Gent>());
  }

  double shear_modulus() const { return mu; }
  template <class T>
  T energy(T i1, T i2) const;
  template <class T>
  InvariantSlopes<T> slopes(T i1, T i2) const;

  bool operator==(const Gent&) const = default;
};

}  // namespace glisson
