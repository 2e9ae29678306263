#include "engine/tissue_plan.h"

#include <cmath>

namespace glisson::engine {

TissuePlan tissue_plan(const TissueBlock& block, const ResponseKernels& kernels) {
  const Tissue& tissue = block.tissue;
  const double lambda = block.elastic.lambda, mu = block.elastic.mu;
  TissuePlan plan;
  plan.tissue = {.lambda = float(lambda),
                 .mu = float(mu),
                 .viscous_lambda = float(block.viscous.lambda),
                 .viscous_mu = float(block.viscous.mu),
                 .bulk_over_two_mu = float((lambda + 2.0 / 3.0 * mu) / (2.0 * mu)),
                 .rest_mu = float(mu)};
  plan.measure = static_cast<std::size_t>(tissue.measure);
  plan.viscous = tissue.viscosity > 0.0 || !tissue.maxwell.empty();
  plan.drags = tissue.viscosity > 0.0;
  if (tissue.lambda_law || tissue.mu_law) {
    plan.laws = 2;
    plan.law = {lane_law(tissue.lambda_law.value_or(ConstantLaw{}), lambda, 1.0),
                lane_law(tissue.mu_law.value_or(ConstantLaw{}), mu, 1.0)};
    plan.tissue.lambda = plan.tissue.mu = 1.0F;
  } else {
    plan.law[0] = lane_law(tissue.law, tissue.youngs_modulus, tissue.youngs_modulus);
  }
  if (tissue.is_tensor_mass()) return plan;
  const LaneResponse lanes = lane_response(tissue, plan.tissue, plan.laws - 1);
  plan.response = std::make_unique<ResponsePlan>(ResponsePlan{Response(tissue),
                                                              lanes,
                                                              respond_stage(kernels, tissue),
                                                              {},
                                                              in_one_pass(tissue),
                                                              !lanes.constant || !lanes.pace.empty()});
  return plan;
}

void ResponsePlan::set_step(double h, double since) {
  const std::vector<MaxwellBranch>& branches = response.tissue().maxwell;
  for (std::size_t k = 0; k < branches.size(); ++k) {
    maxwell.previous[k] = lane_weights(since, branches[k].time);
    maxwell.next[k] = lane_weights(h, branches[k].time);
  }
  maxwell.since = float(since);
  maxwell.relaxed = std::isinf(since);
  maxwell.moves = h > 0.0;
}

}  // namespace glisson::engine
