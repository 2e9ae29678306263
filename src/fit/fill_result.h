// fill_result.h — what a law's optimum means: curves, intervals, profiles, verdicts, next experiments, in one result.
#pragma once

#include "fit/laws/law_search.h"
#include "glisson/fit.h"

namespace glisson::fit {

/// Curves and their errors at the optimum.
void fill_curves(const LawSearch& search, const FitSpec& spec, const FitCurves& curves, FitResult& result);

/// Optimum, starts, basins, forward model.
void fill_search(const LawSearch& search, const FitSpec& spec, FitResult& result);

/// Intervals by curvature, profile and bootstrap, correlations, verdicts, designs, and sentences on all of it. A lower cost
/// found on the way becomes the optimum and all begins again, three times at most.
void fill_proof(LawSearch& search, const FitSpec& spec, const FitCurves& curves, const FitRun& options,
                FitResult& result);

}  // namespace glisson::fit
