// cut_crossing.h — where and when a blade's edge passes through an edge of a mesh while both move.
//
//        from ●━━━━━━━━━━━━● to        blade, from one step to the next
//              ╲    at
//           low ●───×───────● high     edge of the mesh, likewise
//
// The ends of both move uniformly in between, so that what one step leaves out of reach the next begins with, and a cut
// made in many steps has no gaps, however the body moves.
#pragma once

#include <optional>

#include "glisson/math.h"

namespace glisson::detail {

/// A segment whose ends move uniformly from one place to another.
struct MovingSegment {
  std::array<Vec3d, 2> before;  ///< at time 0 [m]
  std::array<Vec3d, 2> after;   ///< at time 1 [m]
};

struct Crossing {
  double time = 0.0;  ///< within the step, 0 … 1
  double at = 0.0;    ///< on the edge, 0 … 1
};

/// The first time at which two segments meet: the first root of (b − a)·((q − p) × (p − a)) = 0, a cubic in time, at
/// which the point is on both. None where they stay apart, or parallel.
std::optional<Crossing> first_crossing(const MovingSegment& blade, const MovingSegment& edge);

}  // namespace glisson::detail
