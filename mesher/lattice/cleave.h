// cleave.h — from lattice to labelled tets: one region after the other is cut out of what no earlier one took.
#pragma once

#include <functional>

#include "mesher/lattice/region_fields.h"
#include "mesher/lattice/tet_complex.h"

namespace glisson::lattice {

/// Gives every tet of the lattice its region and removes those outside and in holes; sets the vertices' masks.
void cleave(const RegionFields& fields, TetComplex& complex);

}  // namespace glisson::lattice
