// tissue.h — what a tissue is: elasticity, its law against deformation, viscosity, density.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "glisson/stiffness_law.h"

namespace glisson {

/// The number of a tetrahedron that a stiffness law takes as its argument.
enum class DeformationMeasure {
  intensity,          ///< s = √(3 (1 − q) / 2), 0 at rest, ≈ ‖dev ε‖
  one_minus_q,        ///< 1 − q(F), 0 at rest, ≈ ⅔ ‖dev ε‖²
  regular_mean_ratio  ///< 12 (3V)^⅔ / Σ l² of the deformed tet; the paper's raw measure, mesh-dependent at rest
};

/// Which constant tensor carries the viscosity η, [Schwartz2002, eq. 7] (the paper leaves it open).
enum class ViscousTensor {
  shear,        ///< σ_v = 2 η ε̇
  deviatoric,   ///< σ_v = 2 η dev ε̇
  proportional  ///< (η/E) × the elastic tensor at rest
};

/// λ and μ of linear elasticity [Pa].
struct LameParameters {
  double lambda = 0.0, mu = 0.0;
};

/// λ = E ν / ((1 + ν)(1 − 2ν)), μ = E / (2 (1 + ν)).
LameParameters lame_from_young(double youngs_modulus, double poisson_ratio);

/// A tissue: isotropic elasticity whose moduli may follow the local deformation, Kelvin–Voigt viscosity.
///
/// Either `law` acts on E with ν constant (so λ and μ scale alike), or `lambda_law` and `mu_law` act on
/// λ and μ apart. Each maps the base modulus and the measure to a modulus in Pa.
struct Tissue {
  std::string name = "tissue";
  double youngs_modulus = 3600.0;  ///< E at rest [Pa], > 0
  double poisson_ratio = 0.4;      ///< ν [-], −1 < ν < 0.5
  double density = 1000.0;         ///< ρ [kg/m³], > 0
  double viscosity = 0.0;          ///< η [Pa·s], ≥ 0
  ViscousTensor viscous_tensor = ViscousTensor::shear;
  DeformationMeasure measure = DeformationMeasure::intensity;
  StiffnessLaw law = ConstantLaw{};        ///< E(x)
  std::optional<StiffnessLaw> lambda_law;  ///< λ(x); with it or mu_law set, `law` must be constant
  std::optional<StiffnessLaw> mu_law;      ///< μ(x)

  LameParameters lame() const { return lame_from_young(youngs_modulus, poisson_ratio); }
};

/// @throws std::invalid_argument naming the field, its value and the allowed range
void require_valid(const Tissue& tissue);

/// λ and μ of a tissue at value `x` of its measure [Pa], [Schwartz2002, eq. 6].
LameParameters lame_at(const Tissue& tissue, double x);

}  // namespace glisson
