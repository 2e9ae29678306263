// local_problem.h — a fit's problem about its optimum, with a cubic for its forward model where runs are dear.
//
//   optimum, covariance ──▶ region: 1.7 × the intervals along the directions of z ──▶ LocalModel ──▶ profiles, bootstrap
//                                                                                                        │
//                        the model itself, run where the intervals end ◀── within 1 % of the rise? ──────┘
#pragma once

#include <memory>
#include <string>

#include "fit/forward/local_model.h"
#include "fit/search/problem.h"
#include "fit/uncertainty/covariance.h"
#include "fit/uncertainty/profile.h"

namespace glisson::fit {

class LocalProblem {
 public:
  /// @param problem  must outlive this
  /// @return nullptr where a cubic cannot stand in: a parameter is held or not determined, the region would leave the bounds, a
  ///         run fails, or the cubic misses a run that it was not made from by more than 1 % of a curve's spread
  static std::unique_ptr<LocalProblem> about(const Problem& problem, const Covariance& covariance);

  const Problem& problem() const { return *problem_; }
  /// Whether the model itself costs the same where the intervals end, to 1 % of the rise there: the ends are then right to
  /// half a percent of their distance from the optimum. Runs the model once for each end.
  bool holds(const Profiles& profiles, double best_cost);
  /// What was done, and how far it is from the model; for the result.
  std::string words() const;

 private:
  LocalProblem(const Problem& problem, Region region);

  const Problem& inner_;
  LocalModel model_;
  std::unique_ptr<Problem> problem_;
  double missed_ = 0.0;  ///< cost at an end, as a part of its rise
};

}  // namespace glisson::fit
