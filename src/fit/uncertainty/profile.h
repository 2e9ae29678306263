// profile.h — how far a parameter can go before the curves object, the others free to make up for it.
//
//   cost
//    │ \              /        the profile: least cost with this parameter held
//    │──\────────────/──────   threshold: cost* + ½ cost_unit · inflation · t²
//    │   \          /
//    │    `--.__.--'           open where it stays below up to the parameter's bound
//    └────[──────]──────── z
#pragma once

#include <atomic>
#include <span>
#include <string>
#include <vector>

#include "fit/search/least_squares.h"
#include "fit/uncertainty/covariance.h"

namespace glisson::fit {

struct ProfilePoint {
  std::vector<double> scaled;  ///< z of all parameters
  double value = 0.0;          ///< of the profiled one, in its unit
  double cost = 0.0;
};

struct Profile {
  std::size_t parameter = 0;
  std::vector<ProfilePoint> points;        ///< ascending; the optimum among them
  double threshold = 0.0;                  ///< cost at the interval's ends
  Interval interval;                       ///< where the profile is below the threshold; own unit
  bool flat = false;                       ///< the whole range costs next to nothing: no data of this kind will tell
  double flat_low = 0.0, flat_high = 0.0;  ///< where it is flat, in its unit; equal where it is not
  /// Other parameters that stand at a bound at the interval's end: the end is theirs as much as the curves'.
  std::vector<std::size_t> low_leans_on, high_leans_on;
  std::string low_failure, high_failure;  ///< why the walk ended early: a forward run failed there, or it was stopped
};

struct Profiles {
  std::vector<Profile> of;     ///< one for each parameter
  std::vector<double> better;  ///< z of a lower cost than the optimum's, found on the way; empty: none
  double better_cost = 0.0;
};

struct ProfileOptions {
  int most_iterations = 40;  ///< of each descent
  int most_points = 40;      ///< on each side
  double tolerance = 1e-10;  ///< of each descent
  bool secant = false;       ///< of each descent, where runs are dear
  double step = 0.35;        ///< aim of a step, as a part of the way to the threshold in √Δcost
  const std::atomic<bool>* stop = nullptr;
};

/// Profile likelihood of every parameter, walked outward from the optimum to the threshold or the bound.
/// [VenzonMoolgavkar1988]; flat and open profiles as in [Raue2009]
///
///   2 (cost(z_p) − cost*) ≤ cost_unit · inflation_p · t²,   t² = F(1, freedom), as the covariance has them
///
/// Each descent starts from the line through the last two points; ends are found to 1e-3 of the way, then interpolated in
/// √Δcost, which is straight for a linear model. Parameters and sides go in parallel, with the same bytes on any number of
/// threads. A point whose forward run fails halves the step; the side ends there after ten halvings, open.
/// @param optimum  of the same problem, converged: a lower cost found on the way comes back as `better`
Profiles profiles(const Problem& problem, const Optimum& optimum, const Covariance& covariance,
                  const ProfileOptions& options = {});

}  // namespace glisson::fit
