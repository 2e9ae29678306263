// smooth.h — polynomials through neighbouring points: smoothing, and the noise about them.
#pragma once

#include <span>
#include <vector>

namespace glisson::fit {

/// A least-squares polynomial through each point and its neighbours, at that point; at the ends the window stays as wide
/// and lies to one side, so that polynomials up to the degree come out unchanged everywhere. Points need not be even.
struct LocalFit {
  std::vector<double> values;
  std::vector<double> leverage;  ///< weight of a point in its own value, 0 to 1
};
/// @param x  ascending @param half_width  points on each side, > 0 @param degree  below 2 half_width + 1
LocalFit local_fit(std::span<const double> x, std::span<const double> y, std::size_t half_width, std::size_t degree);

/// Median of each point and its neighbours; fewer at the ends. Takes out spikes shorter than the half-width.
std::vector<double> running_median(std::span<const double> y, std::size_t half_width);

/// Standard deviation of y about a smooth curve, from the median distance to a local parabola.
///   s = 1.4826 median |rᵢ| / √(1 − hᵢ),  r the residual, h the leverage
/// Spikes of one row, above 5 s and above their neighbours, are taken out and s formed again. Noise that varies more
/// slowly than a window of 15 rows is not seen.
/// @return 0 where there are fewer than 7 points
double noise_about_curve(std::span<const double> x, std::span<const double> y);

double median_of(std::vector<double> values);

}  // namespace glisson::fit
