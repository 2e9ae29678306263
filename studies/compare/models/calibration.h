// calibration.h — a law fitted to a tissue by tests that a laboratory makes: a specimen is pressed and pulled along its axis at constant
// volume,
//
//   F = diag(λ^−½, λ^−½, λ),   p = ∂W/∂λ = P_zz − λ^−³ᐟ² P_xx,
//
// the nominal stress of an incompressible bar. The bulk modulus has no part in it. λ goes from 1 to 0.7 and from 1 to 1.3, the range in
// which brain was pressed for [Miller2000]; all laws are fitted over it, by least squares of p.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "glisson/material/tissue.h"

namespace glisson::models {

inline constexpr double kMostStrain = 0.3;

/// A point of a test.
struct TestPoint {
  double stretch = 1.0;  ///< λ [-]
  double rate = 0.0;     ///< dλ/dt [1/s]
  double stress = 0.0;   ///< p [Pa]
};

/// The tissue as it is at once: without viscosity, its branches not yet relaxed.
Tissue at_once(const Tissue& tissue);

/// Both ways, each in `time` [s] at a constant rate. Of a tissue with neither branches nor viscosity p does not depend on it.
/// @throws std::invalid_argument for a tissue whose measure needs a mesh
std::vector<TestPoint> constant_volume_test(const Tissue& tissue, double time);

/// Terms c_k ≥ 0 of p = Σ c_k term_k that leave the least squares; at most two.
struct LinearFit {
  std::array<double, 2> factors{};
  double rest = 0.0;  ///< sum of squares that is left [Pa²]
};
using Term = std::function<double(const TestPoint&)>;
LinearFit fit_terms(const std::vector<TestPoint>& test, const Term& first, const Term& second);

/// The number between two bounds for which what is left is least; it is looked for evenly in its logarithm.
double least_over(double low, double high, const std::function<double(double)>& rest);

}  // namespace glisson::models
