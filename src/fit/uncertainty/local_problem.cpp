#include "fit/uncertainty/local_problem.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "fit/data/units.h"

namespace glisson::fit {
namespace {

constexpr double kReach = 1.7;          // of the intervals: profiles go beyond their ends to enclose them
constexpr double kAllowedError = 0.01;  // of a curve's spread
constexpr double kAllowedMiss = 0.01;   // of a profile's rise

std::vector<std::size_t> indices_of(const Problem& problem) {
  std::vector<std::size_t> list;
  for (std::size_t c = 0; c < problem.curves().size(); ++c) list.push_back(problem.model_index(c));
  return list;
}

/// The intervals along the directions that the curves tell apart, in values; none where they are not a region.
std::optional<Region> region_of(const Problem& problem, const Covariance& c) {
  const std::size_t n = c.parameters();
  if (!c.failure.empty() || c.directions.size() != n) return {};
  const std::vector<double> slopes = problem.value_slopes(c.scaled);
  Region region{problem.to_values(c.scaled), {}};
  std::vector<double> reach(n, 0.0);
  for (const Direction& d : c.directions) {
    if (!d.determined || !(d.sd > 0.0) || !std::isfinite(d.sd)) return {};
    std::vector<double> axis(n);
    for (std::size_t p = 0; p < n; ++p) {
      axis[p] = kReach * c.quantile * d.sd * d.vector[p] * slopes[p];
      reach[p] += std::abs(axis[p]);
    }
    region.axes.push_back(std::move(axis));
  }
  for (std::size_t p = 0; p < n; ++p) {
    const Parameter& x = problem.parameters()[p];
    if (region.centre[p] - reach[p] < x.low || region.centre[p] + reach[p] > x.high) return {};
  }
  return region;
}

/// The point of a profile nearest to an end of its interval.
const ProfilePoint& nearest(const Profile& profile, double end) {
  return *std::min_element(
      profile.points.begin(), profile.points.end(),
      [&](const ProfilePoint& a, const ProfilePoint& b) { return std::abs(a.value - end) < std::abs(b.value - end); });
}

}  // namespace

LocalProblem::LocalProblem(const Problem& problem, Region region)
    : inner_(problem), model_(problem.model(), indices_of(problem), std::move(region)),
      problem_(std::make_unique<Problem>(problem.parameters(), problem.curves(), indices_of(problem), problem.spread(),
                                         model_, problem.loss())) {
  problem_->difference_step = problem.difference_step;
}

std::unique_ptr<LocalProblem> LocalProblem::about(const Problem& problem, const Covariance& covariance) {
  std::optional<Region> region = region_of(problem, covariance);
  if (!region) return nullptr;
  std::unique_ptr<LocalProblem> local(new LocalProblem(problem, std::move(*region)));
  if (!local->model_.failure().empty()) return nullptr;
  for (std::size_t c = 0; c < problem.curves().size(); ++c) {
    if (local->model_.error(problem.model_index(c)) > kAllowedError * problem.spread()[c]) return nullptr;
  }
  return local;
}

bool LocalProblem::holds(const Profiles& profiles, double best_cost) {
  missed_ = 0.0;
  for (const Profile& p : profiles.of) {
    if (p.points.empty()) continue;
    for (const auto& [end, open] :
         {std::pair(p.interval.low, p.interval.low_open), std::pair(p.interval.high, p.interval.high_open)}) {
      if (open) continue;
      const ProfilePoint& point = nearest(p, end);
      const Residuals r = inner_.residuals(point.scaled, false);
      if (r.values.empty()) return false;
      missed_ = std::max(missed_, std::abs(inner_.cost(r.values) - point.cost) / (p.threshold - best_cost));
    }
  }
  return missed_ <= kAllowedMiss;
}

std::string LocalProblem::words() const {
  return "Profiles and bootstrap follow a cubic through " + std::to_string(model_.points()) +
         " runs about the optimum; where the intervals end its cost differs from the model's by at most " +
         brief(100.0 * missed_, 2) + " % of the rise.";
}

}  // namespace glisson::fit
