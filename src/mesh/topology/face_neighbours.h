// face_neighbours.h — which tetrahedra of a list lie next to each other.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "glisson/mesh.h"

namespace glisson::detail {

inline constexpr std::uint32_t kNoTet = ~0u;

/// Positions in the list across the face opposite each corner, or kNoTet.
using Neighbours = std::array<std::uint32_t, 4>;

/// Neighbours of each tet of the list: tets on the two sides of a face, by the order of their corners. Two copies of one tet
/// are none, nor are two that lie on the same side; a face of more than two tets joins those two by two that can be.
/// Cost: O(n log n).
std::vector<Neighbours> face_neighbours(std::span<const Tet> tets);

}  // namespace glisson::detail
