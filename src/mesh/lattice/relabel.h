// relabel.h — gives a thin tet at an interface to the region, or the void, on the other side.
#pragma once

#include "mesh/lattice/workspace.h"

namespace glisson::lattice {

/// A tet with two or three faces on one interface, flat enough that the interface stays within a tenth of an edge, takes the
/// label across; at the surface of the body it is removed. Masks of its vertices follow.
/// @return whether that was done
bool relabel(Workspace& w, std::uint32_t tet);

}  // namespace glisson::lattice
