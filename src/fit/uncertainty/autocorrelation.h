// autocorrelation.h — whether residuals are independent.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace glisson::fit {

/// Autocorrelation of a series about zero: ρ_k = Σ_i x_i x_{i+k} / Σ_i x_i², k = 0 … lags (fewer where the series is shorter).
/// About zero, not about the mean: a curve that lies off as a whole is one sample, not many.
std::vector<double> autocorrelation(std::span<const double> series, std::size_t lags);

/// Probability that independent samples show autocorrelations at least as large: small where they are not independent.
///
///   Q = n (n + 2) Σ_k ρ_k² / (n − k), χ² with as many degrees of freedom as lags            [LjungBox1978]
///
/// summed over the series, with up to ten lags of each.
double independence_probability(const std::vector<std::vector<double>>& series);

}  // namespace glisson::fit
