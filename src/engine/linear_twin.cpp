#include "engine/linear_twin.h"

#include "glisson/material/linear_law.h"

namespace glisson::engine {

LinearTwin linear_twin(const TissueBlock& block, const TissuePlan& plan, const ResponseKernels& kernels) {
  TissueBlock twin = make_block(linear_law(block.tissue), block.begin, block.end);
  TissuePlan twin_plan = tissue_plan(twin, kernels);
  const LaneResponse lanes = lane_response(block.tissue, plan.tissue, plan.laws - 1);
  ResponsePlan whole{Response(block.tissue), lanes, respond_stage(kernels, block.tissue), {}, false, !lanes.constant};
  return {std::move(twin), std::move(twin_plan), std::move(whole)};
}

}  // namespace glisson::engine
