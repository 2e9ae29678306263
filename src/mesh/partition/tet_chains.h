// tet_chains.h — which tetrahedra are evaluated together because they share faces.
//
// Three tets in a row, each with a face in common with the next, have six vertices between them. Gathered once
// for all, that is six loads and six stores of a vertex instead of twelve: half the data movement for the same
// arithmetic. There is one shape of such a chain only, since two faces of a tet always have an edge in common:
//
//          2───────0───────5        end:    0 1 2 4
//         ╱ ╲     ╱│╲     ╱         middle: 0 1 2 3      (seen along the edge 0–1; 1 is below 0)
//        ╱   ╲   ╱ │ ╲   ╱          end:    0 1 3 5
//       4─────(0 1)───3
//
// Every tet may be in one chain only, and a chain of one or two costs as much as one of three: what is wanted
// is a cover of the graph of face neighbours by as few such chains as possible.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "glisson/mesh.h"
#include "mesh/topology/face_neighbours.h"

namespace glisson::detail {

/// A tet and up to two neighbours of it across different faces; kNoTet where there is none, the first end being
/// there if the second is. Numbers are positions in the given list.
struct TetChain {
  std::uint32_t middle = kNoTet;
  std::array<std::uint32_t, 2> ends{kNoTet, kNoTet};
  bool operator==(const TetChain&) const = default;
  std::size_t size() const { return (middle != kNoTet) + (ends[0] != kNoTet) + (ends[1] != kNoTet); }
};

/// Covers the list by nearly as few chains as can be: loose ends first, as Karp and Sipser match, then tets left
/// over are handed on from chain to chain until they meet. Every tet is in exactly one chain; chains ascend by the
/// smallest tet of each. Tets next to each other in a chain share exactly three vertices: two copies of one tet are
/// none. The same list gives the same chains. A face of more than two tets joins its tets two by two.
/// Cost: O(n log n), about 0.6 µs a tet on lists of some thousand.
std::vector<TetChain> chain_tets(std::span<const Tet> tets);

}  // namespace glisson::detail
