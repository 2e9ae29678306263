// coupled_shaft.h — a shaft in a long step, where an impulse at a row moves all rows in all directions.
//
//   across   (E W Eᵀ + c) p = …        the tissue is on the bent shaft at the end                    direct
//   along    with p across eliminated: sticks, or slips at its limit, as in a short step           Gauss–Seidel
#pragma once

#include <Eigen/Dense>
#include <array>
#include <span>
#include <vector>

#include "contact/shaft_block.h"

namespace glisson::shaft {

class CoupledShaft {
 public:
  /// @param W  of its rows among each other, three components each [1/kg]
  CoupledShaft(Block& block, const Eigen::MatrixXd& W);
  /// Finds the impulses. @param tissue  velocities of the rows without them [m/s]
  void solve(std::span<const Vec3d> tissue);

 private:
  Eigen::VectorXd wanted_across(std::span<const Vec3d> tissue) const;

  Block& block_;
  std::array<Vec3d, 2> e_;
  Eigen::MatrixXd by_along_;             ///< B: velocities across, two a held row, by impulses along [1/kg]
  Eigen::MatrixXd across_by_along_;      ///< A⁻¹ B
  Eigen::MatrixXd along_;                ///< velocities along by impulses along, with those across eliminated [1/kg]
  Eigen::LDLT<Eigen::MatrixXd> across_;  ///< A
  std::vector<Vec3d> given_;             ///< velocities of the rows by impulses across that are given [m/s]
};

}  // namespace glisson::shaft
