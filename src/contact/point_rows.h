// point_rows.h — points of the surface that a rigid solid holds out, and the impulses that do so.
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
#include <optional>
#include <span>
#include <vector>

#include "contact/push_clock.h"
#include "contact/shape_traits.h"
#include "contact/tool_yield.h"
#include "glisson/pose.h"
#include "glisson/simulation/interaction.h"

namespace glisson {

inline constexpr double kSolvedWithin = 1000.0;  ///< tolerances: rows that move by less have been solved

/// A rigid solid during a step.
struct ContactSolid {
  const Shape* shape = nullptr;
  ShapeTraits traits{};
  Pose before, after;            ///< at t and t + h
  Pose earlier;                  ///< a step before t
  double last_h = 0.0;           ///< length of that step [s]; 0: there was none
  double friction = 0.0;         ///< μ [-], may be infinite
  double push_out_speed = 0.05;  ///< [m/s]
  bool still = false;            ///< it never moves
  bool holds = false;            ///< what touches does not lift off …
  double grip = 0.0;             ///< … and touches where it is no farther than this [m]
  ToolYield* yields = nullptr;   ///< in a long step, where a force moves it
  /// Distance that counts as none [m].
  double tolerance() const;
  /// Of its material at a point of space, in this step and the last, 0 in the first [m/s]. @param h  of this step
  ToolVelocity velocity_at(const Vec3d& x, double h) const;
};

/// A point of the surface, with what was found about it.
struct ContactRow {
  std::array<std::uint32_t, 3> places{};  ///< among the vertices at hand
  std::array<double, 3> weights{1.0, 0.0, 0.0};
  std::uint32_t count = 1;  ///< 1: a vertex, 3: a point of a triangle
  bool again = false;       ///< its triangle has another row before it
  const ContactSolid* solid = nullptr;

  std::array<Vec3d, 3> origins{};  ///< of the vertices at time t, in space [m]
  Vec3d origin{};                  ///< of the point
  Vec3d start, face, n;            ///< in the frame of the solid [m], [m], [-]
  Vec3d normal;                    ///< n in space, at t + h
  double allowance = 0.0;          ///< so deep it may be in the solid [m]
  bool comes_out = false;  ///< it was inside when the tool was attached: the solid is taken to grow to its size there
  double inside = 0.0;     ///< how deep it was in the solid at the start [m]
  double level = 0.0;      ///< φ asked for at the end [m], ≤ 0: less than 0 where the point was inside already
  bool bonded = false;     ///< it is held at `face`, pulled or pressed
  bool fast = false;       ///< it passes through more than a part of the solid in this step
  Vec3d response;          ///< velocity per impulse at the point, per component; in a long step at most [1/kg]
  double along = 0.0;      ///< the same along n [1/kg]
  Vec3d carried, carried_before;  ///< velocity of the solid where the point starts, in this step and the last [m/s]
  std::optional<double> most;     ///< speed off the solid that it may get at most [m/s]

  double pressing =
      0.0;          ///< impulse along the normal [N s]; that of a row that was just declared is where the solver begins
  Vec3d rubbing{};  ///< impulse across it
  double softness = 0.0;  ///< compliance over the point's own: above 0 where rows cannot all be met
  bool is_new = true;     ///< the solver has not pushed it yet
  std::size_t tool = 0;   ///< among those of the step
  std::size_t port = 0;   ///< its number in a long step (coupled_rows.h)
  PushClock::Time solved_at = 0;

  Vec3d impulse() const { return normal * pressing + rubbing; }
  /// Takes an impulse in parts along and across the normal.
  void take(const Vec3d& impulse) { pressing = dot(impulse, normal), rubbing = impulse - normal * pressing; }
};

/// Where the point is in the frame of the solid at the end of the step, with the present velocities.
Vec3d end_of(const ContactRow& row, const InteractionStep& step);

/// Looks where a vertex, or a point of a triangle, meets the solid.
/// @return false where it does not come near, or cannot be moved
bool prepare(ContactRow& row, const InteractionStep& step);

/// Holds a vertex at a place in the frame of the solid.
void prepare_bond(ContactRow& row, const Vec3d& anchor, const InteractionStep& step);

/// The places that a row moves.
inline std::span<const std::uint32_t> places_of(const ContactRow& row) {
  return std::span(row.places).first(row.count);
}

struct Swept {
  int sweeps = 0;
  double change = 0.0;  ///< by how much a point was moved at most in the last [m]
};
/// Solves for all impulses in sweeps, and pushes. @param most  sweeps at most
Swept sweep(std::span<ContactRow* const> rows, const InteractionStep& step, PushClock& clock, int most);
/// Sweeps at most over rows of a single tool.
int most_sweeps(std::span<ContactRow* const> rows);

/// By how much a point ends elsewhere than its row wants it, at most [m].
double most_missed(std::span<ContactRow* const> rows, const InteractionStep& step);

/// Gives the point an impulse [N s].
void push(const ContactRow& row, const InteractionStep& step, const Vec3d& impulse);

/// Adds what a row holds: its point along the normal, where it sticks in all directions. None if the point does not end where the row wants
/// it, as where a bond moves a corner of its triangle afterwards.
void list_held(const ContactRow& row, const InteractionStep& step, HeldRows& held);

/// Barycentric weights of the deepest point of a triangle in a convex solid. @param corners  in the frame of the solid
/// @param depth  its φ, on return. Cost: 20 ns for a ball, 0.5 µs for others
std::array<double, 3> deepest(const Shape& shape, const std::array<Vec3d, 3>& corners, double& depth);

}  // namespace glisson
