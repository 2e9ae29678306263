// submesh_response.cpp — the elements of a submesh whose tissue is more than the paper's: H → P → forces.
#include <algorithm>
#include <cmath>

#include "engine/layout/response_batches.h"
#include "engine/submesh_scratch.h"

namespace glisson::engine {

std::unique_ptr<SubmeshBody::LargePlan> SubmeshBody::large_plan_of(const TissueBlock& block, const Plan& plan) const {
  if (block.tissue.is_tensor_mass()) return nullptr;
  const LaneResponse lanes = lane_response(block.tissue, plan.tissue, plan.laws - 1);
  return std::make_unique<LargePlan>(LargePlan{Response(block.tissue),
                                               lanes,
                                               respond_stage(*kernels_.response, block.tissue),
                                               {},
                                               in_one_pass(block.tissue),
                                               !lanes.constant || !lanes.pace.empty()});
}

/// Weights of all branches for a step of h from the state that is asked for.
void SubmeshBody::set_maxwell_step(double h) {
  for (const auto& plan : large_plans_) {
    if (plan == nullptr) continue;
    const std::vector<MaxwellBranch>& branches = plan->response.tissue().maxwell;
    for (std::size_t k = 0; k < branches.size(); ++k) {
      plan->maxwell.previous[k] = lane_weights(since_memory_, branches[k].time);
      plan->maxwell.next[k] = lane_weights(h, branches[k].time);
    }
    plan->maxwell.since = float(since_memory_);
    plan->maxwell.relaxed = std::isinf(since_memory_);
    plan->maxwell.moves = h > 0.0;
  }
}

void SubmeshBody::list_response(const Submesh& part, std::size_t batch, std::size_t n, const ResponseBlock& out,
                                Findings& found) const {
  const std::uint32_t* element = part.chains.element.data() + batch * kernels_.lanes * kChainTets;
  const double limit = list_limit(part.block);
  std::array<std::uint16_t, kBlockTets> which;
  const ListLimits limits{static_cast<float>(limit * double(kBelowLimit)), single_limits_.data(), element};
  const std::size_t few = kernels_.response->list_above(n * kChainTets, out, limits, which.data());
  for (std::size_t k = 0; k < few; ++k) {
    const std::size_t i = which[k];
    const double ratio = double(out.ratio[i]);
    if (element[i] != kNoElement && ratio > limit) list(found, {element[i], ratio, double(out.norm[i])});
  }
}

/// Tissue of small strain with branches, its stresses in one pass.
void SubmeshBody::push_relaxing(std::size_t s, bool split, Scratch& scratch, Findings& found) {
  Submesh& part = submeshes_.parts[s];
  const Plan& plan = plans_[part.block];
  const LargePlan& large = *large_plans_[part.block];
  const LaneResponse& lanes = large.lanes;
  const Elements elements = elements_of(part, scratch);
  const std::size_t tets = kernels_.lanes * kChainTets, numbers = memory_numbers(large.response.tissue());
  const StressPass pass = kernels_.response->relaxing_small[lanes.constant ? 0 : 1][split ? 1 : 0];
  const auto gather = lanes.viscous ? kernels_.gather_viscous : kernels_.gather_elastic;
  Block& block = scratch.block;
  ResponseBlock& out = scratch.response;
  for (std::size_t b = 0; b < part.chains.count; b += kBlockBatches) {
    const std::size_t n = std::min(kBlockBatches, part.chains.count - b);
    gather(elements, b, n, block);
    bool inverted = false;
    if (large.measured) {
      inverted = kernels_.measure[plan.measure](elements, b, n, block);
      run_laws(plan, n * tets, block);
    }
    const ResponseItems items{
        .gradient = block.gradient, .memory = part.memory.data() + b * tets * numbers, .items = n * kChainTets};
    const PassFound here = pass(items, lanes, large.maxwell, block, out);
    if (inverted || here.inverted) list_inverted(part, b, n, block, found);
    found.stiffening = std::max(found.stiffening, double(here.stiffest));
    if (large.measured && double(here.stiffest) > list_limit(part.block)) list_response(part, b, n, out, found);
    kernels_.push_stress(elements, b, n, out.piola, scratch.elastic.data());
    if (split) kernels_.push_stress(elements, b, n, block.viscous, scratch.viscous.data());
  }
}

/// 1/τ of each branch at the measures of a block.
void SubmeshBody::run_paces(const LaneResponse& lanes, std::size_t values, const Block& block,
                            ResponseBlock& out) const {
  for (std::size_t k = 0; k < lanes.branches; ++k) {
    const LanePace& pace = lanes.pace[k];
    kernels_.response->pace[pace.kind](pace, block.x, values, out.pace[k]);
  }
}

void SubmeshBody::push_response(std::size_t s, bool split, Scratch& scratch, Findings& found) {
  Submesh& part = submeshes_.parts[s];
  const Plan& plan = plans_[part.block];
  const LargePlan& large = *large_plans_[part.block];
  if (large.one_pass && !large.maxwell.relaxed) return push_relaxing(s, split, scratch, found);
  const LaneResponse& lanes = large.lanes;
  const ResponseKernels& stages = *kernels_.response;
  const Elements elements = elements_of(part, scratch);
  const Rescue to{&body_, &large.response};
  const std::size_t tets = kernels_.lanes * kChainTets, numbers = memory_numbers(large.response.tissue());
  const bool shared = shares_volume(part);
  if (shared) join_volume(s);
  ResponseBlock& out = scratch.response;
  for (std::size_t b = 0; b < part.chains.count; b += kBlockBatches) {
    const std::size_t n = std::min(kBlockBatches, part.chains.count - b);
    const ResponseItems items{.gradient = scratch.block.gradient,
                              .rate = scratch.rate,
                              .mean = shared ? scratch.mean : nullptr,
                              .fibre = part.fibre.data() + (part.fibre.empty() ? 0 : b * tets * 3),
                              .memory = part.memory.data() + b * tets * numbers,
                              .element = part.chains.element.data() + b * tets,
                              .items = n * kChainTets};
    if (lanes.viscous) {
      kernels_.gather_rates(elements, b, n, scratch.block, scratch.rate);
    } else {
      kernels_.gather_elastic(elements, b, n, scratch.block);
    }
    if (shared) {
      const std::uint16_t* index = part.chains.index.data() + b * kChainVertices * kernels_.lanes;
      stages.mean_of_vertices(index, n, shared_volumes_[s].theta.data(), scratch.mean);
    }
    if (large.measured) {
      kernels_.measure[plan.measure](elements, b, n, scratch.block);
      run_laws(plan, n * tets, scratch.block);
    }
    if (large.respond(items, lanes, to, scratch.block, out)) list_inverted(part, b, n, scratch.block, found);
    if (lanes.fibre > 0.0F) stages.fibres(items, lanes, out);
    if (!lanes.pace.empty()) {
      run_paces(lanes, n * tets, scratch.block, out);
      stages.following(items, lanes, large.maxwell, out);
    } else if (lanes.branches > 0) {
      stages.maxwell(items, lanes, large.maxwell, out);
    }
    if (lanes.viscous) stages.viscous(items, lanes, lanes.branches > 0, out);
    const float stiffest = stages.stiffest(items.items, out);
    found.stiffening = std::max(found.stiffening, double(stiffest));
    if (double(stiffest) > list_limit(part.block)) list_response(part, b, n, out, found);
    if (plan.viscous && !split) stages.merge(items.items, out);
    kernels_.push_piola(elements, b, n, out.piola, scratch.elastic.data());
    if (split) kernels_.push_piola(elements, b, n, out.viscous, scratch.viscous.data());
  }
}

}  // namespace glisson::engine
