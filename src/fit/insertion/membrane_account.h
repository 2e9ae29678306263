// membrane_account.h — what a fit of membranes means: values, curve, sentences, and the text for a scene.
#pragma once

#include "fit/insertion/membrane_search.h"
#include "glisson/fit.h"

namespace glisson::fit {

void fill_result(const MembraneFit& fit, const MeasuredInsertion& measured, const InsertionSpec& spec, double speed,
                 FitResult& result);

}  // namespace glisson::fit
