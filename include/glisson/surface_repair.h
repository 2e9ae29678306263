// surface_repair.h — surfaces of triangles as segmentations, scanners and drawings leave them: points that should be one, triangles that
// are there twice, holes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "glisson/mesh.h"

namespace glisson {

/// A surface that closes, and what was done to it. One that closed before is as it was.
struct SurfaceRepair {
  std::vector<Vec3d> points;        ///< those given [m]
  std::vector<Triangle> triangles;  ///< of these; corners at the same place are one point

  struct Hole {
    Vec3d middle{};         ///< of the points around it [m]
    std::size_t edges = 0;  ///< around it
    double share = 0.0;     ///< area of its lid over that of the surface
  };
  std::vector<Vec3d> welded;   ///< points that became another one nearby [m]
  double farthest_weld = 0.0;  ///< of these from it [m]
  std::vector<Vec3d> doubled;  ///< middles of triangles that were left out, because another one has their corners [m]
  std::vector<Hole> holes;     ///< that were closed, the largest first

  bool any() const { return !welded.empty() || !doubled.empty() || !holes.empty(); }
  /// What was done, in numbers and places: a sentence without its subject; empty where nothing was.
  std::string text() const;
};

/// The largest hole that is closed, as a share of the surface's area.
inline constexpr double kLargestHole = 0.05;

/// Closes a surface of triangles, in this order, where its edges do not match:
///   points on open edges that lie within 1 % of the median edge, and a tenth of their own shortest edge, become one;
///   of triangles with the same three corners the one stays that fits its neighbours, or none of two that bound nothing;
///   a hole gets a lid of least area on the loop around it. On a plane loop that is where the winding number of the open surface, which
///   tells inside from outside, passes a half [Jacobson2013]; on others it is near it.
/// Triangles that turn against their neighbours and sheets within the body stay, and surface_solid refuses them.
/// @param points  [m] @throws std::invalid_argument as surface_solid for points and triangles; for a hole above kLargestHole, with its share,
///   its edges and its place
SurfaceRepair repair_surface(std::span<const Vec3d> points, std::span<const Triangle> triangles);

}  // namespace glisson
