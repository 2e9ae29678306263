// nearest_point.h — the surface near a point, and how near to a bound a place still lies on it.
#pragma once

#include "glisson/mesh.h"

namespace glisson::detail {

/// How far from a bound a place still lies on it [m]: 1e-9 of the diagonal of box_of. Typed decimals and computed coordinates that
/// mean the same place differ by rounding, of some 1e-16 of it; vertices that mean other places are farther apart than 1e-9.
double place_tolerance(const TetMesh& mesh);

/// The point of a triangle nearest to x.
Vec3d nearest_on_triangle(const Vec3d& x, const Vec3d& a, const Vec3d& b, const Vec3d& c);

/// The point of the surface nearest to x. Cost: a pass over the surface.
Vec3d nearest_point(const TetMesh& mesh, const Vec3d& x);

}  // namespace glisson::detail
