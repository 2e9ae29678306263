// oscillation.h — the complex modulus of a tissue, as a rheometer measures it in a small oscillation.
//
//   const std::vector<double> frequencies{0.1, 1.0, 10.0};
//   for (const ComplexModulus& g : oscillation(tissue, frequencies)) …  g.storage, g.loss
//
// The stress of a material point (material_point.h) is linearised exactly about a static state, so there is no amplitude and
// no step to choose. What large amplitudes add is left to material_test.
#pragma once

#include <span>
#include <vector>

#include "glisson/material/tissue.h"

namespace glisson {

/// G′ + i G″ of a stress that oscillates as the real part of e^(iωt).
struct ComplexModulus {
  double storage = 0.0;  ///< in phase with the strain [Pa]
  double loss = 0.0;     ///< in phase with its rate [Pa]

  double magnitude() const;     ///< √(storage² + loss²) [Pa]
  double loss_tangent() const;  ///< loss over storage [-]
};

/// How a specimen oscillates. z is its axis.
enum class OscillationMode { simple_shear, uniaxial };
template <>
inline constexpr Word<OscillationMode> kWords<OscillationMode>[] = {
    {"simple_shear", OscillationMode::simple_shear, "x moves with z, all else is held: G*"},
    {"uniaxial", OscillationMode::uniaxial, "z moves, the sides are free: E*"}};

/// Complex modulus of a small oscillation about a static stretch λ along z, with free sides and all branches relaxed.
///
///   G* = dσ_xz/dγ = λ/(ab) dP_xz/dF_xz,   E* = λ/(ab) dP_zz/dF_zz,   a, b the stretches of the sides
///   dP = dP_elastic − dF Σ g_k S − F Σ g_k dS/(1 + iωτ_k) + iω P_viscous(dF)
///
/// γ and the strain of E* are on the present height, the force is on the area at λ. Kinematics `small` does not distinguish lengths: dP/dF
/// itself. At rest, where s has no derivative, a stiffness law counts with its modulus at 0.
/// @param frequencies  [Hz], ≥ 0; 0 gives the relaxed modulus
/// @param stretch      λ [-], > 0
/// @return one modulus per frequency
/// @throws std::invalid_argument as MaterialPoint, for a frequency or stretch out of range, or a stretch at which no free sides
///         are found
std::vector<ComplexModulus> oscillation(const Tissue& tissue, std::span<const double> frequencies, double stretch = 1.0,
                                        OscillationMode mode = OscillationMode::simple_shear);

}  // namespace glisson
