#include "engine/element_forces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "glisson/material/linear_law.h"

namespace glisson::engine {
namespace {

constexpr std::size_t kPrefetchTets = 16384;  ///< rest data of more do not fit a second-level cache of 1 MiB

double largest(std::array<float, kMaxLanes> lanes) {
  for (std::size_t half = kMaxLanes / 2; half > 0; half /= 2) {
    for (std::size_t i = 0; i < half; ++i) lanes[i] = std::max(lanes[i], lanes[i + half]);
  }
  return double(lanes[0]);
}

double bound_of(const StiffnessSeen& seen) { return largest(seen.stiffness) + std::sqrt(largest(seen.slope_squared)); }

}  // namespace

ElementForces::ElementForces(const Body& body, Submeshes& submeshes, const VertexRecords& records,
                             const Kernels& kernels, double precision_error)
    : body_(body), submeshes_(submeshes), records_(records), kernels_(kernels),
      inversions_(body, submeshes, records, kernels.lanes), precision_(submeshes, precision_error) {}

void ElementForces::reset() {
  plans_.clear(), plans_.resize(body_.blocks.size());
  twins_.clear(), twins_.resize(precision_.on() ? body_.blocks.size() : 0);
  for (std::size_t b = 0; b < body_.blocks.size(); ++b) take_tissue(b);
  inversions_.reset();
  precision_.reset();
}

void ElementForces::take_tissue(std::size_t b) {
  const TissueBlock& block = body_.blocks[b];
  plans_[b] = tissue_plan(block, *kernels_.response);
  if (!precision_.on()) return;
  twins_[b].reset();
  if (has_linear_law(block.tissue)) twins_[b] = linear_twin(block, plans_[b], *kernels_.response);
}

void ElementForces::list_above(std::span<const double> stiffening, std::span<const StiffLimit> single) {
  list_above_.assign(stiffening.begin(), stiffening.end());
  single_limits_ = single;
}

void ElementForces::begin_step(double h, std::uint64_t steps, double since_memory, bool accounted) {
  for (TissuePlan& plan : plans_) {
    if (plan.response != nullptr) plan.response->set_step(h, since_memory);
  }
  last_step_ = std::isinf(since_memory) ? 0.0 : since_memory;
  steps_ = steps, moves_ = h > 0.0, accounted_ = accounted;
  precision_.begin_step(moves_);
}

/// Stiffening from which elements of a block are listed.
double ElementForces::list_limit(std::size_t block) const {
  return list_above_.empty() ? std::numeric_limits<double>::infinity() : list_above_[block];
}

void ElementForces::narrow(const Submesh& part, SubmeshScratch& scratch) const {
  if (part.local_vertices() == 0) return;
  const double* own = records_.at(part.first_interior);
  const double* origin = part.interior_count > 0 ? own : records_.at(part.shared[0]);
  kernels_.narrow(own, origin, part.interior_count, scratch.states.data());
  kernels_.narrow_chosen(records_.at(0), part.shared.data(), origin, part.shared.size(),
                         scratch.states.data() + part.interior_count * kStateFloats);
}

Elements ElementForces::elements_of(const Submesh& part, SubmeshScratch& scratch) const {
  return {.states = scratch.states.data(),
          .index = part.chains.index.data(),
          .rest = part.chains.rest.data(),
          .pairs = part.chains.pairs,
          .closed_pairs = part.chains.closed_pairs,
          .elastic = scratch.elastic.data(),
          .viscous = scratch.viscous.data(),
          .pairs_of_forces = scratch.pairs.data(),
          .tissue = plans_[part.block].tissue,
          .prefetch = body_.elements.size() > kPrefetchTets,
          .mu_law = plans_[part.block].laws - 1};
}

/// Values and slopes of the laws at the measures of a block.
void ElementForces::run_laws(const TissuePlan& plan, std::size_t values, Block& block) const {
  for (std::size_t l = 0; l < plan.laws; ++l) {
    kernels_.law[plan.law[l].kind](plan.law[l], block.x, values, block.value[l], block.slope[l]);
  }
}

/// The same for moduli of a small strain. @return whether elements may have become so stiff that they are to be listed
bool ElementForces::watch_laws(const TissuePlan& plan, std::size_t values, float limit, Block& block,
                               StiffnessSeen& seen) const {
  if (plan.laws == 1) return kernels_.watch_law[plan.law[0].kind](plan.law[0], block, values, limit, seen);
  run_laws(plan, values, block);
  return kernels_.watch_lame(block, plan.tissue, values, limit, seen);
}

/// Lists an element, if it is above its own limit.
void ElementForces::list(ElementFindings& found, const StiffElement& stiff) const {
  if (single_limits_.empty() || !single_limits_[stiff.element].covers(stiff)) found.stiff.push_back(stiff);
}

/// Lists elements of a block of batches that laws on moduli have made stiff.
void ElementForces::list_by_laws(const Submesh& part, std::size_t batch, std::size_t n, const TissuePlan& plan,
                                 Block& block, ElementFindings& found) const {
  const std::size_t tets = kernels_.lanes * kChainTets;
  run_laws(plan, n * tets, block);
  const std::uint32_t* element = part.chains.element.data() + batch * tets;
  const double mu = 1.0 / double(plan.tissue.rest_mu), bulk = mu / (2.0 * double(plan.tissue.bulk_over_two_mu));
  const double limit = list_limit(part.block);
  const bool two = plan.laws == 2;
  std::array<std::uint16_t, kBlockTets> which;
  const ListLimits limits{static_cast<float>(limit * double(kBelowLimit)), single_limits_.data(), element};
  const std::size_t few = kernels_.list_stiff(block, plan.tissue, plan.laws, n * tets, limits, which.data());
  const auto larger = [&](double l, double m) { return std::max(m * mu, (l + 2.0 / 3.0 * m) * bulk); };
  for (std::size_t k = 0; k < few; ++k) {
    const std::size_t i = which[k];
    if (element[i] == kNoElement) continue;
    const double first = double(block.value[0][i]), slope = std::abs(double(block.slope[0][i]));
    const double value = two ? larger(first, double(block.value[1][i])) : first;
    const double rise = two ? larger(slope, std::abs(double(block.slope[1][i]))) : slope;
    const double r = value + rise * std::sqrt(std::max(0.0, double(block.y[i])));
    if (r > limit) list(found, {element[i], r, r});
  }
}

void ElementForces::push_elements(const Submesh& part, bool split, SubmeshScratch& scratch,
                                  ElementFindings& found) const {
  const TissuePlan& plan = plans_[part.block];
  const Elements elements = elements_of(part, scratch);
  const auto gather = plan.viscous ? kernels_.gather_viscous : kernels_.gather_elastic;
  const auto push = split ? kernels_.push_apart : (plan.viscous ? kernels_.push_merged : kernels_.push_elastic);
  const auto measure = kernels_.measure[plan.measure];
  const auto limit = static_cast<float>(list_limit(part.block) * double(kBelowLimit));
  Block& block = scratch.block;
  for (std::size_t b = 0; b < part.chains.count; b += kBlockBatches) {
    const std::size_t n = std::min(kBlockBatches, part.chains.count - b), values = kChainTets * n * kernels_.lanes;
    gather(elements, b, n, block);
    if (measure(elements, b, n, block)) inversions_.list(part.chains, b, n, block, found.inverted);
    if (watch_laws(plan, values, limit, block, found.seen)) list_by_laws(part, b, n, plan, block, found);
    push(elements, b, n, block);
  }
  found.stiffening = bound_of(found.seen);
}

/// @return the largest squared displacement difference of an edge [m²]
float ElementForces::push_edges(const EdgeBatches& batches, const TissuePlan& plan, bool split,
                                SubmeshScratch& scratch) const {
  const Edges edges{.states = scratch.states.data(),
                    .index = batches.index.data(),
                    .tensor = batches.tensor.data(),
                    .batches = batches.count,
                    .elastic = scratch.elastic.data(),
                    .viscous = scratch.viscous.data(),
                    .tissue = plan.tissue};
  const bool apart = split && plan.viscous;
  return (apart ? kernels_.edges_split : (plan.viscous ? kernels_.edges_merged : kernels_.edges_elastic))(edges);
}

void ElementForces::spread_volume_changes(const Submesh& part, SubmeshScratch& scratch, float* sums) const {
  const VolumeKind kind = plans_[part.block].response->lanes.volume;
  const Elements elements = elements_of(part, scratch);
  narrow(part, scratch);
  std::fill_n(sums, part.local_vertices(), 0.0F);
  for (std::size_t b = 0; b < part.chains.count; b += kBlockBatches) {
    const std::size_t n = std::min(kBlockBatches, part.chains.count - b), items = n * kChainTets;
    kernels_.gather_elastic(elements, b, n, scratch.block);
    const float* rest = part.chains.rest.data() + b * kChainRest * kernels_.lanes;
    kernels_.response->volume_changes(scratch.block.gradient, rest, items, kind, scratch.block.x);
    const std::uint16_t* index = part.chains.index.data() + b * kChainVertices * kernels_.lanes;
    kernels_.response->spread_to_vertices(index, n, scratch.block.x, sums);
  }
}

void ElementForces::drag(const Submesh& part, const double* velocities, SubmeshScratch& scratch) const {
  std::fill_n(scratch.viscous.data(), force_floats(part.local_vertices()), 0.0F);
  if (!plans_[part.block].drags || part.local_vertices() == 0) return;
  const EdgeBatches& edges = part.linear.alone() ? part.linear.edges : part.edges;
  const bool by_edges = edges.count > 0;
  if (by_edges) std::fill_n(scratch.states.data(), part.local_vertices() * kStateFloats, 0.0F);
  const double* own = velocities + 4 * part.first_interior;
  const double* origin = part.interior_count > 0 ? own : velocities + 4 * std::size_t{part.shared[0]};
  kernels_.narrow_vectors(own, nullptr, origin, part.interior_count, scratch.states.data());
  kernels_.narrow_vectors(velocities, part.shared.data(), origin, part.shared.size(),
                          scratch.states.data() + part.interior_count * kStateFloats);
  const LaneTissue& tissue = plans_[part.block].tissue;
  if (by_edges) {
    kernels_.edges_merged({.states = scratch.states.data(),
                           .index = edges.index.data(),
                           .tensor = edges.tensor.data(),
                           .batches = edges.count,
                           .elastic = scratch.viscous.data(),
                           .tissue = {.lambda = tissue.viscous_lambda, .mu = tissue.viscous_mu}});
    return;
  }
  const Elements elements = elements_of(part, scratch);
  for (std::size_t b = 0; b < part.chains.count; b += kBlockBatches) {
    const std::size_t batches = std::min(kBlockBatches, part.chains.count - b);
    kernels_.gather_drag(elements, b, batches, scratch.block);
    kernels_.push_viscous(elements, b, batches, scratch.block);
  }
}

/// Forces of a submesh by its tets; kept apart, both are pushed at once.
void ElementForces::push_tets(Submesh& part, bool split, const float* theta, SubmeshScratch& scratch,
                              ElementFindings& found) const {
  const std::size_t n = part.local_vertices();
  float* pairs = scratch.pairs.data();
  if (split) std::fill_n(pairs, 2 * n * kForceFloats, 0.0F);
  if (plans_[part.block].response != nullptr) {
    push_response(part, split, theta, scratch, found);
  } else {
    push_elements(part, split, scratch, found);
  }
  if (split) kernels_.part_forces(pairs, n, scratch.elastic.data(), scratch.viscous.data());
}

/// Σ f·v of the elastic forces of a submesh in a scratch [W]; forces and velocities may be counted from any motion of the whole.
double ElementForces::power(const Submesh& part, const SubmeshScratch& scratch) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < part.local_vertices(); ++i) {
    const float *v = scratch.states.data() + i * kStateFloats + 4, *f = scratch.elastic.data() + i * kForceFloats;
    for (std::size_t k = 0; k < 3; ++k) sum += double(f[k]) * double(v[k]);
  }
  return sum;
}

