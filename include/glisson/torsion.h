// torsion.h — a cylinder of tissue between two plates that turn against each other: torque and axial force.
//
//   const std::vector<double> times{1.0, 2.0}, twists{10.0, 20.0};                    20 rad/m: 0.2 of shear at a rim of 10 mm
//   for (const TorsionState& s : torsion(tissue, 0.01, times, twists)) …  s.torque, s.axial_force
//
// Each cylindrical shell is in simple shear (material_point.h), with a history of its own; the rim has the most of it.
#pragma once

#include <span>
#include <vector>

#include "glisson/field.h"
#include "glisson/material/tissue.h"

namespace glisson {

struct TorsionOptions {
  /// Static axial stretch λ [-], > 0: with free sides, and long enough before the twist for all branches to relax.
  double stretch = 1.0;
  std::size_t between = 1;  ///< steps from one time to the next, ≥ 1: more of them with viscosity or branches
  std::size_t radii = 12;   ///< Gauss points along the radius, 1 to 256: more of them for a law with a kink

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(no_key("stretch", &TorsionOptions::stretch, "-", above(0)),
                no_key("between", &TorsionOptions::between, at_least(1)),
                no_key("radii", &TorsionOptions::radii, glisson::between(1, 256)));
  }
};

struct TorsionState {
  double time = 0.0;         ///< [s]
  double twist = 0.0;        ///< φ, angle over length at rest [rad/m]
  double torque = 0.0;       ///< T [N m]
  double axial_force = 0.0;  ///< N [N]; below 0 the specimen pushes the plates apart
};

/// Torsion of a cylinder whose ends are bonded to plates at a fixed distance and whose side is free  [Rivlin1949].
///
///   F_θz = φ r,   T = 2π ∫ σ_θz r² dr,   N = π ∫ (2 σ_zz − σ_rr − σ_θθ) r dr,   r from 0 to the present radius
///
/// The radius changes with λ, not with the twist: the volume change that the twist brings is neglected. With γ the shear at the rim and
/// κ the bulk modulus the torque errs by a share of the order γ² μ/κ, and the part of N that grows with γ² by one of the order μ/κ: of a
/// compressible neo-Hookean cylinder that part is 3κ/(3κ + μ) of what is returned, to second order in γ. Kinematics `small` has none.
/// @param radius  R at rest [m], > 0
/// @param times   [s], ascending, as of material_test: from rest at time 0, a first time of 0 applies the first twist at once
/// @param twists  φ [rad/m], one per time; in between it changes linearly with time
/// @return one state per time
/// @throws std::invalid_argument as material_test, for an argument out of range, and for fibres that are not along z
/// Costs `radii` steps of a MaterialPoint for each step.
std::vector<TorsionState> torsion(const Tissue& tissue, double radius, std::span<const double> times,
                                  std::span<const double> twists, const TorsionOptions& options = {});

}  // namespace glisson
