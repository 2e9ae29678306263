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

/// Tets whose centroid lies in the box or ball of a region; empty where the region names one of the mesh.
std::vector<std::size_t> tets_within(const TetMesh& mesh, const RegionSpec& region);

/// `x 0 to 0.04 m, y …, z …`: the body, for messages about selections that miss it.
std::string extent_text(const TetMesh& mesh);

/// What is wrong with the name of a vertex set that is not among the known ones.
std::string no_such_set(const std::string& name, std::span<const std::string> known);

/// Number of the region that a name or number means, in a mesh that has it; −1 where it has not.
int region_number(const TetMesh& mesh, const std::string& name);

}  // namespace glisson::scene
