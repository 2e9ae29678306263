// graded_lattice.h — a lattice whose cubes are smaller where smaller edges are asked for.
#pragma once

#include "mesher/lattice/region_fields.h"
#include "mesher/lattice/size_field.h"
#include "mesher/lattice/tet_complex.h"

namespace glisson::lattice {

/// All tets of the lattice with a corner in a region, undecided. Edges are those asked for to a factor of √2, the finest
/// exactly; a vertex's is the mean length of the lattice's edges there.
/// @throws std::invalid_argument  more than max_tets, more than there is memory for, or a lattice that is too large
void fill_graded_lattice(const RegionFields& fields, const SizeField& sizes, std::size_t max_tets, TetComplex& complex);

}  // namespace glisson::lattice
