// contact_state.h — what a ContactTool keeps: the rows of a step, what is bonded, what bears.
#pragma once

#include <map>
#include <vector>

#include "contact/contact_reach.h"
#include "contact/found_inside.h"
#include "contact/row_group.h"
#include "glisson/instruments/contact.h"

namespace glisson {

/// A vertex (1, 0, 0) or a point of a triangle, with its impulses in an iteration of a long step [N s].
struct BearingPoint {
  std::array<double, 3> weights{};
  double pressing = 0.0;
  Vec3d rubbing{};
};

/// Rows of a triangle in a step.
struct HeldTriangle {
  std::uint32_t points = 0;
  double level = 0.0;  ///< the deepest that they ask for [m], ≤ 0
};

/// What a ContactTool keeps from step to step, beside what its reach has seen.
struct ContactKept {
  double last_h = 0.0;
  std::map<std::uint32_t, Vec3d> bonds;  ///< vertex → place in the frame of the tool
  bool begun = false;                    ///< a step has been made since the tool was attached
  FoundInside found_inside;
  /// Forces on triangles in the last step, of all their points, to begin the next with [N]; in long steps on vertices too, three times the same.
  std::map<Triangle, double> last_pressing;
  std::map<std::uint32_t, Vec3d> last_bonds;  ///< the same of bonds, in long steps [N]
  bool in_contact = false;
  double last_touch = 0.0, last_depth = 0.0;
  std::vector<double> pressed;  ///< per vertex of the reach: impulse along its normal in this step [N s]
  std::vector<std::uint32_t> bearing_vertices;
  std::vector<double> pressures, bearing_normal;  ///< of each [Pa], [N]
  std::vector<Vec3d> bearing_forces;              ///< of each [N]
  double area = 0.0;                              ///< [m²]
};

struct ContactTool::State : ContactKept {
  ContactOptions options;
  ContactSolid solid;
  ContactReach reach;

  std::vector<Vec3d> starts, ends;     ///< per vertex of the reach, in the frame of the tool
  std::vector<double> at_ends;         ///< φ there
  std::vector<std::uint32_t> touched;  ///< vertices of the reach that rows move, as places there
  std::vector<Vec3d> exerted;          ///< per vertex of the reach: whole impulse in this step [N s]
  Effort effort{};

  WorkAccount account;
  int looks = 0;                                        ///< for triangles, in this step
  std::map<Triangle, std::vector<BearingPoint>> trial;  ///< of a long step: what its iterations have found
  std::vector<char> has_row, moves;                     ///< per vertex of the reach: has a row of its own; is in a row
  std::vector<HeldTriangle> held;                       ///< per triangle of the reach

  void bear_nothing();
  void begin_vertices(const InteractionStep& step);
  std::size_t add_vertices(const InteractionStep& step, RowGroup& rows);
  void declare_short(const InteractionStep& step, RowGroup& rows, int round);
  void declare_long(const InteractionStep& step, RowGroup& rows, int round);
  void add_bonds(const InteractionStep& step, RowGroup& rows);
  void begin_rows(std::size_t first, const InteractionStep& step, RowGroup& rows) const;
  void touch(std::uint32_t i);
  void hold_again(const InteractionStep& step, RowGroup& rows);
  void hold(std::size_t triangle, const std::array<double, 3>& weights, double allowance, const InteractionStep& step,
            RowGroup& rows);
  void remember(const InteractionStep& step, const RowGroup& rows);
  void found(const InteractionStep& step, const RowGroup& rows);
  void require_outside(const BodyView& body, const Pose& pose, const Vec3d& direction) const;
  void measure(std::size_t i, const InteractionStep& step);
  double least_of(const std::array<Vec3d, 3>& corners) const;
  void bear(std::uint32_t vertex, double pressing, const Vec3d& impulse);
  std::size_t add_triangles(bool moved, const InteractionStep& step, RowGroup& rows);
  void add_triangle(std::size_t triangle, int strides, double allowance, const InteractionStep& step, RowGroup& rows);
  double longest_of(const Triangle& corners) const;
  double allowance_of(double longest) const;
  bool is_bonded_at(const Triangle& corners) const;
  void bond_first(const BodyView& body, const Pose& pose);
  void bond(const InteractionStep& step, const RowGroup& rows, ToolForces& forces);
  void collect(const InteractionStep& step, const RowGroup& rows, ToolForces& forces);
  void weigh(const InteractionStep& step);
};

}  // namespace glisson
