// linear_law.h — the linear law that a tissue comes to where its deformation is small and slow: what adaptive precision
// (glisson/simulation/precision.h) takes in its place.
#pragma once

#include "glisson/material/tissue.h"

namespace glisson {

/// Whether the body may go by a tissue's linear law in places: where it is another one, isotropic, of the element's own volume
/// change, with a viscosity that is there at rest, too, and with branches only in small strain and of constant times.
bool has_linear_law(const Tissue& tissue);

/// λ, μ at rest, once the branches have relaxed [Pa].
LameParameters relaxed_lame(const Tissue& tissue);

/// A tissue of these moduli, with the viscosity and density of the original and nothing else.
Tissue linear_law(const Tissue& tissue);

}  // namespace glisson
