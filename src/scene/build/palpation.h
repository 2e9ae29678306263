// palpation.h — the presses of a palpation: where its points are, where the tool meets the body at each, and when.
#pragma once

#include <optional>
#include <vector>

#include "glisson/instruments/contact.h"
#include "glisson/mesh.h"
#include "glisson/pose.h"
#include "glisson/scene/scene.h"

namespace glisson::scene {

/// Distance that a shape moves along a direction until it meets the surface of the body at rest; none where it misses it.
/// The surface is sampled at a tenth of each triangle's edges, so a round tool is late by less than (edge/10)²/(8 radius).
/// @param direction  a unit vector @return  [m]; 0 where it touches at the start; it must not start inside the body
std::optional<double> first_touch(const glisson::Shape& shape, const Pose& start, const Vec3d& direction,
                                  const TetMesh& mesh);

/// Displacements across the direction of a palpation's points, row by row, to and fro [m].
std::vector<Vec3d> palpation_points(const PalpationSpec& palpation, const Pose& start);

/// Its strokes: to a point at the clearance, down, up, and on to the next. The times do not depend on `touch`.
/// @param touch  distance along the direction to the first touch, one for each point [m]
StrokeMotion palpation_strokes(const PalpationSpec& palpation, const Pose& start, const Vec3d& direction,
                               const std::vector<double>& touch);

/// The touch of each point. @throws std::invalid_argument  naming the first point that misses the body or begins inside it, or
/// the instrument where it is none that presses in contact
std::vector<double> palpation_touches(const InstrumentSpec& instrument, const Pose& start, const Vec3d& direction,
                                      const TetMesh& mesh);

}  // namespace glisson::scene
