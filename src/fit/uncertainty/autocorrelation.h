// autocorrelation.h — how many independent samples a curve's residuals are worth.
//
// A machine writes 500 samples a second, but a law that misfits leaves residuals that swing slowly: neighbours say the same
// thing twice. n samples with a correlation time τ count as n / τ.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace glisson::fit {

/// Autocorrelation of a series about zero: ρ_k = Σ_i x_i x_{i+k} / Σ_i x_i², k = 0 … lags (fewer where the series is shorter).
/// About zero, not about the mean: a curve that lies off as a whole is one sample, not many.
std::vector<double> autocorrelation(std::span<const double> series, std::size_t lags);

/// Samples that count as one: the larger of two estimates of τ = 1 + 2 Σ_k ρ_k, between 1 and the length.
///
///   initial positive sequence: sums of pairs ρ_2k + ρ_2k+1 until one is not positive      [Geyer1992]
///   first order: τ = (1 + ρ) / (1 − ρ), ρ from ρ_1, whose bias by a fit of p smooth shapes
///   is −(2ρ + p (1 + ρ)) / n; p = 1 is the known −(1 + 3ρ) / n                            [MarriottPope1954]
///
/// The first alone is short of τ, for the fit has taken the slowest swings out of its residuals.
/// @param parameters  fitted to this series: those of the fit, shared among its curves
double correlation_time(std::span<const double> series, double parameters);

/// Probability that independent samples show autocorrelations at least as large: small where they are not independent.
///
///   Q = n (n + 2) Σ_k ρ_k² / (n − k), χ² with as many degrees of freedom as lags            [LjungBox1978]
///
/// summed over the series, with up to ten lags of each.
double independence_probability(const std::vector<std::vector<double>>& series);

}  // namespace glisson::fit
