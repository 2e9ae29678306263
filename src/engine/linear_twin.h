// linear_twin.h — a tissue's linear law (glisson/material/linear_law.h) as it is evaluated in lanes, and its own, for the two to be compared.
#pragma once

#include "engine/tissue_plan.h"

namespace glisson::engine {

struct LinearTwin {
  TissueBlock block;   ///< of the linear law, with the elements of the original
  TissuePlan plan;     ///< of the linear law
  ResponsePlan whole;  ///< of the original: for its stress, whichever stages its forces take
};

/// @param block  of a tissue that has_linear_law() @param plan  its own
LinearTwin linear_twin(const TissueBlock& block, const TissuePlan& plan, const ResponseKernels& kernels);

}  // namespace glisson::engine
