// body_lattice.h — the body-centred cubic lattice around a body: what the mesher starts from.
#pragma once

#include "mesher/lattice/region_fields.h"
#include "mesher/lattice/size_field.h"
#include "mesher/lattice/tet_complex.h"

namespace glisson::lattice {

/// Mean length of the lattice's edges over the side of its cubes: 8 edges of √3/2 and 6 of 1 leave each vertex.
inline constexpr double kMeanEdge = 0.9234;

/// Largest side of the cubes for a mean edge.
inline double cube_side(double edge) { return edge / kMeanEdge; }

/// Tets that a body of this volume gets: 12 a cube.
inline double expected_tets(double volume, double edge) {
  const double side = cube_side(edge);
  return 12.0 * volume / (side * side * side);
}

/// Refuses an edge that is far too short for a body of this extent [m]. @throws std::invalid_argument
[[noreturn]] void refuse_short_edge(double edge, double extent);
/// Refuses more tets than are allowed, or than there is memory for. @throws std::invalid_argument
/// @param coarsest, finest  edges asked for [m]
void refuse_too_many(double coarsest, double finest, double tets, std::size_t max_tets);
/// Refuses them where they are not counted to the end. @throws std::invalid_argument
[[noreturn]] void refuse_more_than(double coarsest, double finest, std::size_t max_tets);

/// All lattice tets with a corner in a region, undecided.
/// @throws std::invalid_argument  more than max_tets, or a lattice that is too large
void fill_lattice(const RegionFields& fields, std::size_t max_tets, TetComplex& complex);

}  // namespace glisson::lattice
