#include "fit/laws/forecast.h"

#include <algorithm>

#include "fit/uncertainty/local_problem.h"

namespace glisson::fit {
namespace {

// Seen in fits of one to five parameters: iterations of a descent from a start, from a profile's last point and from the
// optimum of the curves that replicates are drawn from; points of one side of a profile.
constexpr std::size_t kFewIterations = 8, kManyIterations = 14, kProfileIterations = 3, kReplicateIterations = 2;
constexpr std::size_t kProfilePoints = 6;
constexpr std::size_t kFewDerivativeSteps = 2, kDerivativeSteps = 4;  // derivative_check.cpp
constexpr std::size_t kPlans = 7;                                     // next_experiments.cpp

/// Runs of one motion, at least and at most.
struct Range {
  std::size_t least = 0, most = 0;
};

/// One descent. Where derivatives are carried along (secant_descent.h) it takes so many steps, with one-sided differences once
/// or some times on the way and central ones at the end.
Range descent_runs(bool dear, std::size_t p) {
  constexpr std::size_t kFewSteps = 7, kManySteps = 20, kManyRenewals = 4;
  if (dear) return {kFewSteps + 3 * p, kManySteps + (kManyRenewals + 2) * p};
  return {kFewIterations * (2 * p + 2), kManyIterations * (2 * p + 2)};
}

}  // namespace

FitForecast forecast_of(const LawSearch& search, const FitSpec& spec, std::size_t known) {
  const Ladder& ladder = search.ladder();
  const auto [motions, p] = search.runs_at_once();
  const std::size_t all = search.problem().parameters().size(), jacobian = 2 * p + 1, step = jacobian + 1;
  const auto starts = static_cast<std::size_t>(spec.search.starts);
  const auto wanted = static_cast<std::size_t>(spec.search.found_again > 0 ? spec.search.found_again : starts);
  const auto screen = static_cast<std::size_t>(std::max(1, spec.search.screen));
  const auto left = [known](std::size_t count) { return count > known ? count - known : 0; };
  const std::size_t walks = 2 * all * kProfilePoints * kProfileIterations * (2 * p) +
                            static_cast<std::size_t>(spec.proof.bootstrap) * kReplicateIterations * step;
  const bool spared = ladder.taken().kind != RungKind::specimen;
  const std::size_t cubic = LocalModel::runs_for(all) + 2 * all;
  const std::size_t plans = spec.proof.next ? kPlans * jacobian : 0, proof = spec.proof.profiles ? walks : 0;
  FitForecast forecast{.law = search.law().name, .forward = ladder.taken().name};
  const Range descent = descent_runs(search.dear(), p);
  const std::size_t few = search.dear() ? kFewDerivativeSteps : kDerivativeSteps;
  forecast.least_runs = motions * (few * 2 * p + 1 + left(std::min(wanted, starts)) * (screen + descent.least) +
                                   (spared ? std::min(cubic, proof) : proof)) +
                        plans;
  forecast.most_runs =
      motions * (kDerivativeSteps * 2 * p + 1 + left(starts) * (screen + descent.most) + proof) + plans;
  if (!ladder.compared.empty()) forecast.run_s = ladder.taken().cost / static_cast<double>(ladder.compared.size());
  return forecast;
}

}  // namespace glisson::fit
