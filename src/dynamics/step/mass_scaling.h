// mass_scaling.h — which tets keep the step short, and more mass for just those.
//
// h* is never below the smallest of the elements' own bounds: M = Σ M_e and K = Σ K_e, so that with M_e f_e in the place of
// M_e an element's bound is the root of (k h² + 2 c h)/f = 4. The least f that reaches a step h is (k h² + 2 c h)/4.
#pragma once

#include <cstddef>
#include <vector>

#include "element/body.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

/// Adds to the mass of elements whose own bound is below `step`, until it is that.
/// @param viscosity  factor on C, 1 for the explicit scheme, 0 where viscosity does not limit the step
MassScaling scale_masses(Body& body, double step, double viscosity);

/// What the options ask for, before anything else asks for masses.
MassScaling scaled_masses(Body& body, const SimulationOptions& options);

/// The elements with the smallest bounds, smallest first, at rest stiffness.
std::vector<LimitingTet> limiting_tets(const Body& body, std::size_t most, double viscosity);

}  // namespace glisson
