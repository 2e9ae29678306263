// ball_plates.h — a ball pressed between two rigid plates without friction: the exact solution.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <vector>

#include "ball_series.h"

namespace glisson {

/// What a ball in contact up to the angle θ₀ about its poles carries.
struct PressedBall {
  double approach = 0.0;                 ///< of each plate to the middle [m]
  double force = 0.0;                    ///< of each plate [N]
  double hertz = 0.0;                    ///< the force of Hertz's half-spaces at that approach [N]
  double unevenness = 0.0;               ///< largest distance of the face in contact from the plate [m]
  std::vector<double> pressure_terms{};  ///< of (1 − sin²θ / sin²θ₀)^{k + ½}, k = 0 … [Pa]
};

namespace ball_plates {

/// All P_n(cos θ) and dP_n/dθ at one angle.
struct Legendre {
  std::vector<double> value, slope;
  Legendre(double theta, std::size_t terms) : value(terms + 1, 1.0), slope(terms + 1, 0.0) {
    const double x = std::cos(theta), s = std::sin(theta);
    if (terms > 0) value[1] = x, slope[1] = -s;
    for (std::size_t k = 2; k <= terms; ++k) {
      const auto n = static_cast<double>(k);
      value[k] = ((2 * n - 1) * x * value[k - 1] - (n - 1) * value[k - 2]) / n;
      slope[k] = s > 0.0 ? n * (x * value[k] - value[k - 1]) / s : 0.0;
    }
  }
};

}  // namespace ball_plates

/// Hertz's problem for a whole ball of the linear theory: plates press along the axis, p on the sphere's own surface, so that the
/// face in contact is flat:
///   u_r cos θ − u_θ sin θ = −d + R (1 − cos θ) for θ ≤ θ₀,   p = Σ c_k (1 − sin²θ / sin²θ₀)^{k + ½}
/// The c_k and d are found by least squares at points of the face; each term of p is a series of Legendre (ball_series.h).
inline PressedBall ball_between_plates(double angle, double R, const Tissue& tissue) {
  constexpr std::size_t kPressures = 4, kPlaces = 30, kPoints = 500;
  const auto terms = static_cast<std::size_t>(2 * std::lround(100.0 / angle));
  const double sharp = std::sin(angle);
  // sin θ = sin θ₀ sin φ, where the pressures are powers of cos φ: the midpoint rule over φ converges at once.
  std::vector<std::vector<double>> radial(kPressures, std::vector<double>(terms + 1, 0.0)), along = radial;
  Eigen::VectorXd total = Eigen::VectorXd::Zero(kPressures);  // the force of a plate by each
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double phi = 0.5 * std::numbers::pi * (static_cast<double>(i) + 0.5) / kPoints;
    const double s = sharp * std::sin(phi), theta = std::asin(s), c = std::cos(theta);
    const double width = sharp * std::cos(phi) / c * 0.5 * std::numbers::pi / kPoints;  // dθ
    const ball_plates::Legendre p(theta, terms);
    for (std::size_t k = 0; k < kPressures; ++k) {
      const double pressure = std::pow(std::cos(phi), 2.0 * static_cast<double>(k) + 1.0);
      total[static_cast<Eigen::Index>(k)] += pressure * 2.0 * std::numbers::pi * R * R * s * width;
      for (std::size_t n = 0; n <= terms; n += 2) {
        const auto m = static_cast<double>(n);
        radial[k][n] -= (2 * m + 1) * pressure * c * p.value[n] * s * width;
        if (n > 0) along[k][n] += (2 * m + 1) / (m * (m + 1)) * pressure * s * p.slope[n] * s * width;
      }
    }
  }
  Eigen::MatrixXd moved(kPlaces, kPressures + 1);
  Eigen::VectorXd asked(kPlaces);
  for (std::size_t j = 0; j < kPlaces; ++j) {
    const double theta = std::asin(sharp * std::sin(0.5 * std::numbers::pi * (static_cast<double>(j) + 0.5) / kPlaces));
    const ball_plates::Legendre p(theta, terms);
    const auto row = static_cast<Eigen::Index>(j);
    for (std::size_t k = 0; k < kPressures; ++k) {
      double down = 0.0;
      for (std::size_t n = 0; n <= terms; n += 2) {
        const BallMode u = ball_mode(n, radial[k][n], along[k][n], R, tissue);
        down += u.radial * p.value[n] * std::cos(theta) - u.along * p.slope[n] * std::sin(theta);
      }
      moved(row, static_cast<Eigen::Index>(k)) = down * tissue.youngs_modulus;
    }
    moved(row, kPressures) = R;
    asked[row] = R * (1.0 - std::cos(theta));
  }
  const Eigen::VectorXd found = moved.colPivHouseholderQr().solve(asked);  // c_k / E, d / R
  PressedBall out;
  out.approach = R * found[kPressures];
  out.unevenness = (moved * found - asked).cwiseAbs().maxCoeff();
  for (std::size_t k = 0; k < kPressures; ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    out.pressure_terms.push_back(tissue.youngs_modulus * found[at]);
    out.force += out.pressure_terms.back() * total[at];
  }
  const double nu = tissue.poisson_ratio;
  out.hertz = 4.0 / 3.0 * tissue.youngs_modulus / (1.0 - nu * nu) * std::sqrt(R) * std::pow(out.approach, 1.5);
  return out;
}

}  // namespace glisson
