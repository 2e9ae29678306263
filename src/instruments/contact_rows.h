// contact_rows.h — points of the surface that a rigid solid holds out, and the impulses that do so.
//
// All is seen in the frame of the solid, so that a moving solid is at rest there:
//
//   start ──── free path of the step ────▶ end        φ ≥ 0 is to hold at the end; n is taken where the path meets the
//        ╲n                                           solid, at `face`; a point that touches already takes n at its start
//   ══════╪═══════ surface of the solid
//        face
//
// n at the start, and the distance at the end: with that a point that slides without friction along a curved solid gains and
// loses no energy over steps of one length, as in the SHAKE integrator of constrained motion [Ryckaert1977].
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "glisson/instrument.h"
#include "instruments/shape.h"

namespace glisson {

/// A rigid solid during a step.
struct ContactSolid {
  const Shape* shape = nullptr;
  ShapeTraits traits{};
  Pose before, after;
  double friction = 0.0;         ///< μ [-], may be infinite
  double push_out_speed = 0.05;  ///< [m/s]
  bool holds = false;            ///< what touches does not lift off
  /// Distance that counts as none [m].
  double tolerance() const;
};

/// A point of the surface, with what was found about it.
struct ContactRow {
  std::array<std::uint32_t, 3> places{};  ///< among the vertices at hand
  std::array<double, 3> weights{1.0, 0.0, 0.0};
  std::uint32_t count = 1;  ///< 1: a vertex, 3: a point of a triangle
  const ContactSolid* solid = nullptr;

  Vec3d origin{};        ///< of the point at time t, in space [m]
  Vec3d start, face, n;  ///< in the frame of the solid [m], [m], [-]
  Vec3d normal;          ///< n in space, at t + h
  double level = 0.0;    ///< φ asked for at the end [m], ≤ 0: less than 0 where the point was inside already
  bool fast = false;     ///< it passes through more than a part of the solid in this step
  Vec3d response;        ///< velocity per impulse at the point, per component [1/kg]
  double along = 0.0;    ///< n·response·n

  double pressing = 0.0;  ///< impulse along the normal [N s]
  Vec3d rubbing{};        ///< impulse across it

  Vec3d impulse() const { return normal * pressing + rubbing; }
};

/// Where the point is in the frame of the solid at the end of the step, with the present velocities.
Vec3d end_of(const ContactRow& row, const InteractionStep& step);

/// Looks where the point meets the solid. @return false where it does not come near, or cannot be moved
bool prepare(ContactRow& row, const InteractionStep& step);

/// Solves for all impulses and pushes. @return sweeps
int solve(std::span<ContactRow> rows, const InteractionStep& step);

/// Barycentric weights of about the deepest point of a triangle in a convex solid.
/// @param corners  in the frame of the solid @param at_corners  φ there
/// @param depth  its φ, on return
std::array<double, 3> deepest(const Shape& shape, const std::array<Vec3d, 3>& corners,
                              const std::array<double, 3>& at_corners, double& depth);

}  // namespace glisson
