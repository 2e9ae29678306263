// layer_mesh.h — the meridian of a layer under an indenter: elements that are small where it touches and grow away from there.
//
//   ───╲___╱───────── surface     Even ones under a sphere or a cone; under a flat punch smaller ones towards its edge, where
//   │││││││ │  │    │              pressure is singular. A half-space ends a thousand radii of contact away, a wide layer
//   ├┼┼┼┼┼┼─┼──┼────┤              where its thickness has damped everything.
//   └┴┴┴┴┴┴─┴──┴────┘ floor
#pragma once

#include <memory>

#include "lab/indenter.h"
#include "lab/meridian_mesh.h"

namespace glisson::lab {

/// @param deepest  of all depths to come [m] @param fineness  1 or more: as many times smaller elements
std::shared_ptr<const MeridianMesh> layer_mesh(const Layer& layer, const Indenter& indenter, double deepest,
                                               double fineness);

}  // namespace glisson::lab
