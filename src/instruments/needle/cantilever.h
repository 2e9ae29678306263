// cantilever.h — a needle that is clamped at the hand, as a beam: deflection a²(3b − a)/6EI for points a ≤ b from the hand.
#pragma once

#include <Eigen/Dense>
#include <span>

namespace glisson {

/// Deflection at one distance from the hand by a force at another [m/N]. @param bending_stiffness  E I [N m²]; 0: rigid
double cantilever(double at, double of, double bending_stiffness);

/// C of points at these distances from the hand [m/N]. @param bending_stiffness  as above
Eigen::MatrixXd cantilever(std::span<const double> distances, double bending_stiffness);

}  // namespace glisson
