// surface_region.h — the body within a closed surface of triangles, such as a segmentation or a drawing gives.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "glisson/implicit.h"
#include "glisson/mesh.h"

namespace glisson {

/// A surface as a shape that combines with others: its distance is that to the nearest triangle, negative where the surface winds
/// about the point at least half once:
///
///   w(p) = Σ Ω(p) / 4π ≥ ½,   Ω the solid angle of a triangle                      [Jacobson2013; VanOosteromStrackee1983]
///
/// far triangles together by their sum of areas [Barill2018]. Parts of the surface may cross or touch each other: what any of them
/// winds about is inside. A surface whose normals point inward is taken as if they pointed outward. Points at the same place are one.
/// @param points  [m] @param triangles  of the points; those without area are left out
/// @throws std::invalid_argument  naming what is wrong: no triangles, a point that is not finite or not there, no volume within, and
///   edges at which the surface is open, non-manifold or its triangles turn against each other, how many and the place of the first
/// Cost of a distance: near the surface some 4.5 µs with 10 000 triangles, 7 µs with 80 000.
Solid surface_solid(std::span<const Vec3d> points, std::span<const Triangle> triangles);

/// The region within a surface, for mesh_regions. @throws as surface_solid, naming the region
BodyRegion surface_region(const std::string& name, std::span<const Vec3d> points, std::span<const Triangle> triangles);

}  // namespace glisson
