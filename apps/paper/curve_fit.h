// curve_fit.h — polynomials through force curves, and how well they fit; the risers of a staircase.
#pragma once

#include <span>
#include <vector>

namespace glisson::app {

struct PolynomialFit {
  std::vector<double> coefficients;  ///< of 1, x, x², …
  double r2 = 0.0;                   ///< 1 − residual sum of squares / total sum of squares
  double operator()(double x) const;
};

/// Least squares by a polynomial of the given degree; solved on x scaled to [−1, 1], so it is well conditioned for
/// the low degrees meant here.
/// @throws std::invalid_argument for fewer points than coefficients
PolynomialFit fit_polynomial(std::span<const double> x, std::span<const double> y, int degree);

/// y at `at` by straight lines between points of increasing x; the first or last y outside them.
double interpolate(std::span<const double> x, std::span<const double> y, double at);

/// A stretch of a curve of even samples that climbs by more than twice the median increment; stretches with at most two
/// slower increments between them are one.
struct Riser {
  std::size_t first, last;  ///< increments y[i + 1] − y[i]
  double height;            ///< beyond the median pace, in units of y
};

/// The risers of at least a fiftieth of the last y: a staircase has several, a smooth curve none.
std::vector<Riser> risers(std::span<const double> y);

/// The middle value. @param values  one or more
double median(std::vector<double> values);

}  // namespace glisson::app
