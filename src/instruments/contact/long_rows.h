// long_rows.h — rows in a long step, where all points move one another: W among the rows, and a step of Newton's method on all of them.
//
//   v = v₀ + W J      W_jk = Σ w_a w_b (P⁻¹)_ab/h² over the vertices a of row j, b of row k
//
// Rows in turn (projected Gauss–Seidel) take hundreds of sweeps where points are close to each other. So all are solved for together now
// and then, with ρ the inverse of what a unit impulse moves its own point by:
//
//   along    p = max(0, p − ρ g/h)             g the gap at the end
//   across   r = P(r − ρ s), |P| ≤ μ p         s the slip
//
// by the semismooth Newton method [AlartCurnier1991], taken where it makes what these equations lack smaller.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "instruments/contact/contact_rows.h"

namespace glisson {

class LongRows {
 public:
  /// @param rows  with the impulses that they have exerted; their `along` becomes that of W
  LongRows(std::span<ContactRow> rows, const InteractionStep& step);

  double h() const { return step_.h; }
  /// Where the point of a row is at the end of the step, in the frame of its solid [m].
  Vec3d end(std::size_t k) const;
  /// Velocity that an impulse on a row gives to its own point [m/s].
  Vec3d own(std::size_t k, const Vec3d& impulse) const;
  /// Gives the point an impulse [N s]; vertices follow in finish().
  void push(std::size_t k, const Vec3d& impulse);
  /// φ of a row's point at the end, less what the row asks for [m], and its gradient, in the frame of the solid.
  using GapOf = ShapeDistance (*)(const ContactRow& row, const Vec3d& end);
  /// Newton's method on all rows, up to 80 of them, where nothing holds their points: it costs as the cube of their number.
  /// @return whether it has led nearer to the answer
  bool solve_together(const GapOf& gap);
  /// Gives the vertices what rows exert now more than at first.
  void finish();

 private:
  static constexpr std::size_t kMostTogether = 80;
  static Eigen::Index at(std::size_t k) { return static_cast<Eigen::Index>(3 * k); }
  Eigen::VectorXd lacks(std::span<const ShapeDistance> gaps) const;
  Eigen::VectorXd newton(std::span<const ShapeDistance> gaps, const Eigen::VectorXd& lack, double damping) const;
  Eigen::Vector3d in_frame(std::size_t k, const Vec3d& x) const;
  Eigen::Vector3d drift(std::size_t k) const;
  void take(const Eigen::VectorXd& change);
  double step_across(std::size_t k) const { return 1.0 / rows_[k].response.x; }

  std::span<ContactRow> rows_;
  const InteractionStep& step_;
  Eigen::MatrixXd W_, in_frames_;        ///< the same in the frames of the rows [1/kg]
  Eigen::VectorXd v_;                    ///< of the points [m/s]
  std::vector<Vec3d> at_first_;          ///< impulses [N s]
  std::vector<Eigen::Matrix3d> frames_;  ///< columns: normal, and two across it
};

}  // namespace glisson