/// Adds the forces of a submesh's linear form to its own, each by its share.
void ElementForces::mix_in(std::size_t s, bool split, SubmeshScratch& scratch) {
  const Submesh& part = submeshes_.parts[s];
  const auto share = static_cast<float>(part.linear.share);
  const std::size_t floats = force_floats(part.local_vertices());
  const auto scale = [&](float factor) {
    for (std::size_t i = 0; i < floats; ++i) scratch.elastic[i] *= factor;
    for (std::size_t i = 0; split && i < floats; ++i) scratch.viscous[i] *= factor;
  };
  const double own = accounted_ ? power(part, scratch) : 0.0;
  scale((1.0F - share) / share);
  precision_.moved(s, push_edges(part.linear.edges, twins_[part.block]->plan, split, scratch));
  scale(share);
  if (!accounted_ || !moves_) return;
  precision_.worked(s, last_step_ * (power(part, scratch) - own) / part.linear.share);
}

void ElementForces::evaluate(std::size_t s, bool split, const float* theta, SubmeshScratch& scratch,
                             ElementFindings& found) {
  Submesh& part = submeshes_.parts[s];
  found.clear();
  const std::size_t floats = force_floats(part.local_vertices());
  std::fill_n(scratch.elastic.data(), floats, 0.0F);
  if (split) std::fill_n(scratch.viscous.data(), floats, 0.0F);
  narrow(part, scratch);
  const bool examines = precision_.examines(s), linear = part.linear.alone();
  if (examines && has_twin(part.block)) examine(s, scratch);
  if (part.edges.count > 0 || linear) {
    const TissuePlan& plan = linear ? twins_[part.block]->plan : plans_[part.block];
    const float longest = push_edges(linear ? part.linear.edges : part.edges, plan, split, scratch);
    found.stiffening = linear ? precision_.stiffening(s) : 1.0;
    if (linear) precision_.moved(s, longest);
    if (inversions_.is_due(s, longest, steps_, moves_)) inversions_.list(part.elements, found.inverted);
  } else {
    push_tets(part, split, theta, scratch, found);
  }
  if (part.linear.share > 0.0 && !linear) mix_in(s, split, scratch);
  if (examines && !has_twin(part.block)) examine_forces(s, split, scratch);
  if (!found.inverted.empty()) inversions_.found_in(s);
  found.finite = kernels_.all_finite(scratch.elastic.data(), floats) &&
                 (!split || kernels_.all_finite(scratch.viscous.data(), floats));
}

}  // namespace glisson::engine
