// ball_series.h — the work of tractions on a ball by Legendre's series.
#pragma once

#include <numbers>
#include <span>

#include "glisson/material/tissue.h"

namespace glisson {

/// ∫ t u_r dA over the sphere of a radial traction Σ t_n P_n(cos θ), n even: each term moves the surface by
///   u_r = [A (n + 1)(n − 2 + 4ν) r^{n+1} + B n r^{n−1}] P_n
///   σ_rr = 2μ [A (n + 1)(n² − n − 2 − 2ν) rⁿ + B n (n − 1) r^{n−2}] P_n
///   τ_rθ = 2μ [A (n² + 2n − 1 + 2ν) rⁿ + B (n − 1) r^{n−2}] dP_n/dθ = 0 at the surface                 [Lurie2005]
/// @param traction  t_n by n, outward [Pa]; odd ones are not read  @param R  of the ball [m]  @return [J]
inline double ball_work(std::span<const double> traction, double R, const Tissue& tissue) {
  const double nu = tissue.poisson_ratio, mu = tissue.lame().mu;
  double work = 0.0;
  for (std::size_t k = 0; k < traction.size(); k += 2) {
    const auto n = static_cast<double>(k);
    const double a1 = (n + 1) * (n * (n - 1) - 2 - 2 * nu), b1 = n * (n - 1);
    const double a2 = n * (n + 2) - 1 + 2 * nu, b2 = n - 1;
    const double det = k == 0 ? 1.0 : a1 * b2 - b1 * a2;  // n = 0 is a uniform pressure and has no B
    const double A = k == 0 ? traction[k] / (2 * mu) / a1 : traction[k] / (2 * mu) * b2 / det;
    const double B = k == 0 ? 0.0 : -traction[k] / (2 * mu) * a2 / det;
    const double u = R * (A * (n + 1) * (n - 2 + 4 * nu) + B * n);
    work += traction[k] * u * 4.0 * std::numbers::pi * R * R / (2 * n + 1);
  }
  return work;
}

}  // namespace glisson
