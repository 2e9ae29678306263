// shaft_block.h — a shaft in tissue, as a block of rows that is solved at once.
//
// Row j couples a point of the shaft with a mean of vertices. An impulse p_k on the tissue at row k changes the tissue's velocity at
// row j by W_jk p_k. Along the shaft and across it the rows do not know of each other:
//
//   across   (W + c) p = …       the tissue stays on the shaft, which bends by y = −h² c p/h         direct
//   along    |p_j| ≤ h f_j       it sticks, or slips at the limit; the tip pushes, up to a limit     Gauss–Seidel
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/push_clock.h"
#include "contact/tool_yield.h"
#include "glisson/contact/shaft_friction.h"
#include "glisson/simulation/interaction.h"

namespace glisson::shaft {

/// A point of the tissue that the shaft acts on: a mean of vertices.
struct Row {
  Vec3d rest{};  ///< [m]
  std::vector<VertexWeight> weights;
  Vec3d position{};  ///< mean of the tissue at t [m]
  Vec3d velocity{};  ///< and its velocity before the shaft acts [m/s]
};

/// Mean position and velocity of a row. @return false where a vertex is not active
bool read(const InteractionStep& step, Row& row);
/// Spreads an impulse [N s] over the vertices of a row.
void push(const InteractionStep& step, const Row& row, const Vec3d& impulse);

/// W of nodes and a tip [1/kg], kept from step to step: a path changes at its end only, and mobilities hardly ever.
/// Of the mobilities' components the largest counts, so that impulses never overshoot.
class MobilityMatrix {
 public:
  /// @param nodes  of the path, from the surface on; those that were there in the last call are the same
  /// @param acting  numbers of those that act, ascending
  /// @param tip    none: does not act
  /// @return rows of the acting nodes, then that of the tip
  Eigen::MatrixXd of(const InteractionStep& step, std::span<const Row> nodes, std::span<const std::size_t> acting,
                     const Row* tip);
  /// Rows have become others.
  void forget() { nodes_.resize(0, 0); }

 private:
  void extend(const InteractionStep& step, std::span<const Row> nodes);
  Eigen::MatrixXd nodes_;
  std::vector<double> reached_;  ///< per active vertex: mobility times weight of one row
};

/// What a row may take along the shaft.
struct AxialLimit {
  double length = 0.0;     ///< of shaft it stands for [m]
  bool slips = false;      ///< in the last step
  bool is_tip = false;     ///< pushes only
  double tip_limit = 0.0;  ///< most it pushes [N]; infinite: whatever it takes
};

/// How far Gauss–Seidel goes.
struct Effort {
  int most_sweeps = 40;
  double enough = 1e-6;  ///< change of an impulse over the largest at which sweeps end
  int most_breaks = 0;   ///< so often a row comes from sticking to slip: it slips from then on; 0: as often as it likes
};

/// Impulses along the shaft.
/// @param W      of MobilityMatrix::of [1/kg]
/// @param speed  of the shaft over the tissue before it acts, positive inward; per row [m/s]
/// @param p      start of the iteration, and its end [N s]
/// @param breaks  per row: how often it has come from sticking to slip; empty: not counted
/// @return per row: whether it slips
std::vector<char> solve_along(const Eigen::MatrixXd& W, std::span<const double> speed,
                              std::span<const AxialLimit> limits, const ShaftFriction& friction, double h,
                              std::span<double> p, const Effort& effort = {}, std::span<int> breaks = {});

/// The rows of a shaft in a step, and what it exerts on them.
struct Block {
  Vec3d direction{};
  Vec3d velocity{};   ///< of the shaft in this step [m/s]
  ToolVelocity tool;  ///< the same, for the ledger
  double h = 0.0;     ///< [s]
  std::vector<const Row*> rows{};
  std::vector<WorkSink> sinks{};  ///< per row: of what acts along
  std::size_t held = 0;           ///< so many, the first ones, stay on the shaft across it
  Eigen::MatrixXd W{};            ///< of all, in a short step [1/kg]
  Eigen::MatrixXd compliance{};   ///< c of all: of the bent shaft [1/kg] …
  double slack = 0.0;             ///< … and beside it, on the diagonal of those held [1/kg]
  double slack_share = 0.0;       ///< in a long step the same over the mean of W across
  std::vector<Vec3d> off{};       ///< per held row: what the step is to make up for beside velocities [m] …
  std::vector<Vec3d> more{};      ///< … and what impulses across that are given add to it [m]
  std::vector<double> closing{};  ///< per row: speed that the tissue may have against the shaft [m/s]
  std::vector<AxialLimit> limits{};
  ShaftFriction friction{};

  std::vector<Vec3d> across{};  ///< impulses [N s]; those of rows that are not held are given
  std::vector<double> along{};  ///< impulses, at first where to begin [N s]
  std::vector<char> slips{};    ///< per row
  std::vector<int> breaks{};    ///< per row: how often it came from sticking to slip between solves of this step

  std::vector<Vec3d> tissue{};          ///< velocity of each row without the shaft [m/s]
  std::vector<std::uint32_t> places{};  ///< that its rows move, each once; filled where other tools act on some of them
  bool is_new = true;                   ///< not solved yet
  PushClock::Time solved_at = 0;
  ToolYield* yields = nullptr;  ///< in a long step, where a force moves the shaft

  /// Takes in rows that were read.
  void add(const Row& row);
  /// Finds the impulses, and pushes. @return by how much it moved a row at most [m]
  double solve(const InteractionStep& step);
  void find_places(const InteractionStep& step);
  /// A row that holds more than it would in slip, and gives way, in turn with other tools: from some times on it slips.
  /// @param before  impulses along of the last solve [N s]
  void count_breaks(std::span<const double> before);
  /// @param shaft  its velocity
  void book(const InteractionStep& step, const ToolVelocity& shaft) const;
  /// Across, tissue that is held bends the shaft: c, and what the solve adds. Along, a row that sticks; and the viscous part of the
  /// friction of one that slips, c = 1/drag. A tip that cuts holds nothing.
  void list_held(const InteractionStep& step, HeldRows& held) const;

 private:
  bool tip_cuts() const { return limits.back().is_tip && sinks.back() == WorkSink::fracture && slips.back() != 0; }
  void solve_across();
  void solve_and_push(const InteractionStep& step);
  void take_off(const InteractionStep& step);
};

}  // namespace glisson::shaft
