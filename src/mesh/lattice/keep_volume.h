// keep_volume.h — moves vertices off curved surfaces by so much that the regions keep their volumes.
#pragma once

#include "mesh/lattice/workspace.h"

namespace glisson::lattice {

/// Flat faces with all vertices on a ball lie inside it: a volume 1.5 % too small at ten edges across. Each vertex of a smooth
/// surface moves along its normal by the mean distance of the middles of its edges from the surface, which makes the error
/// of a face that of fourth order. No tet falls below `floor` by that.
void keep_volume(Workspace& w, double floor);

}  // namespace glisson::lattice
