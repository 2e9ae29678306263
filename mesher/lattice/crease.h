// crease.h — edges of a region's own surface (of boxes, cylinders, differences): found, followed by mesh vertices, kept.
//
// A vertex on a crease lies on two sides of one surface. Each side is a direction into it, along the surface and away from the
// crease: the function a little way into the side is that of the side alone, and its planes there cross in the crease.
//
//        side A  ___________ c
//      p + δ a  ·           |            c: where the plane of A at p + δ a and the plane of B at p + δ b meet
//                           |· p + δ b
//                     side B|
#pragma once

#include "mesher/lattice/region_fields.h"

namespace glisson::lattice {

/// The two sides of a crease: unit vectors along the surface, away from it.
struct CreaseSides {
  Vec3d a{}, b{};
};

/// Planes of both sides at a point, unit normals.
struct CreasePlanes {
  Vec3d normal_a{}, normal_b{};
  double value_a = 0.0, value_b = 0.0;  ///< distance from the planes, at the point [m]
};

/// @param edge  length of edges asked for there [m]; also below
CreasePlanes crease_planes(const RegionFields& fields, std::size_t k, const Vec3d& p, double edge,
                           const CreaseSides& sides);

/// Moves p onto the crease; the sides turn with it. @return the distance left [m]
double project_to_crease(const RegionFields& fields, std::size_t k, Vec3d& p, double edge, CreaseSides& sides);

struct Workspace;

/// Draws vertices of interfaces onto creases, cuts edges of interfaces there, and draws vertices into corners.
/// @param floor  quality that this leaves the tets it changes, or what they had; 0: what can be improved
void follow_creases(Workspace& w, double floor = 0.0);

}  // namespace glisson::lattice
