// body_places.h — places of a scene that are found from the body at rest, so that they fit any.
#pragma once

#include <optional>

#include "glisson/pose.h"
#include "glisson/scene/scene.h"

namespace glisson {

/// A point of the body [m]: the given one, or the middle of the volume of a region or of the whole body.
/// @throws std::invalid_argument naming a region that is not there, or has no tet
Vec3d body_point(const TetMesh& mesh, const BodyPoint& at);

/// Where a line through a point of the body first meets the surface, coming from outside.
/// @param direction  of the line, of any length @throws std::invalid_argument as body_point, and where the line misses the body
Vec3d facing_point(const TetMesh& mesh, const BodyPoint& at, const Vec3d& direction);

/// Where the tip of an instrument with an aim starts. @param pose  its axes
/// @throws std::invalid_argument as facing_point; for a tip that would start inside the body, with the distance that would do
Vec3d aimed_tip(const InstrumentSpec& instrument, const Pose& pose, const TetMesh& mesh);

/// How the body at rest lies to the path of an instrument.
struct PathMeeting {
  bool meets = false;
  double beside = 0.0;  ///< how far the instrument's tip stays from the surface where it does not meet it [m]
};
/// Whether an instrument meets the body at rest by a time; none where its path depends on the force on it.
std::optional<PathMeeting> meets_body(const InstrumentSpec& instrument, const TetMesh& mesh, double until);

}  // namespace glisson
