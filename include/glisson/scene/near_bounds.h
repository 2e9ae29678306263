// near_bounds.h — whether a set or region of a scene hangs on rounding: what lies just within its bounds, and just outside.
#pragma once

#include <cstddef>

#include "glisson/mesh.h"
#include "glisson/scene/variant.h"

namespace glisson {

/// What of a selection by a box, ball or side hangs on where exactly its bounds are; all 0 for other selections.
struct NearBounds {
  std::size_t inside = 0;        ///< vertices, or centroids of tets, that belong to it
  std::size_t by_rounding = 0;   ///< of these: outside of the bounds as typed, by less than the tolerance
  std::size_t just_outside = 0;  ///< that do not belong to it, but lie outside by less than 1000 tolerances
  double farthest = 0.0;         ///< of those from the bounds [m]
  double tolerance = 0.0;        ///< [m]
};

/// Counts the vertices about the bounds of a set.
NearBounds near_bounds(const TetMesh& mesh, const Selection& selection);
/// Counts the centroids of tets about the bounds of a region.
NearBounds near_bounds(const TetMesh& mesh, const RegionSpec& region);

}  // namespace glisson
