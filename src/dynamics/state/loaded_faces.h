// loaded_faces.h — the faces of the body that a load acts on, and the forces of what is spread over them.
//
// A face is known by its element and the corner opposite to it: it keeps its place when the body is cut, and is gone with
// its element. Faces that a cut opens are none of a load's.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "element/body.h"
#include "glisson/simulation/surface_load.h"
#include "mesh/topology/faces.h"

namespace glisson {

struct LoadedFace {
  std::uint32_t element = 0;
  std::uint8_t opposite = 0;  ///< the element's corner that is not on it
};

/// Faces of the body's surface all corners of which are in the set, in the order of their elements.
std::vector<LoadedFace> spanned_faces(const Body& body, std::span<const std::uint32_t> set);

/// Corners of a face, outward oriented.
std::array<std::uint32_t, 3> corners_of(const Body& body, const LoadedFace& face);
inline bool is_there(const Body& body, const LoadedFace& face) { return body.rest[face.element].volume != 0.0; }

/// A triangle in space.
using Corners = std::array<Vec3d, 3>;
using detail::area_vector;

/// A traction that turns with its face, in parts that a face at rest gives it.
struct TurningTraction {
  /// @param traction  on the face at rest @param pressure  against its normal [Pa]
  TurningTraction(const Vec3d& traction, double pressure, const Corners& rest);

  double normal = 0.0;               ///< along the outward normal [Pa]
  double along = 0.0;                ///< size of the part in the face [Pa]
  double first = 0.0, second = 0.0;  ///< its direction, in the edges from corner 0 to 1 and 2

  /// On each corner [N].
  Vec3d force(const Corners& x) const;
  /// ∂force/∂x of each corner [N/m].
  std::array<Mat3d, 3> slope(const Corners& x) const;
  /// Sum over the corners of ‖∂force/∂x‖, from above [N/m].
  double stiffness(const Corners& x) const;
};

/// Traction α × (x − c) of a moment on some faces.
struct MomentTraction {
  /// @param faces  one or more, with some area
  MomentTraction(const Vec3d& moment, std::span<const Corners> faces);

  Vec3d alpha{}, centre{};

  /// On each corner [N].
  std::array<Vec3d, 3> forces(const Corners& x) const;
  /// Sum over the corners of ‖∂force/∂x‖ at fixed α and c, doubled: an estimate of the whole [N/m].
  double stiffness(const Corners& x) const;
};

}  // namespace glisson
