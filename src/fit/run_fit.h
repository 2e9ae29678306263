// run_fit.h — a fit from its description to its result.
#pragma once

#include "fit/spec/fit_run.h"
#include "fit/spec/fit_spec.h"

namespace glisson::fit {

/// Runs a fit, as run_fit of glisson/fit.h does.
FitResult run_fit(const FitSpec& spec, const FitRun& run);

}  // namespace glisson::fit
