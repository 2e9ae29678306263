// partition.h — which tetrahedra make a submesh: the unit of threads, of precision and of change.
//
// Every submesh keeps its own copy of its vertices, and a vertex that two submeshes hold is summed between
// them, so a good split has few vertices held twice: compact parts with smooth borders. Two steps:
//
//   1. Bisection: a range of tets is cut across the direction in which its centroids spread most, in the
//      proportion of the parts left and right, until one part is left. Sizes are exact, shapes are boxes.
//   2. Star moves (star_moves.h): where borders are jagged, all tets that a part has at a vertex change to
//      another part if that saves copies.
//
//        ┌──┬─┬──────┐        ┌───┬───────┐
//        │ A└┐└┐  B  │        │ A  \  B   │
//        ├───┴─┼──┬──┤   →    ├─────\──┬──┤
//        │  C  └┐ │ D│        │  C   ) │ D│
//        └──────┴─┴──┘        └────────┴──┘
//
// A graph partitioner (METIS) holds as many copies, from 2.4 % more to 2.6 % fewer on boxes, a cylinder and a
// liver; it would add a dependency, and its result may change with its version.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "glisson/mesh.h"

namespace glisson::detail {

/// A split of tets into submeshes: part p holds tets[begin[p]] … tets[begin[p + 1] − 1], neighbours close together.
struct TetPartition {
  std::vector<std::uint32_t> tets;
  std::vector<std::size_t> begin;  ///< one more than parts

  std::size_t parts() const { return begin.size() - 1; }
  std::span<const std::uint32_t> part(std::size_t p) const {
    return std::span(tets).subspan(begin[p], begin[p + 1] - begin[p]);
  }
};

/// How far the size of a part may be from the mean of all parts, as a share of it; beyond that one tet.
inline constexpr double kPartSlack = 0.03;

/// Splits the chosen tets into ⌈chosen / target_tets⌉ parts of nearly the same size, none above
/// (1 + kPartSlack) target_tets + 1. The same set of tets gives the same split, in whatever order it is listed.
/// @param vertices     rest positions of the whole mesh [m]
/// @param tets         all tets of the mesh; only the chosen ones are looked at
/// @param chosen       which tets to split, none twice
/// @param target_tets  size aimed at, 1 or more
/// @throws std::invalid_argument if target_tets is 0
/// Cost: O(n log n), about 1 s for a million tets on one core.
TetPartition partition_tets(std::span<const Vec3d> vertices, std::span<const Tet> tets,
                            std::span<const std::uint32_t> chosen, std::size_t target_tets);

}  // namespace glisson::detail
