// left_out.h — how far a law errs on a specimen that its fit has not seen: each fitted curve left out in turn.
#pragma once

#include <vector>

#include "fit/search/least_squares.h"

namespace glisson::fit {

/// The rms error on each fitted curve of a fit to the others in their unit (common_unit), from the optimum of all; infinite where the model fails.
/// Nothing where fewer than three curves are fitted, or where `stop` is set. Cost: a short descent for each curve.
std::vector<double> left_out_errors(const Problem& problem, const Optimum& optimum, const DescentOptions& options);

}  // namespace glisson::fit
