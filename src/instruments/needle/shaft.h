// shaft.h — impulses between a needle and the points of its path, solved for in a step.
//
// Row j couples a needle point with a mean of tissue vertices (tissue_zone.h). An impulse p_k on the tissue at row k changes
// the tissue's velocity at row j by W_jk p_k. Along the needle and across it the rows do not know of each other:
//
//   across   (W + C/h²) p = …    the tissue stays on the needle, which bends by y = −C p/h        direct
//   along    |p_j| ≤ h f_j       it sticks, or slips at the limit; the tip pushes, up to a limit   Gauss–Seidel
//
// C is that of a cantilever clamped at the hand: a²(3b − a)/6EI for rows a ≤ b from the hand; 0 for a rigid needle.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "glisson/instruments/needle.h"
#include "glisson/simulation/interaction.h"
#include "instruments/needle/tissue_zone.h"

namespace glisson::shaft {

/// A point of the tissue that the needle acts on.
struct Row {
  Vec3d rest{};  ///< [m]
  std::vector<VertexWeight> weights;
  Vec3d position{};  ///< mean of the tissue at t [m]
  Vec3d velocity{};  ///< and its velocity before the needle acts [m/s]
};

/// Mean position and velocity of a row. @return false where a vertex is not active
bool read(const InteractionStep& step, Row& row);
/// Spreads an impulse [N s] over the vertices of a row.
void push(const InteractionStep& step, const Row& row, const Vec3d& impulse);
/// Tells the ledger of it.
void book(const InteractionStep& step, WorkSink sink, const Row& row, const Vec3d& impulse, const ToolVelocity& needle);

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

/// Deflection at one distance from the hand by a force at another [m/N]. @param bending_stiffness  E I [N m²]; 0: rigid
double cantilever(double at, double of, double bending_stiffness);

/// C of points at these distances from the hand [m/N]. @param bending_stiffness  as above
Eigen::MatrixXd cantilever(std::span<const double> distances, double bending_stiffness);

/// What a row may take along the needle.
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

/// Impulses along the needle.
/// @param W      of MobilityMatrix::of [1/kg]
/// @param speed  of the needle over the tissue before it acts, positive inward; per row [m/s]
/// @param p      start of the iteration, and its end [N s]
/// @param breaks  per row: how often it has come from sticking to slip; empty: not counted
/// @return per row: whether it slips
std::vector<char> solve_along(const Eigen::MatrixXd& W, std::span<const double> speed,
                              std::span<const AxialLimit> limits, const ShaftFriction& friction, double h,
                              std::span<double> p, const Effort& effort = {}, std::span<int> breaks = {});

}  // namespace glisson::shaft
