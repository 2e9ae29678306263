// forecast.h — how many forward runs a fit will take, before it makes them.
#pragma once

#include "fit/laws/law_search.h"

namespace glisson::fit {

/// Counts what search and proof ask for: 2 p + 1 runs of each distinct motion for a Jacobian, one for each step tried; fewer
/// where derivatives are carried along, or read from a run that was made.
/// @param known  starts that an interrupted run has made
FitForecast forecast_of(const LawSearch& search, const FitSpec& spec, std::size_t known);

}  // namespace glisson::fit
