// disc_impulses.h — impulses of limited size that stop points which move one another, as Coulomb's friction with given limits.
//
//   minimise  ½ Jᵀ W J − Jᵀ r   with  |J_j| ≤ L_j,   J_j and r_j of two components
//
// so that with the slip s = r − W J each point has s_j = 0, or |J_j| = L_j with J_j along s_j: the most dissipation that the limits
// allow. Blocks are solved exactly in turn (projected Gauss–Seidel), which converges for every W ≥ 0.
#pragma once

#include <Eigen/Core>
#include <span>

namespace glisson {

/// Minimises ½ Jᵀ A J − Jᵀ r over |J| ≤ most; where A leaves J open, it is 0.
/// @param A  symmetric, ≥ 0 @param most  ≥ 0
Eigen::Vector2d within_disc(const Eigen::Matrix2d& A, const Eigen::Vector2d& r, double most);

/// Solves for all points.
/// @param W  symmetric, ≥ 0: velocities by impulses [1/kg] @param r  velocities to be stopped [m/s] @param most  L [N s]
/// @param J  where to begin, and the impulses [N s]
/// @return how many sweeps it took
int solve_within_discs(const Eigen::MatrixXd& W, const Eigen::VectorXd& r, std::span<const double> most,
                       Eigen::VectorXd& J);

}  // namespace glisson
