#include "fit/uncertainty/autocorrelation.h"

#include <algorithm>

#include "fit/uncertainty/distribution.h"

namespace glisson::fit {
namespace {

double product_at(std::span<const double> x, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = 0; i + lag < x.size(); ++i) sum += x[i] * x[i + lag];
  return sum;
}

}  // namespace

std::vector<double> autocorrelation(std::span<const double> series, std::size_t lags) {
  const std::size_t n = series.size();
  std::vector<double> rho(n == 0 ? 0 : std::min(lags, n - 1) + 1, 0.0);
  for (std::size_t k = 0; k < rho.size(); ++k) rho[k] = product_at(series, k);
  if (rho.empty() || rho[0] == 0.0) return std::vector<double>(rho.size(), 0.0);
  const double squares = rho[0];
  for (double& r : rho) r /= squares;
  return rho;
}

double independence_probability(const std::vector<std::vector<double>>& series) {
  double sum = 0.0, freedom = 0.0;
  for (const std::vector<double>& x : series) {
    const auto n = static_cast<double>(x.size());
    const std::vector<double> rho = autocorrelation(x, std::min<std::size_t>(10, x.size() / 5));
    for (std::size_t k = 1; k < rho.size(); ++k) sum += n * (n + 2.0) * rho[k] * rho[k] / (n - static_cast<double>(k));
    freedom += rho.size() > 1 ? static_cast<double>(rho.size() - 1) : 0.0;
  }
  return freedom > 0.0 ? chi_squared_tail(sum, freedom) : 1.0;
}

}  // namespace glisson::fit
