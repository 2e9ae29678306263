// curved_tets.h — tets of ten nodes, taken by their corners.
#pragma once

#include "io/raw_mesh.h"

namespace glisson::detail {

/// Nothing is lost where the middle nodes lie on straight edges. Elsewhere edges bulge, and the tet has the volume
///
///   V = ∫ det ∂x/∂ξ,   a cubic in ξ: five points integrate it exactly [Keast1986]
///
/// The report says how many such tets there were and what straight edges lose of the body's volume. Middle nodes that no tet has as a corner
/// are left out.
/// @param raw  its tets are those of the corners, coordinates scaled, indices checked
void take_corners(RawMesh& raw);

}  // namespace glisson::detail
