// faces.h — which tetrahedra meet at which face.
#pragma once

#include <algorithm>
#include <functional>
#include <span>
#include <vector>

#include "glisson/mesh.h"

namespace glisson::detail {

/// Corners of a tet's face opposite its corner i, outward oriented for a positively oriented tet.
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> kFaceCorners{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// Whether a tet has the vertex among its corners.
inline bool holds(const Tet& tet, std::uint32_t vertex) {
  return std::find(tet.begin(), tet.end(), vertex) != tet.end();
}

/// One side of a face: the tet and its corner opposite to it.
struct FaceSide {
  std::uint32_t middle = 0, highest = 0;  ///< the two larger of the face's three vertex numbers
  std::uint32_t tet = 0;
  std::uint8_t corner = 0;
};

/// Calls `visit` once for every face with all its sides: one at the boundary, two inside, more if not manifold.
/// @param skipped  one flag per tet to leave out; empty: none
/// Cost: two passes over the faces and a sort of a few dozen sides per vertex; 16 bytes a side.
void for_each_face(const TetMesh& mesh, const std::vector<bool>& skipped,
                   const std::function<void(std::span<const FaceSide>)>& visit);

}  // namespace glisson::detail
