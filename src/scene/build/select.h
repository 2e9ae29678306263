// select.h — vertices and tets picked by where they are at rest.
//
// Places on a bound belong to the selection, whatever rounding makes of them: up to detail::place_tolerance beyond it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "glisson/scene/scene.h"

namespace glisson::scene {

/// Sorted vertex numbers of a selection.
/// @throws SceneError where nothing is selected, a vertex does not exist, or there are fewer than asked for
std::vector<std::uint32_t> select_vertices(const TetMesh& mesh, const std::string& name, const Selection& selection);

/// What of a selection by a box, ball or side hangs on where exactly its bounds are; all 0 for other selections.
struct NearBounds {
  std::size_t inside = 0;        ///< vertices, or centroids of tets, that belong to it
  std::size_t by_rounding = 0;   ///< of these: outside of the bounds as typed, by less than the tolerance
  std::size_t just_outside = 0;  ///< that do not belong to it, but lie outside by less than 1000 tolerances
  double farthest = 0.0;         ///< of those from the bounds [m]
  double tolerance = 0.0;        ///< [m]
};
NearBounds near_bounds(const TetMesh& mesh, const Selection& selection);
NearBounds near_bounds(const TetMesh& mesh, const RegionSpec& region);

/// Tets whose centroid lies in the box or ball of a region; empty where the region names one of the mesh.
std::vector<std::size_t> tets_within(const TetMesh& mesh, const RegionSpec& region);

/// `x 0 to 0.04 m, y …, z …`: the body, for messages about selections that miss it.
std::string extent_text(const TetMesh& mesh);

/// What is wrong with the name of a vertex set that is not among the known ones.
std::string no_such_set(const std::string& name, std::span<const std::string> known);

/// Number of the region that a name or number means, in a mesh that has it; −1 where it has not.
int region_number(const TetMesh& mesh, const std::string& name);

}  // namespace glisson::scene
