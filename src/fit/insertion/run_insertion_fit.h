// run_insertion_fit.h — a fit of [insertion] from its description to its result.
#pragma once

#include "fit/spec/fit_run.h"
#include "fit/spec/fit_spec.h"

namespace glisson::fit {

FitResult run_insertion_fit(const FitSpec& spec, const FitRun& options);

}  // namespace glisson::fit
