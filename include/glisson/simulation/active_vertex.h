// active_vertex.h — vertices that supports, motions or interactions act on or hold at rest, and the forces on them.
#pragma once

#include <cstdint>

#include "glisson/math.h"

namespace glisson {

/// An active vertex: one that a support, motion or interaction acts on.
struct ActiveVertex {
  std::uint32_t vertex = 0;
  Vec3d elastic, viscous;  ///< forces of the tissue at time t [N]
  Vec3d displacement;      ///< [m]
  Vec3d velocity;          ///< [m/s]
};

/// A vertex that an interaction holds still, see Interaction::rests().
struct RestingVertex {
  std::uint32_t vertex = 0;
  Vec3d force;  ///< of tissue and gravity on it at time t [N]
};

}  // namespace glisson
