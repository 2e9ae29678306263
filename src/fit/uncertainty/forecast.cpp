#include "fit/uncertainty/forecast.h"

#include <algorithm>

#include "fit/search/local_problem.h"

namespace glisson::fit {
namespace {

// Seen in fits of one to five parameters: iterations of a descent from a start, from a profile's last point and from the
// optimum of the curves that replicates are drawn from; points of one side of a profile.
constexpr std::size_t kFewIterations = 8, kManyIterations = 14, kProfileIterations = 3, kReplicateIterations = 2;
constexpr std::size_t kProfilePoints = 6;
constexpr std::size_t kDerivativeSteps = 4;  // derivative_check.cpp
constexpr std::size_t kPlans = 7;            // next_experiments.cpp

/// Motions that differ, among the fitted curves: each takes a run of its own.
std::size_t motions_of(const Problem& problem) {
  std::size_t count = 0;
  const std::vector<Curve>& curves = problem.curves();
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const auto same = [&](const Curve& other) {
      return other.time == curves[c].time && other.displacement == curves[c].displacement;
    };
    if (std::none_of(curves.begin(), curves.begin() + static_cast<std::ptrdiff_t>(c), same)) ++count;
  }
  return count;
}

}  // namespace

FitForecast forecast_of(const LawSearch& search, const FitSpec& spec, std::size_t known) {
  const Ladder& ladder = search.ladder();
  const std::size_t p = search.problem().parameters().size(), motions = motions_of(search.problem());
  const std::size_t jacobian = 2 * p + 1, step = jacobian + 1;
  const auto starts = static_cast<std::size_t>(spec.search.starts);
  const auto wanted = static_cast<std::size_t>(spec.search.found_again > 0 ? spec.search.found_again : starts);
  const auto screen = static_cast<std::size_t>(std::max(1, spec.search.screen));
  const auto left = [known](std::size_t count) { return count > known ? count - known : 0; };
  const std::size_t walks = 2 * p * kProfilePoints * kProfileIterations * (2 * p) +
                            static_cast<std::size_t>(spec.proof.bootstrap) * kReplicateIterations * step;
  const bool dear = ladder.taken().name != "specimen";
  const std::size_t cubic = LocalModel::runs_for(p) + 2 * p;
  const std::size_t plans = spec.proof.next ? kPlans * jacobian : 0, proof = spec.proof.profiles ? walks : 0;
  FitForecast forecast{.law = search.law().name, .forward = ladder.taken().name};
  const std::size_t common = kDerivativeSteps * 2 * p + 1;
  forecast.least_runs = motions * (common + left(std::min(wanted, starts)) * (screen + kFewIterations * step) +
                                   (dear ? std::min(cubic, proof) : proof)) +
                        plans;
  forecast.most_runs = motions * (common + left(starts) * (screen + kManyIterations * step) + proof) + plans;
  if (!ladder.compared.empty()) forecast.run_s = ladder.taken().cost / static_cast<double>(ladder.compared.size());
  return forecast;
}

}  // namespace glisson::fit
