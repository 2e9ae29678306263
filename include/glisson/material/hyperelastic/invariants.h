// invariants.h — a sum of terms of both invariants: Rivlin's polynomial to the second order and the usual exponentials.
//
// Many laws of the literature are a few of these terms: a model is what is not 0. Lanes skip an exponential whose modulus
// is 0, so that a short sum costs what its own law would.
#pragma once

#include <string>
#include <string_view>

#include "glisson/material/hyperelastic/bulk_modulus.h"
#include "glisson/material/scalar.h"

namespace glisson {

/// With x₁ = Ī₁ − 3 and x₂ = Ī₂ − 3
///
///   W = c₁₀ x₁ + c₀₁ x₂ + c₂₀ x₁² + c₁₁ x₁ x₂ + c₀₂ x₂² + c₃₀ x₁³                      [RivlinSaunders1951]
///     + Σ_k a_k/(2 b_k) (e^{b_k x_k} − 1) + q_k/(2 r_k) (e^{r_k x_k²} − 1), k = 1, 2     [LinkaKuhl2023]
///     + κ/2 (J − 1)²,                     μ = 2 (c₁₀ + c₀₁) + a₁ + a₂
///
/// Beyond an exponent of 12 an exponential goes on along its tangent in x_k, as Fung's does (fung.h).
struct Invariants {
  double c10 = 0.0, c01 = 0.0, c20 = 0.0, c11 = 0.0, c02 = 0.0, c30 = 0.0;  ///< [Pa]
  double a1 = 0.0, b1 = 1.0, a2 = 0.0, b2 = 1.0;                            ///< [Pa], [-]
  double q1 = 0.0, r1 = 1.0, q2 = 0.0, r2 = 1.0;                            ///< [Pa], [-]
  double bulk_modulus = 0.0;                                                ///< κ [Pa]

  static constexpr std::string_view kName = "invariants";
  static constexpr std::string_view kHelp =
      "W = c₁₀ x₁ + c₀₁ x₂ + c₂₀ x₁² + c₁₁ x₁ x₂ + c₀₂ x₂² + c₃₀ x₁³ + Σ [ aₖ/(2 bₖ) (exp(bₖ xₖ) − 1) + "
      "qₖ/(2 rₖ) (exp(rₖ xₖ²) − 1) ] + κ/2 (J − 1)², xₖ = Īₖ − 3, μ = 2 (c₁₀ + c₀₁) + a₁ + a₂ (exponents at most 12)";
  static constexpr double kLargestExponent = 12.0;
  static constexpr SecondInvariant kSecond = SecondInvariant::general;
  template <class Take>
  static constexpr auto fields(Take take) {
    using I = Invariants;
    constexpr Range rate = between(1e-6, 1000);
    return take(field("c10", &I::c10, "Pa", "c₁₀, of x₁"), field("c01", &I::c01, "Pa", "c₀₁, of x₂"),
                field("c20", &I::c20, "Pa", "c₂₀, of x₁²"), field("c11", &I::c11, "Pa", "c₁₁, of x₁ x₂"),
                field("c02", &I::c02, "Pa", "c₀₂, of x₂²"), field("c30", &I::c30, "Pa", "c₃₀, of x₁³"),
                field("a1", &I::a1, "Pa", at_least(0), "a₁, of the exponential of x₁: its shear modulus"),
                field("b1", &I::b1, "-", rate, "b₁, its rate of stiffening"),
                field("a2", &I::a2, "Pa", at_least(0), "a₂, of the exponential of x₂: its shear modulus"),
                field("b2", &I::b2, "-", rate, "b₂, its rate of stiffening"),
                field("q1", &I::q1, "Pa", at_least(0), "q₁, of the exponential of x₁²; at first as c₂₀ = ½ q₁"),
                field("r1", &I::r1, "-", rate, "r₁, its rate of stiffening"),
                field("q2", &I::q2, "Pa", at_least(0), "q₂, of the exponential of x₂²; at first as c₀₂ = ½ q₂"),
                field("r2", &I::r2, "-", rate, "r₂, its rate of stiffening"), bulk_modulus_field<I>());
  }

  double shear_modulus() const { return 2.0 * (c10 + c01) + a1 + a2; }
  template <class T>
  T energy(T i1, T i2) const;
  template <class T>
  InvariantSlopes<T> slopes(T i1, T i2) const;
  std::string check() const {
    return shear_modulus() > 0.0 ? "" : "2 (c10 + c01) + a1 + a2 must be above 0, it is the shear modulus at rest";
  }

  bool operator==(const Invariants&) const = default;
};

}  // namespace glisson
