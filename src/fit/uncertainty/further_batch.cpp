#include "fit/uncertainty/further_batch.h"

#include <algorithm>
#include <cmath>

#include "fit/uncertainty/distribution.h"

namespace glisson::fit {
namespace {

constexpr double kAtBound = 1e-6;  // in z

/// Numbers of the curves of each batch that have a weight.
struct Batch {
  std::string name;
  std::vector<std::size_t> curves;
};

std::vector<Batch> batches_of(const std::vector<Curve>& curves) {
  std::vector<Batch> batches;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    if (curves[c].batch.empty() || !(curves[c].weight > 0.0)) continue;
    const auto known = std::ranges::find(batches, curves[c].batch, &Batch::name);
    if (known == batches.end())
      batches.push_back({curves[c].batch, {c}});
    else
      known->curves.push_back(c);
  }
  return batches;
}

Optimum optimum_of(const Batch& batch, const Problem& problem, std::span<const double> start,
                   const DescentOptions& options) {
  std::vector<Curve> own;
  for (const std::size_t c : batch.curves) own.push_back(problem.curves()[c]);
  return descend(*problem.with(std::move(own), batch.curves), start, options);
}

/// The prediction interval of a further number after these, in z; open where one of them stands at a bound.
Interval interval_after(const std::vector<double>& z, double level) {
  const auto n = static_cast<double>(z.size());
  double mean = 0.0, squares = 0.0;
  for (const double v : z) mean += v / n;
  for (const double v : z) squares += (v - mean) * (v - mean);
  const double half = student_quantile(0.5 * (1.0 + level), n - 1.0) * std::sqrt(squares / (n - 1.0) * (1.0 + 1.0 / n));
  const auto [least, most] = std::ranges::minmax(z);
  return {mean - half, mean + half, mean - half < 0.0 || least <= kAtBound,
          mean + half > 1.0 || most >= 1.0 - kAtBound};
}

}  // namespace

FurtherBatch further_batch(const Problem& problem, const Covariance& covariance, const DescentOptions& options) {
  FurtherBatch out;
  const std::vector<Batch> batches = batches_of(problem.curves());
  if (batches.size() < kFewestBatches || !covariance.failure.empty()) return out;
  std::vector<std::vector<double>> optima(covariance.parameters());
  for (const Batch& batch : batches) {
    const Optimum own = optimum_of(batch, problem, covariance.scaled, options);
    if (!std::isfinite(own.cost)) {
      out.failure = "Batch " + batch.name +
                    " could not be fitted by itself, so that nothing is said of a further one: " + own.message;
      return out;
    }
    for (std::size_t p = 0; p < optima.size(); ++p) optima[p].push_back(own.scaled[p]);
    out.batches.push_back(batch.name);
  }
  std::vector<double> low, high;
  for (std::size_t p = 0; p < optima.size(); ++p) {
    Interval z = interval_after(optima[p], covariance.level);
    if (covariance.hold[p] == Hold::free && covariance.determined[p] == 0) z = {0.0, 1.0, true, true};
    low.push_back(z.low_open ? 0.0 : z.low), high.push_back(z.high_open ? 1.0 : z.high);
    out.parameters.push_back(z);
  }
  const std::vector<double> values_low = problem.to_values(low), values_high = problem.to_values(high);
  for (std::size_t p = 0; p < optima.size(); ++p)
    out.parameters[p].low = values_low[p], out.parameters[p].high = values_high[p];
  return out;
}

}  // namespace glisson::fit
