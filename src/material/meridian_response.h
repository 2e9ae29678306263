// meridian_response.h — the stress of a hyperelastic tissue that deforms alike about an axis, with its tangent.
//
//       | F_rr  F_rz   0  |        P and ∂P/∂F in the order rr, rz, zr, zz, θθ; the isochoric part of the law alone:
//   F = | F_zr  F_zz   0  |        a mixed element adds the pressure of its own volume change, p ∂J/∂F.
//       |  0     0    F_θθ|
//
// With F = U diag(λ₁, λ₂) Vᵀ in the meridian and λ₃ = F_θθ, P = U diag(w₁, w₂) Vᵀ and P_θθ = w₃, w_i = ∂W/∂λ_i. The law
// enters by its slopes alone, as in hyperelastic_response.h, whose general way takes ten times as long.
#pragma once

#include <array>

#include "glisson/material/hyperelastic_law.h"

namespace glisson {

/// In the order rr, rz, zr, zz, θθ.
using MeridianTensor = std::array<double, 5>;

struct MeridianStress {
  MeridianTensor P{};                       ///< [Pa]
  std::array<MeridianTensor, 5> tangent{};  ///< ∂P/∂F [Pa], symmetric
};

/// @param F  with det > 0 and F_θθ > 0
MeridianStress isochoric_stress(const HyperelasticLaw& law, const MeridianTensor& F);

}  // namespace glisson
