// capsule_surface.h — the triangles a capsule lies on, and how they follow the mesh.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "glisson/instruments/capsule.h"

namespace glisson {

/// A face of a tet: the one opposite its corner.
struct TetFace {
  std::uint32_t tet = 0;
  std::uint8_t corner = 0;
};

/// Faces at the surface of the body that the options choose, in the order of the tets.
/// @throws std::invalid_argument for triangles that are not at the surface, or where none is left
std::vector<TetFace> capsule_faces(const CapsuleOptions& options, const BodyView& body);

/// Vertices of a face, outward oriented.
Triangle corners_of(const TetMesh& mesh, const TetFace& face);

/// A point on a triangle.
struct PointOnTriangle {
  std::size_t triangle = 0;
  std::array<double, 3> weights{};  ///< of its corners, sum 1
  double distance = 0.0;            ///< [m]
};

/// The point nearest to a place, of those triangles that `counts` says 1 for.
/// @param triangles  over `positions` [m] @param first  one that is looked at first: the nearer it is, the quicker
PointOnTriangle nearest_point(std::span<const Triangle> triangles, std::span<const Vec3d> positions,
                              std::span<const char> counts, const Vec3d& place, std::size_t first = 0);

/// Squared distance of a place from the box about a triangle: not above that from the triangle [m²].
double squared_distance_of_box(const std::array<Vec3d, 3>& corners, const Vec3d& place);

/// Area that a disc about the origin shares with a triangle in its plane [m²].
double overlap_with_disc(const std::array<std::array<double, 2>, 3>& triangle, double radius);

/// Which triangles lie within a distance of which, by their centres, and on
/// the same side of the body: those of t are list[first[t]] … list[first[t+1]−1].
struct Neighbours {
  std::vector<std::uint32_t> first, list;
};
Neighbours find_neighbours(std::span<const Triangle> triangles, std::span<const Vec3d> positions, double distance);

}  // namespace glisson
