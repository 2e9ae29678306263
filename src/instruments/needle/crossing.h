// crossing.h — what of a line lies in tissue: where it meets the surface of a body, and the stretches between.
//
//    hand ────────┤▒▒▒▒▒▒▒▒▒▒▒├──────────┤▒▒▒▒▒▒▒▒▒▒▒▒▒▶ tip
//               from          to        from           to
//             goes in     comes out    goes in
//
// Geometry alone: it knows of no force, no step and no needle. A cavity, a region left out and the gap to another piece are all the
// same to it: the line comes out at one triangle and goes in at another. Where it comes out and goes in at one place, as at the two
// faces of a closed cut, it stays in tissue.
//
// A needle asks for it three times (needle_path.cpp, needle_tip.cpp):
//
//    present positions   which surface the tip meets next
//    rest positions      where a path that grows comes out of the tissue
//    rest positions      what is left of a path when the body changes
//
// In between, the ends of each stretch are points of the tissue, which the path keeps: in the deformed body a stretch reaches from
// where the one is now to where the other is.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "glisson/instruments/needle.h"

namespace glisson {

/// Where a line meets a triangle of the surface.
struct SurfaceHit {
  double way = 0.0;      ///< along the line [m]
  Vec3d rest{};          ///< of the point met [m]
  bool goes_in = false;  ///< through the outside of the triangle; otherwise the line comes out there
};

/// Where a line from `from` meets an outward oriented triangle, from either side. Line and triangle at present, the answer at rest.
/// @param direction  of length 1
std::optional<SurfaceHit> meet(const Vec3d& from, const Vec3d& direction, const std::array<Vec3d, 3>& present,
                               const std::array<Vec3d, 3>& rest);

/// Sorts hits along the line. Triangles that share the edge or the corner that was met count once.
void put_in_order(std::vector<SurfaceHit>& hits);

/// The stretches of a line that lie in tissue, ascending.
/// @param hits    in order
/// @param length  of the line [m]
/// @param inside  whether it begins in tissue, or at its surface and goes in
std::vector<TissueInterval> find_intervals(std::span<const SurfaceHit> hits, double length, bool inside);

}  // namespace glisson
