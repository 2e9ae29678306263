// coupled_rows.h — the rows of a long step, in which all points move one another.
//
//   v = v₀ + W p (coupled_points.h)     sweeps on W in turn ─▶ all points that press at once (coupled_newton.h) ─▶ sweeps …
//
// Discs and shafts are blocks that are solved as a whole. A small compliance of each point makes the answer one, with the
// least impulses.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "contact/coupled_newton.h"
#include "contact/coupled_points.h"
#include "contact/coupled_shaft.h"
#include "contact/island.h"

namespace glisson {

class CoupledRows {
 public:
  /// Finds how the rows of an island move one another. All must outlive this. @param free  velocities without any tool, per place [m/s]
  CoupledRows(Island& island, const InteractionStep& step, StepMobility& mobility, std::span<const Vec3d> free);

  struct Outcome {
    int sweeps = 0;
    bool settled = true;  ///< impulses no longer change
    bool found = true;    ///< all rows are met, or nearly, or cannot be
    bool unmet = false;   ///< not all rows could be met
  };
  /// @param most  sweeps
  Outcome solve(int most);
  /// Sets the impulses on places [N s], and adds the forces on tools that yield.
  void finish(std::span<Vec3d> impulses) const;

 private:
  void add_points();
  void begin();
  bool is_once() const;
  double sweep();
  double sweep_points();
  double sweep_holds();
  double solve_discs();
  double solve_shafts();
  bool has_jams() const;
  void share_in_corners();
  double most_missed();

  Island& island_;
  const InteractionStep& step_;
  StepMobility& mobility_;
  CoupledPoints points_;  ///< of all rows: of points, discs, shafts, holds, pushes
  std::size_t first_disc_ = 0, first_shaft_ = 0, first_hold_ = 0, first_push_ = 0;
  std::vector<char> releases_;       ///< per row of points
  std::vector<std::size_t> holder_;  ///< per place: the row to whose wall it sticks; as many as there are: none
  Eigen::MatrixXd discs_;            ///< W among discs, two components across the line of each [1/kg]
  std::vector<shaft::CoupledShaft> shafts_;
};

}  // namespace glisson
