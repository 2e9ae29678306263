#include "fit/search/multi_start.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <limits>
#include <random>

namespace glisson::fit {
namespace {

constexpr std::size_t kBatch = 4;
constexpr double kSameCost = 1e-3, kSamePlace = 0.02, kFlat = 1e-6;

/// Point n of a Sobol sequence, turned about the unit cube by the seed (Cranley and Patterson's rotation).
class Sequence {
 public:
  Sequence(std::size_t dimension, std::uint64_t seed) : dimension_(dimension), engine_(dimension) {
    std::mt19937_64 random(seed);
    for (std::size_t p = 0; p < dimension; ++p) shift_.push_back(boost::random::uniform_01<double>()(random));
  }
  std::vector<double> next() {
    std::vector<double> z(dimension_);
    for (std::size_t p = 0; p < dimension_; ++p) {
      const double x = boost::random::uniform_01<double>()(engine_) + shift_[p];
      z[p] = 0.01 + 0.98 * (x - std::floor(x));  // a start on a bound would be held there from the first step on
    }
    return z;
  }

 private:
  std::size_t dimension_;
  boost::random::sobol engine_;
  std::vector<double> shift_;
};

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t p = 0; p < a.size(); ++p) most = std::max(most, std::abs(a[p] - b[p]));
  return most;
}

double cost_at(const Problem& problem, const std::vector<double>& z) {
  const Residuals r = problem.residuals(z, false);
  return r.values.empty() ? std::numeric_limits<double>::infinity() : problem.cost(r.values);
}

/// Whether the cost does not rise on the way between two optima of the same cost.
bool flat_between(const Problem& problem, const Basin& basin, const Optimum& optimum) {
  for (const double share : {0.25, 0.5, 0.75}) {
    std::vector<double> z(basin.scaled.size());
    for (std::size_t p = 0; p < z.size(); ++p) z[p] = basin.scaled[p] + share * (optimum.scaled[p] - basin.scaled[p]);
    if (!(cost_at(problem, z) <= basin.cost * (1.0 + kSameCost) + kFlat)) return false;
  }
  return true;
}

bool belongs(const Problem& problem, const Basin& basin, const Optimum& optimum) {
  const double apart = optimum.cost - basin.cost;
  if (apart <= kSameCost * basin.cost + kFlat && distance(basin.scaled, optimum.scaled) <= kSamePlace) return true;
  return apart <= kFlat * (1.0 + basin.cost) && flat_between(problem, basin, optimum);
}

/// The best of the next few points of the sequence.
std::vector<double> screened(const Problem& problem, const std::vector<std::vector<double>>& points) {
  if (points.size() == 1) return points.front();
  std::vector<double> costs(points.size());
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) { costs[i] = cost_at(problem, points[i]); });
  const auto best = static_cast<std::size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin());
  return points[best];
}

bool enough(const MultiStart& result, int found_again) {
  return found_again > 0 && !result.basins.empty() && result.basins.front().found >= found_again;
}

}  // namespace

std::vector<Basin> basins_of(const Problem& problem, const std::vector<StartRecord>& starts) {
  std::vector<const Optimum*> order;
  for (const StartRecord& s : starts) {
    if (std::isfinite(s.optimum.cost)) order.push_back(&s.optimum);
  }
  std::stable_sort(order.begin(), order.end(), [](const auto* a, const auto* b) { return a->cost < b->cost; });
  std::vector<Basin> basins;
  for (const Optimum* o : order) {
    const auto own =
        std::find_if(basins.begin(), basins.end(), [&](const Basin& b) { return belongs(problem, b, *o); });
    if (own == basins.end())
      basins.push_back({o->scaled, o->cost, 1});
    else
      ++own->found;
  }
  return basins;
}

MultiStart find_optimum(const Problem& problem, const MultiStartOptions& options, std::vector<StartRecord> known,
                        const std::function<void(const MultiStart&)>& told) {
  MultiStart result;
  result.starts = std::move(known);
  const auto most = static_cast<std::size_t>(options.starts);
  if (result.starts.size() > most) result.starts.resize(most);
  const auto stopped = [&] { return options.descent.stop != nullptr && options.descent.stop->load(); };
  std::vector<double> own;
  for (const Parameter& p : problem.parameters()) own.push_back(p.start);
  Sequence sequence(own.size(), options.seed);
  const auto screen = static_cast<std::size_t>(std::max(1, options.screen));
  std::vector<std::vector<std::vector<double>>> candidates{{problem.to_scaled(own)}};
  while (candidates.size() < most) {
    candidates.emplace_back();
    for (std::size_t i = 0; i < screen; ++i) candidates.back().push_back(sequence.next());
  }
  result.basins = basins_of(problem, result.starts);
  while (result.starts.size() < most && !enough(result, options.found_again) && !stopped()) {
    const std::size_t first = result.starts.size(), last = std::min(most, (first / kBatch + 1) * kBatch);
    std::vector<StartRecord> batch(last - first);
    tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
      batch[i].from = screened(problem, candidates[first + i]);
      if (!stopped()) batch[i].optimum = descend(problem, batch[i].from, options.descent);
    });
    if (stopped()) break;  // a descent that was cut short is no optimum: it is made again
    std::move(batch.begin(), batch.end(), std::back_inserter(result.starts));
    result.basins = basins_of(problem, result.starts);
    if (told) told(result);
  }
  result.complete = result.starts.size() >= most || enough(result, options.found_again);
  return result;
}

}  // namespace glisson::fit
