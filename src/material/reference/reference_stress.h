// reference_stress.h — the executable specification of the tissue laws: textbook formulas of F, one after the other.
//
//   invariants      I₁ = tr C, I₂ = ½ (I₁² − tr C²), J = det F, ∂J/∂F = J F⁻ᵀ
//   polar           F = R U from the singular values, the smallest taken negative where F is inverted
//   laws            W of each law's own paper, written out anew
//
// Nothing is rearranged against cancellation; long double pays for that (19 digits on x86). It shares no code with
// src/material, which is tested against it.
#pragma once

#include <Eigen/Dense>

#include "glisson/material/tissue.h"

namespace glisson::reference {

using Real = long double;
using RealTensor = Eigen::Matrix<Real, 3, 3>;
using RealVector = Eigen::Matrix<Real, 3, 1>;

/// One point of tissue: what it is made of and how its tetrahedron lay at rest.
struct MaterialPoint {
  Tissue tissue;
  std::array<RealVector, 4> rest;         ///< corners [m]
  RealVector fibre = RealVector::Zero();  ///< a, |a| = 1
};

/// W of a law of the invariants at Ī₁ − 3 and Ī₂ − 3, and its slopes by them [J/m³]; 0 for one of stretches.
struct InvariantEnergy {
  Real W = 0, first = 0, second = 0;
};
InvariantEnergy invariant_energy(const HyperelasticLaw& law, Real first_excess, Real second_excess);

/// W of the elastic part [J/m³]; of a secant law ½ σ:ε.
Real stored_energy(const MaterialPoint& point, const RealTensor& F);
/// P of the elastic part [Pa].
RealTensor piola(const MaterialPoint& point, const RealTensor& F);
/// P of Kelvin–Voigt at the rate Ḟ [Pa]: σ_v(ε̇) of small strain, else F S_v(Ė).
RealTensor viscous_piola(const MaterialPoint& point, const RealTensor& F, const RealTensor& rate);
/// The second Piola–Kirchhoff stress of which Maxwell branches relax their shares [Pa]: S = F⁻¹P, or its part without
/// pressure, S − ⅓ (S:C) C⁻¹. Of small strain σ and its deviator.
RealTensor relaxing_stress(const MaterialPoint& point, const RealTensor& F);
/// The rotation that brings a regular tetrahedron, corners (1,1,1), (−1,1,−1), (1,−1,−1), (−1,−1,1), closest to the rest
/// one: U Vᵀ of the map between them.
RealTensor regular_turn(const MaterialPoint& point);
/// Value of the tissue's measure, from the tetrahedron's corners.
Real shape_measure(const MaterialPoint& point, const RealTensor& F);

/// Rate 1/τ(x) at which a branch relaxes at a deformation [1/s].
Real pace(const MaterialPoint& point, std::size_t branch, const RealTensor& F);

/// Relaxed stress of a Maxwell branch after a time t of S(t) = S₁ t [Pa for S₁ = 1 Pa/s]:
///   q = ∫ e^(−(t−s)/τ)/τ S(s) ds = t − τ (1 − e^(−t/τ)).
double relaxed_ramp(double t, double time);
/// The same of S(t) = sin ωt: q = [ sin ωt − ωτ cos ωt + ωτ e^(−t/τ) ] / (1 + ω²τ²).
double relaxed_sine(double t, double time, double omega);

}  // namespace glisson::reference
