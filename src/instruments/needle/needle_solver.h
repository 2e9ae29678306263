// needle_solver.h — the rows of a needle in a step, and what it exerts on them.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "instruments/needle/needle_state.h"

namespace glisson {

/// The rows that the needle acts on in a step, and what it does there.
struct Needle::Solver {
  State& s;
  Vec3d d, before, after;  ///< the needle's direction; its tip at t and t + h, as if nothing bent it
  double h;
  std::vector<const shaft::Row*> all{};  ///< nodes behind the tip, then the tip if it acts
  std::vector<std::size_t> node{};       ///< number of each among the nodes
  std::vector<double> from_hand{};       ///< [m]
  bool has_tip = false;
  double tip_gap = 0.0;  ///< of the path's end before the tip [m]; negative: the tip is beyond it

  Vec3d needle_velocity() const { return (after - before) * (1.0 / h); }
  void find_rows(const InteractionStep& step);
  double way_past(std::size_t node) const;
  std::vector<Vec3d> across_it(const Eigen::MatrixXd& W);
  std::vector<double> along_it(const Eigen::MatrixXd& W);
  /// What a row exerts in a step [N s].
  struct Impulses {
    std::vector<Vec3d> across;
    std::vector<double> along;
  };
  /// Both in a long step, where the rows move one another in all directions.
  Impulses solve_long(const InteractionStep& step);

 private:
  struct LongRows;
  LongRows long_rows(const InteractionStep& step);
  double set_across(LongRows& rows) const;
  std::vector<double> along_in_long(const LongRows& rows, const Eigen::MatrixXd& D, const Eigen::VectorXd& speed);
  void hand_out(const InteractionStep& step, const LongRows& rows, const Impulses& p);
  double tip_slip() const;
  Eigen::MatrixXd wanted_across(std::size_t held, const Vec3d& bevel, const Eigen::MatrixXd& W,
                                const Eigen::MatrixXd& C) const;
  Vec3d bevel_force() const;
  void keep_along(std::span<const double> p, std::span<const char> slips);
  void bend(std::span<const Vec3d> impulse, const Eigen::MatrixXd& C);
  Vec3d free_end(std::span<const Vec3d> impulse) const;
  double shaft_of(std::size_t row) const;
  shaft::AxialLimit limit_of(std::size_t row) const;

 public:
  void book(const InteractionStep& step, std::span<const Vec3d> sideways, std::span<const Vec3d> lengthways,
            const ToolVelocity& needle) const;
};

}  // namespace glisson
