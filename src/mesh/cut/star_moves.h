// star_moves.h — straightens the borders between the parts of a partition.
//
// Moving one tet across a border rarely saves a vertex copy by itself: a vertex on the border has several
// tets on either side, and all of them must leave a part before its copy can go. So the move tried is the
// smallest one that takes a copy away: all tets that part A has at vertex v change to part B, which holds v too.
// Parts with more than half of the tets at v are not asked to give it up.
//
//         B │ B                 Saved: the copy of v in A, and that of any other vertex whose tets in A all move.
//       ────v────   → B         Added: a copy in B of each vertex of the moved tets that B does not hold yet.
//        ╲ A│A ╱                A move is made if it saves copies, or saves none and shortens the border:
//         ╲ │ ╱                 Σ over vertices and parts of (tets of the part at the vertex)² grows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "glisson/mesh.h"

namespace glisson::detail {

/// Lowers the number of vertex copies, Σ over parts of the vertices they hold, by moves that keep sizes in bounds.
/// @param tets   four vertex numbers each, below `vertices`; neighbours close together in the list for speed
/// @param part   part of each tet, below `parts`; changed
/// @param slack  part sizes stay within ± slack of their mean and one tet
/// Cost: a few sweeps over all vertices, about 0.7 µs a tet.
void move_stars(std::span<const Tet> tets, std::size_t vertices, std::size_t parts, double slack,
                std::vector<std::uint32_t>& part);

}  // namespace glisson::detail
