// faces.h — which tetrahedra meet at which face.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
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

/// The corner at which a tet has the vertex; 4 where it has not.
inline std::uint8_t corner_of(const Tet& tet, std::uint32_t vertex) {
  return static_cast<std::uint8_t>(std::find(tet.begin(), tet.end(), vertex) - tet.begin());
}

/// Half the cross product of a triangle's edges: area times normal [m²].
inline Vec3d area_vector(const std::array<Vec3d, 3>& x) { return cross(x[1] - x[0], x[2] - x[0]) * 0.5; }

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
