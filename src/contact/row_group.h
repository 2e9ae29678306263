// row_group.h — the rows of one tool in a step, by law.
//
//   points   a vertex or a point of a triangle that a solid holds out, with Coulomb's cone, or holds          point_rows.h
//   holds    a vertex that ends the step with a given velocity
//   discs    a mean of vertices that is stopped across a line, by an impulse of limited size
//   shaft    a block of rows along an axis, that bends                                                        shaft_block.h
//   pushes   impulses that are given
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "contact/point_rows.h"
#include "contact/shaft_block.h"
#include "contact/work_account.h"
#include "glisson/simulation/interaction.h"

namespace glisson {

/// A vertex that ends the step with a given velocity, in components that may move.
struct HoldRow {
  std::uint32_t place = 0;
  Vec3d velocity{};                    ///< [m/s]
  std::optional<ToolVelocity> tool{};  ///< for the ledger; none: the tissue's own
  Vec3d impulse{};                     ///< [N s]
  double softness = 0.0;               ///< as that of a ContactRow
  PushClock::Time solved_at = 0;
};

/// A mean of the vertices of a tet that is stopped across a line, by an impulse of limited size.
struct DiscRow {
  std::array<std::uint32_t, 4> places{};
  std::array<double, 4> weights{};
  Vec3d velocity{};                    ///< that it is taken along with [m/s]
  Vec3d line{};                        ///< along it nothing is stopped; any length
  double most = 0.0;                   ///< size of the impulse [N s]
  double mobility = 0.0;               ///< velocity per impulse at most [1/kg]
  std::array<ToolVelocity, 4> tool{};  ///< at each vertex, for the ledger
  Vec3d impulse{};                     ///< [N s]
  PushClock::Time solved_at = 0;
  Vec3d last{};                 ///< what it was given in the last step, in a long step [N s]
  ToolYield* yields = nullptr;  ///< the tool, where a force moves it in a long step
};

/// An impulse that is given [N s].
struct GivenRow {
  std::uint32_t place = 0;
  Vec3d impulse{};
  bool is_new = true;
};

struct RowGroup {
  std::vector<ContactRow> points;
  std::vector<HoldRow> holds;
  std::vector<DiscRow> discs;
  std::vector<GivenRow> pushes;
  std::optional<shaft::Block> shaft;
  std::deque<ContactSolid> walls;  ///< of StepRows::press
  std::vector<std::optional<std::size_t>>
      pressed;                      ///< per call of it: the row among the points; none: it did not come near
  WorkAccount* account = nullptr;   ///< of the points
  ToolYield* yields = nullptr;      ///< in a long step, where a force moves the tool
  std::vector<ContactRow> earlier;  ///< points before clear()

  bool others_act =
      false;  ///< other tools push the same vertices, or solids act and it has no rows yet: what they push may come into reach

  // what solving took
  int sweeps = 0, last_sweeps = 0;  ///< over the points, in all rounds and in the last
  bool corrected = false;           ///< the account was overdrawn

  void clear();
  std::size_t size() const {
    return points.size() + holds.size() + discs.size() + pushes.size() + (shaft ? shaft->rows.size() : 0);
  }
};

/// Takes a vertex to its velocity. @return by how much it was moved [m]
double solve(HoldRow& row, const InteractionStep& step);
/// Stops a mean as far as its impulse goes. @return by how much it was moved [m]
double solve(DiscRow& row, const InteractionStep& step);

}  // namespace glisson
