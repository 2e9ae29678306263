// examine_forces.cpp — what the linear law would get wrong of a submesh: the tissue's own stress beside that of its twin.
#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "engine/element_forces.h"
#include "engine/layout/response_batches.h"

namespace glisson::engine {
namespace {

double sum_of(const std::array<float, kMaxLanes>& lanes) {
  return std::accumulate(lanes.begin(), lanes.end(), 0.0, [](double sum, float x) { return sum + double(x); });
}

}  // namespace

void ElementForces::prepare_linear(Submesh& part) const {
  assemble_linear(body_, twins_[part.block]->block, submeshes_.record_of_vertex, part, kernels_.lanes);
}

/// Weights of a linear submesh's branches from the last look to this step.
MaxwellStep ElementForces::since_last_look(const Submesh& part) const {
  MaxwellStep step;
  const std::vector<MaxwellBranch>& branches = body_.blocks[part.block].tissue.maxwell;
  for (std::size_t k = 0; k < branches.size(); ++k) {
    step.previous[k] = lane_weights(part.linear.since, branches[k].time);
  }
  return step;
}

/// Of a submesh that has no twin, whose forces are in the scratch: it stays as it is, and does its part of the work.
void ElementForces::examine_forces(std::size_t s, bool split, const SubmeshScratch& scratch) {
  const Submesh& part = submeshes_.parts[s];
  double work = 0.0;
  for (std::size_t i = 0; i < part.local_vertices(); ++i) {
    const float *u = scratch.states.data() + i * kStateFloats, *f = scratch.elastic.data() + i * kForceFloats;
    for (std::size_t k = 0; k < 3; ++k) {
      const float beside = split ? scratch.viscous[i * kForceFloats + k] : 0.0F;
      work -= double(u[k]) * double(f[k] + beside);
    }
  }
  precision_.examined(s, {.work = work, .error = std::numeric_limits<double>::infinity()});
}

/// P of the elastic part of a block, whose gradients and rates are there.
void ElementForces::own_stress(const Submesh& part, std::size_t batch, const ResponseItems& items,
                               SubmeshScratch& scratch) const {
  const TissuePlan& plan = plans_[part.block];
  const LinearTwin& twin = *twins_[part.block];
  if (twin.whole.measured) {
    kernels_.measure[plan.measure](elements_of(part, scratch), batch, items.items / kChainTets, scratch.block);
    run_laws(plan, items.items * kernels_.lanes, scratch.block);
  }
  twin.whole.respond(items, twin.whole.lanes, {&body_, &twin.whole.response}, scratch.block, scratch.response);
}

/// Forms the stress of the states in the scratch and takes the branches of a linear submesh along. Before the forces, which go on
/// with the memory of the others.
void ElementForces::examine(std::size_t s, SubmeshScratch& scratch) {
  Submesh& part = submeshes_.parts[s];
  const TissuePlan& plan = plans_[part.block];
  const LinearTwin& twin = *twins_[part.block];
  const LaneResponse& lanes = twin.whole.lanes;
  const bool relaxes = lanes.branches > 0, by_memory = plan.response != nullptr && !part.linear.alone();
  const ResponseKernels& stages = *kernels_.response;
  const Elements elements = elements_of(part, scratch);
  const std::size_t tets = kernels_.lanes * kChainTets, numbers = memory_numbers(body_.blocks[part.block].tissue);
  const MaxwellStep step = by_memory ? plan.response->maxwell : since_last_look(part);
  if (relaxes) part.linear.stress.resize(part.chains.element.size() * 6, 0.0F);
  ResponseBlock& out = scratch.response;
  WorkSeen seen;
  float stiffest = 0.0F;
  for (std::size_t b = 0; b < part.chains.count; b += kBlockBatches) {
    const std::size_t n = std::min(kBlockBatches, part.chains.count - b);
    const ResponseItems items{.gradient = scratch.block.gradient,
                              .rate = lanes.viscous ? scratch.rate : nullptr,
                              .memory = part.memory.data() + b * tets * numbers,
                              .element = part.chains.element.data() + b * tets,
                              .items = n * kChainTets};
    const float* rest = part.chains.rest.data() + b * kChainRest * kernels_.lanes;
    if (lanes.viscous) {
      kernels_.gather_rates(elements, b, n, scratch.block, scratch.rate);
    } else {
      kernels_.gather_elastic(elements, b, n, scratch.block);
    }
    own_stress(part, b, items, scratch);
    if (relaxes) {
      stages.follow_branches(items, lanes, step, part.linear.alone(), part.linear.stress.data() + b * tets * 6, out);
    }
    stiffest = std::max(stiffest, stages.stiffest(items.items, out));
    if (lanes.viscous) stages.viscous(items, lanes, relaxes, out);
    stages.compare_linear(items, rest, twin.plan.tissue, relaxes || lanes.viscous, out, seen);
  }
  precision_.examined(s, {.work = sum_of(seen.work), .error = sum_of(seen.error), .stiffening = double(stiffest)});
  if (accounted_ && precision_.begins(s)) precision_.set_gap(s, energy_gap(part, scratch));
  part.linear.since = 0.0;
}

/// W_l − W of the elastic forces of a submesh [J], by three points of Gauss.
double ElementForces::energy_gap(const Submesh& part, SubmeshScratch& scratch) const {
  struct Point {
    double s, weight;
  };
  constexpr std::array<Point, 3> kPoints{
      {{0.8872983346207417, 5.0 / 18.0}, {0.5, 8.0 / 18.0}, {0.1127016653792583, 5.0 / 18.0}}};
  const LinearTwin& twin = *twins_[part.block];
  const std::size_t tets = kernels_.lanes * kChainTets;
  std::array<WorkSeen, 3> seen;
  for (std::size_t b = 0; b < part.chains.count; b += kBlockBatches) {
    const std::size_t n = std::min(kBlockBatches, part.chains.count - b);
    const ResponseItems items{
        .gradient = scratch.block.gradient, .element = part.chains.element.data() + b * tets, .items = n * kChainTets};
    kernels_.gather_elastic(elements_of(part, scratch), b, n, scratch.block);
    double at = 1.0;
    for (std::size_t k = 0; k < kPoints.size(); ++k) {
      const auto factor = static_cast<float>(kPoints[k].s / std::exchange(at, kPoints[k].s));
      for (std::size_t i = 0; i < n * tets * 9; ++i) scratch.block.gradient[i] *= factor;
      own_stress(part, b, items, scratch);
      if (twin.whole.lanes.branches > 0) kernels_.response->relax_all(items, twin.whole.lanes, scratch.response);
      const float* rest = part.chains.rest.data() + b * kChainRest * kernels_.lanes;
      kernels_.response->compare_linear(items, rest, twin.plan.tissue, false, scratch.response, seen[k]);
    }
  }
  double gap = 0.0;
  for (std::size_t k = 0; k < kPoints.size(); ++k) gap += kPoints[k].weight / kPoints[k].s * sum_of(seen[k].elastic);
  return gap;
}

}  // namespace glisson::engine
