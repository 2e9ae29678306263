// repeated_tets.h — tets that have the same four vertices.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "glisson/mesh.h"

namespace glisson::detail {

/// Calls `visit(first, again)` for every tet that has the same four vertices as an earlier one, with the earliest of these.
/// @param vertices  number of them, above every vertex of a tet
/// Cost: two passes over the tets and a sort of a few dozen per vertex; 20 bytes a tet.
void for_each_repeated_tet(std::span<const Tet> tets, std::size_t vertices,
                           const std::function<void(std::uint32_t first, std::uint32_t again)>& visit);

}  // namespace glisson::detail
