#include "fit/search/derivative_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace glisson::fit {
namespace {

constexpr std::array kSteps{1e-2, 1e-3, 1e-4, 1e-5};

/// The largest difference of a column, over its length; columns that are shorter than 1e-6 of the longest do not count.
double difference(const std::vector<double>& a, const std::vector<double>& b, std::size_t columns) {
  std::vector<double> apart(columns, 0.0), length(columns, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    apart[i % columns] += (a[i] - b[i]) * (a[i] - b[i]);
    length[i % columns] += b[i] * b[i];
  }
  const double longest = *std::max_element(length.begin(), length.end());
  double most = 0.0;
  for (std::size_t p = 0; p < columns; ++p) {
    if (length[p] > 1e-12 * longest) most = std::max(most, std::sqrt(apart[p] / length[p]));
  }
  return longest > 0.0 ? most : 0.0;
}

}  // namespace

DerivativeCheck check_derivatives(Problem& problem, std::span<const double> scaled, double enough) {
  const double before = problem.difference_step;
  DerivativeCheck best{0.0, std::numeric_limits<double>::infinity()};
  std::vector<double> wider;
  for (const double step : kSteps) {
    problem.difference_step = step;
    Residuals r = problem.residuals(scaled, true);
    if (r.jacobian.empty()) {  // a run beside the point failed: narrower steps may stay where the model runs
      if (best.step > 0.0) break;
      wider.clear();
      continue;
    }
    if (!wider.empty()) {
      const double error = difference(wider, r.jacobian, problem.parameters().size());
      if (error < best.error) best = {step, error};
      if (error > 10.0 * best.error) break;  // from here on it is rounding
      if (best.error <= enough) break;
    }
    wider = std::move(r.jacobian);
  }
  problem.difference_step = best.step > 0.0 ? best.step : before;
  return best;
}

}  // namespace glisson::fit
