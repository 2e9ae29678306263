// coupled_newton.h — all points that press in a long step at once.
//
// Contact and friction as equations of the impulses, with P the nearest within the limit of friction:
//
//   p = max(0, p − φ/(h a)),   r = P(r − ρ s)        φ distance at the end, s slip, a and ρ⁻¹ velocities by impulses
//
// They have corners, but slopes on each side of them: Newton's method with these [AlartCurnier1991]. Points that press nothing take no part.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "contact/coupled_points.h"
#include "contact/point_rows.h"

namespace glisson {

class CoupledNewton {
 public:
  /// Row k acts on point k. All must outlive this.
  CoupledNewton(std::span<ContactRow* const> rows, CoupledPoints& points, double h);
  /// Whether it can serve: no row is held back, jammed, fast or soft.
  bool is_of_use() const;
  /// Goes nearer to where all rows are met. @return false where it does not lead there: all is as it was
  bool improve();

 private:
  Eigen::VectorXd find_lack();
  Eigen::VectorXd change(const Eigen::VectorXd& lack, double damping) const;
  void take(const Eigen::VectorXd& change);
  Vec3d end(std::size_t k) const;
  bool meets(std::size_t k, const Vec3d& end) const;
  Eigen::Vector3d in_frame(std::size_t k, const Vec3d& x) const;
  Eigen::Vector3d drift(std::size_t k) const;
  double across(std::size_t k) const;
  std::vector<Eigen::Index> unknowns() const;

  std::span<ContactRow* const> rows_;
  CoupledPoints& points_;
  double h_;
  std::vector<Eigen::Matrix3d> frames_;  ///< normal, and two across
  std::vector<Eigen::Vector3d> away_;    ///< slope of φ at the present ends, in these
  std::vector<Eigen::Vector2d> wanted_;  ///< r − ρ s
  std::vector<char> presses_;            ///< p − φ/(h a) is above 0, or the row holds
};

}  // namespace glisson
