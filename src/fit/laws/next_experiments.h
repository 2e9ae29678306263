// next_experiments.h — tests that could be made next, and what each would leave of the widest interval.
#pragma once

#include <vector>

#include "fit/laws/law_search.h"
#include "fit/uncertainty/covariance.h"
#include "glisson/fit.h"

namespace glisson::fit {

/// The motion of a test as a curve without force: up to a depth at one speed, then rest. 60 points.
Curve planned_curve(const ExperimentSpec& experiment);

/// Tests about those that were made: repeated, slower, faster, shallower, deeper, held.
/// @param deepest  no test goes farther [m]
std::vector<ExperimentSpec> usual_experiments(const std::vector<Curve>& fitted, double deepest);

/// The fit's own [[experiment]], or the usual ones, best first; those that cannot be simulated are left out.
std::vector<DesignResult> next_experiments(const LawSearch& search, const FitSpec& spec, const Covariance& covariance);

}  // namespace glisson::fit
