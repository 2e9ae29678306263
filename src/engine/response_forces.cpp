// response_forces.cpp — the elements of a submesh whose tissue is more than the paper's: H → P → forces.
#include <algorithm>

#include "engine/element_forces.h"
#include "engine/layout/response_batches.h"

namespace glisson::engine {

void ElementForces::list_response(const Submesh& part, std::size_t batch, std::size_t n, const ResponseBlock& out,
                                  ElementFindings& found) const {
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
void ElementForces::push_relaxing(Submesh& part, bool split, SubmeshScratch& scratch, ElementFindings& found) const {
  const TissuePlan& plan = plans_[part.block];
  const ResponsePlan& large = *plan.response;
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
    if (inverted || here.inverted) inversions_.list(part.chains, b, n, block, found.inverted);
    found.stiffening = std::max(found.stiffening, double(here.stiffest));
    if (large.measured && double(here.stiffest) > list_limit(part.block)) list_response(part, b, n, out, found);
    if (split) {
      kernels_.push_stresses_apart(elements, b, n, out.piola, block.viscous);
    } else {
      kernels_.push_stress(elements, b, n, out.piola, scratch.elastic.data());
    }
  }
}

/// 1/τ of each branch at the measures of a block.
void ElementForces::run_paces(const LaneResponse& lanes, std::size_t values, const Block& block,
                              ResponseBlock& out) const {
  for (std::size_t k = 0; k < lanes.branches; ++k) {
    const LanePace& pace = lanes.pace[k];
    kernels_.response->pace[pace.kind](pace, block.x, values, out.pace[k]);
  }
}

void ElementForces::push_response(Submesh& part, bool split, const float* theta, SubmeshScratch& scratch,
                                  ElementFindings& found) const {
  const TissuePlan& plan = plans_[part.block];
  const ResponsePlan& large = *plan.response;
  if (large.one_pass && !large.maxwell.relaxed) return push_relaxing(part, split, scratch, found);
  const LaneResponse& lanes = large.lanes;
  const ResponseKernels& stages = *kernels_.response;
  const Elements elements = elements_of(part, scratch);
  const Rescue to{&body_, &large.response};
  const std::size_t tets = kernels_.lanes * kChainTets, numbers = memory_numbers(large.response.tissue());
  ResponseBlock& out = scratch.response;
  for (std::size_t b = 0; b < part.chains.count; b += kBlockBatches) {
    const std::size_t n = std::min(kBlockBatches, part.chains.count - b);
    const ResponseItems items{.gradient = scratch.block.gradient,
                              .rate = scratch.rate,
                              .mean = theta != nullptr ? scratch.mean : nullptr,
                              .fibre = part.fibre.data() + (part.fibre.empty() ? 0 : b * tets * 3),
                              .memory = part.memory.data() + b * tets * numbers,
                              .element = part.chains.element.data() + b * tets,
                              .items = n * kChainTets};
    if (lanes.viscous) {
      kernels_.gather_rates(elements, b, n, scratch.block, scratch.rate);
    } else {
      kernels_.gather_elastic(elements, b, n, scratch.block);
    }
    if (theta != nullptr) {
      const std::uint16_t* index = part.chains.index.data() + b * kChainVertices * kernels_.lanes;
      stages.mean_of_vertices(index, n, theta, scratch.mean);
    }
    if (large.measured) {
      kernels_.measure[plan.measure](elements, b, n, scratch.block);
      run_laws(plan, n * tets, scratch.block);
    }
    if (large.respond(items, lanes, to, scratch.block, out))
      inversions_.list(part.chains, b, n, scratch.block, found.inverted);
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
    if (split) {
      kernels_.push_piolas_apart(elements, b, n, out.piola, out.viscous);
    } else {
      kernels_.push_piola(elements, b, n, out.piola, scratch.elastic.data());
    }
  }
}

}  // namespace glisson::engine
