// curve_fit.cpp — see curve_fit.h.
#include "paper/curve_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace glisson::app {
namespace {

/// Solves a symmetric positive definite system by Gaussian elimination with pivoting; a and b are used up.
std::vector<double> solve(std::vector<std::vector<double>> a, std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t column = 0; column < n; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column + 1; row < n; ++row) {
      if (std::abs(a[row][column]) > std::abs(a[pivot][column])) pivot = row;
    }
    std::swap(a[column], a[pivot]);
    std::swap(b[column], b[pivot]);
    for (std::size_t row = column + 1; row < n; ++row) {
      const double factor = a[row][column] / a[column][column];
      for (std::size_t k = column; k < n; ++k) a[row][k] -= factor * a[column][k];
      b[row] -= factor * b[column];
    }
  }
  std::vector<double> x(n);
  for (std::size_t row = n; row-- > 0;) {
    double sum = b[row];
    for (std::size_t k = row + 1; k < n; ++k) sum -= a[row][k] * x[k];
    x[row] = sum / a[row][row];
  }
  return x;
}

/// Residual over total sum of squares.
double unexplained(const PolynomialFit& fit, std::span<const double> x, std::span<const double> y) {
  const double mean = std::accumulate(y.begin(), y.end(), 0.0) / static_cast<double>(y.size());
  double residual = 0.0, total = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    residual += (y[i] - fit(x[i])) * (y[i] - fit(x[i]));
    total += (y[i] - mean) * (y[i] - mean);
  }
  return residual / total;
}

}  // namespace

double PolynomialFit::operator()(double x) const {
  double sum = 0.0;
  for (std::size_t i = coefficients.size(); i-- > 0;) sum = sum * x + coefficients[i];
  return sum;
}

PolynomialFit fit_polynomial(std::span<const double> x, std::span<const double> y, int degree) {
  const std::size_t n = static_cast<std::size_t>(degree) + 1;
  if (x.size() < n || x.size() != y.size()) throw std::invalid_argument("polynomial fit: too few points");
  double reach = 0.0;
  for (const double value : x) reach = std::max(reach, std::abs(value));
  std::vector<std::vector<double>> normal(n, std::vector<double>(n, 0.0));
  std::vector<double> right(n, 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    std::vector<double> power(n, 1.0);
    for (std::size_t k = 1; k < n; ++k) power[k] = power[k - 1] * x[i] / reach;
    for (std::size_t r = 0; r < n; ++r) {
      right[r] += power[r] * y[i];
      for (std::size_t c = 0; c < n; ++c) normal[r][c] += power[r] * power[c];
    }
  }
  PolynomialFit fit;
  fit.coefficients = solve(std::move(normal), std::move(right));
  for (std::size_t k = 0; k < n; ++k) fit.coefficients[k] /= std::pow(reach, static_cast<double>(k));
  fit.r2 = 1.0 - unexplained(fit, x, y);
  return fit;
}

double interpolate(std::span<const double> x, std::span<const double> y, double at) {
  const auto above = std::upper_bound(x.begin(), x.end(), at);
  if (above == x.begin()) return y.front();
  if (above == x.end()) return y.back();
  const std::size_t i = static_cast<std::size_t>(above - x.begin());
  return y[i - 1] + (y[i] - y[i - 1]) * (at - x[i - 1]) / (x[i] - x[i - 1]);
}

std::vector<Riser> risers(std::span<const double> y) {
  std::vector<double> increments(y.size());
  std::adjacent_difference(y.begin(), y.end(), increments.begin());
  increments.erase(increments.begin());
  const double pace = median(increments);
  std::vector<Riser> found;
  for (std::size_t i = 0; i < increments.size(); ++i) {
    if (increments[i] <= 2.0 * pace) continue;
    if (found.empty() || i - found.back().last > 3) found.push_back({i, i, 0.0});
    found.back().last = i;
  }
  for (Riser& r : found) r.height = y[r.last + 1] - y[r.first] - static_cast<double>(r.last + 1 - r.first) * pace;
  std::erase_if(found, [&](const Riser& r) { return r.height < 0.02 * y.back(); });
  return found;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace glisson::app
