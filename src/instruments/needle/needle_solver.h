// needle_solver.h — the rows of a needle in a step, and what it exerts on them.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "contact/shaft_block.h"
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
  /// The rows as a block. @param tool  velocity of the needle, for the ledger
  shaft::Block block(const InteractionStep& step, const ToolVelocity& tool);
  /// Keeps what that has found.
  void keep(const InteractionStep& step, const shaft::Block& block);
  Eigen::MatrixXd C{};  ///< deflections of the needle at the rows by forces at them [m/N]
  double bending_energy(std::span<const Vec3d> sideways) const;

 private:
  void set_short(const InteractionStep& step, shaft::Block& block, const Vec3d& bevel) const;
  void set_long(shaft::Block& block, const Vec3d& bevel) const;
  void count_breaks(const shaft::Block& block);
  double tip_slip() const;
  Vec3d off_by(std::size_t j) const;
  double bevel_moves(const shaft::Block& block, std::size_t j) const;
  WorkSink sink_along(bool is_tip) const;
  Vec3d bevel_force() const;
  void keep_along(std::span<const double> p, std::span<const char> slips);
  void bend(std::span<const Vec3d> impulse);
  Vec3d free_end(std::span<const Vec3d> impulse) const;
  double shaft_of(std::size_t row) const;
  shaft::AxialLimit limit_of(std::size_t row) const;
};

}  // namespace glisson
