// ball_series.h — a ball under tractions on its surface by Legendre's series: what they move, and the work they do.
#pragma once

#include <numbers>
#include <span>

#include "glisson/material/tissue.h"

namespace glisson {

/// Displacement of the surface by one term of the series: `radial` P_n(cos θ) and `along` dP_n/dθ [m].
struct BallMode {
  double radial = 0.0, along = 0.0;
};

/// The surface under the tractions t P_n along the radius and s dP_n/dθ along θ, n even:
///   u_r  = [A (n + 1)(n − 2 + 4ν) r^{n+1} + B n r^{n−1}] P_n
///   u_θ  = [A (n + 5 − 4ν) r^{n+1} + B r^{n−1}] dP_n/dθ
///   σ_rr = 2μ [A (n + 1)(n² − n − 2 − 2ν) rⁿ + B n (n − 1) r^{n−2}] P_n
///   τ_rθ = 2μ [A (n² + 2n − 1 + 2ν) rⁿ + B (n − 1) r^{n−2}] dP_n/dθ                                      [Lurie2005]
/// @param t, s  [Pa]; s is not read for n = 0  @param R  of the ball [m]
inline BallMode ball_mode(std::size_t order, double t, double s, double R, const Tissue& tissue) {
  const auto n = static_cast<double>(order);
  const double nu = tissue.poisson_ratio, mu = tissue.lame().mu;
  const double a1 = (n + 1) * (n * (n - 1) - 2 - 2 * nu), b1 = n * (n - 1);
  const double a2 = n * (n + 2) - 1 + 2 * nu, b2 = n - 1;
  const double det = order == 0 ? 1.0 : a1 * b2 - b1 * a2;  // n = 0 is a uniform pressure and has no B
  const double A = order == 0 ? t / (2 * mu) / a1 : (t * b2 - s * b1) / (2 * mu) / det;
  const double B = order == 0 ? 0.0 : (s * a1 - t * a2) / (2 * mu) / det;
  return {R * (A * (n + 1) * (n - 2 + 4 * nu) + B * n), R * (A * (n + 5 - 4 * nu) + B)};
}

/// ∫ t u_r dA over the sphere of a radial traction Σ t_n P_n(cos θ).
/// @param traction  t_n by n, outward [Pa]; odd ones are not read  @param R  of the ball [m]  @return [J]
inline double ball_work(std::span<const double> traction, double R, const Tissue& tissue) {
  double work = 0.0;
  for (std::size_t n = 0; n < traction.size(); n += 2) {
    work += traction[n] * ball_mode(n, traction[n], 0.0, R, tissue).radial * 4.0 * std::numbers::pi * R * R /
            (2.0 * static_cast<double>(n) + 1.0);
  }
  return work;
}

}  // namespace glisson
