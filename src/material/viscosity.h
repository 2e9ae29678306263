// viscosity.h — the viscous tensor as a pair of Lamé-like coefficients.
//
// Each candidate for [Schwartz2002, eq. 7] is isotropic, so σ_v = a tr(ε̇) I + 2 b ε̇ with two constants:
//   shear          a = 0             b = η
//   deviatoric     a = −⅔ η          b = η
//   proportional   a = (η/E) λ       b = (η/E) μ
//   pioletti       a = 0             b = η, both times I₁ − 3 of the present shape
#pragma once

#include "glisson/material/tissue.h"

namespace glisson {

/// The pair (a, b) [Pa·s], in the places of (λ, μ).
inline LameParameters viscous_coefficients(const Tissue& tissue) {
  const double eta = tissue.viscosity;
  const LameParameters lame = tissue.lame();
  switch (tissue.viscous_tensor) {
    case ViscousTensor::shear:
    case ViscousTensor::pioletti:
      return {0.0, eta};
    case ViscousTensor::deviatoric:
      return {-2.0 / 3.0 * eta, eta};
    case ViscousTensor::proportional:
      break;
  }
  return {eta / tissue.youngs_modulus * lame.lambda, eta / tissue.youngs_modulus * lame.mu};
}

}  // namespace glisson
