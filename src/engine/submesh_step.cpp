// submesh_step.cpp — one step of a body of submeshes: the tasks drawn in submesh_body.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "element/flush_denormals.h"
#include "engine/submesh_scratch.h"
#include "material/shape_measure.h"

namespace glisson::engine {
namespace {

constexpr std::size_t kPrefetchTets = 16384;  ///< rest data of more do not fit a second-level cache of 1 MiB
/// A linear submesh with large gradients is looked over for inverted tets once in so many steps.
constexpr std::uint64_t kInversionPeriod = 16;

double largest(std::array<float, kMaxLanes> lanes) {
  for (std::size_t half = kMaxLanes / 2; half > 0; half /= 2) {
    for (std::size_t i = 0; i < half; ++i) lanes[i] = std::max(lanes[i], lanes[i + half]);
  }
  return double(lanes[0]);
}

double bound_of(const StiffnessSeen& seen) { return largest(seen.stiffness) + std::sqrt(largest(seen.slope_squared)); }

}  // namespace

/// Stiffening from which elements of a block are listed.
double SubmeshBody::list_limit(std::size_t block) const {
  return list_above_.empty() ? std::numeric_limits<double>::infinity() : list_above_[block];
}

/// Whether elastic and viscous forces of a submesh are kept apart.
bool SubmeshBody::splits(std::size_t s, bool accounted) const {
  return plans_[submeshes_.parts[s].block].viscous && (accounted || active_.asks_apart(s));
}

void SubmeshBody::narrow(const Submesh& part, Scratch& scratch) const {
  if (part.local_vertices() == 0) return;
  const double* own = records_.at(part.first_interior);
  const double* origin = part.interior_count > 0 ? own : records_.at(part.shared[0]);
  kernels_.narrow(own, origin, part.interior_count, scratch.states.data());
  kernels_.narrow_chosen(records_.at(0), part.shared.data(), origin, part.shared.size(),
                         scratch.states.data() + part.interior_count * kStateFloats);
}

Elements SubmeshBody::elements_of(const Submesh& part, Scratch& scratch) const {
  return {.states = scratch.states.data(),
          .index = part.chains.index.data(),
          .rest = part.chains.rest.data(),
          .pairs = part.chains.pairs,
          .closed_pairs = part.chains.closed_pairs,
          .elastic = scratch.elastic.data(),
          .viscous = scratch.viscous.data(),
          .tissue = plans_[part.block].tissue,
          .prefetch = body_.elements.size() > kPrefetchTets,
          .mu_law = plans_[part.block].laws - 1};
}

/// Values and slopes of the laws at the measures of a block.
void SubmeshBody::run_laws(const Plan& plan, std::size_t values, Block& block) const {
  for (std::size_t l = 0; l < plan.laws; ++l) {
    kernels_.law[plan.law[l].kind](plan.law[l], block.x, values, block.value[l], block.slope[l]);
  }
}

/// The same for moduli of a small strain. @return whether elements may have become so stiff that they are to be listed
bool SubmeshBody::watch_laws(const Plan& plan, std::size_t values, float limit, Block& block,
                             StiffnessSeen& seen) const {
  if (plan.laws == 1) return kernels_.watch_law[plan.law[0].kind](plan.law[0], block, values, limit, seen);
  run_laws(plan, values, block);
  return kernels_.watch_lame(block, plan.tissue, values, limit, seen);
}

/// Lists an element, if it is above its own limit.
void SubmeshBody::list(Findings& found, const StiffElement& stiff) const {
  if (single_limits_.empty() || !single_limits_[stiff.element].covers(stiff)) found.stiff.push_back(stiff);
}

/// Lists elements of a block of batches that laws on moduli have made stiff.
void SubmeshBody::list_by_laws(const Submesh& part, std::size_t batch, std::size_t n, const Plan& plan, Block& block,
                               Findings& found) const {
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

void SubmeshBody::push_elements(const Submesh& part, bool split, Scratch& scratch, Findings& found) const {
  const Plan& plan = plans_[part.block];
  const Elements elements = elements_of(part, scratch);
  const auto gather = plan.viscous ? kernels_.gather_viscous : kernels_.gather_elastic;
  const auto push = plan.viscous && !split ? kernels_.push_merged : kernels_.push_elastic;
  const auto measure = kernels_.measure[plan.measure];
  const auto limit = static_cast<float>(list_limit(part.block) * double(kBelowLimit));
  Block& block = scratch.block;
  for (std::size_t b = 0; b < part.chains.count; b += kBlockBatches) {
    const std::size_t n = std::min(kBlockBatches, part.chains.count - b), values = kChainTets * n * kernels_.lanes;
    gather(elements, b, n, block);
    if (measure(elements, b, n, block)) list_inverted(part, b, n, block, found);
    if (watch_laws(plan, values, limit, block, found.seen)) list_by_laws(part, b, n, plan, block, found);
    push(elements, b, n, block);
    if (split) kernels_.push_viscous(elements, b, n, block);
  }
  found.stiffening = bound_of(found.seen);
}

void SubmeshBody::push_edges(const Submesh& part, bool split, Scratch& scratch, Findings& found) const {
  const Plan& plan = plans_[part.block];
  const Edges edges{.states = scratch.states.data(),
                    .index = part.edges.index.data(),
                    .tensor = part.edges.tensor.data(),
                    .batches = part.edges.count,
                    .elastic = scratch.elastic.data(),
                    .viscous = scratch.viscous.data(),
                    .tissue = plan.tissue};
  const auto push = split ? kernels_.edges_split : (plan.viscous ? kernels_.edges_merged : kernels_.edges_elastic);
  found.longest_edge_squared = push(edges);
  found.stiffening = 1.0;
}

/// Whether a linear submesh is to be looked over for inverted tets. |H| < 1 leaves no room for J ≤ 0; beyond
/// that it is looked over at once, then every kInversionPeriod steps, and at each step while it has some.
bool SubmeshBody::must_look(std::size_t s, float longest_edge_squared, bool moves) {
  const float reach = submeshes_.parts[s].gradient_reach;
  const bool large = !(longest_edge_squared * reach * reach < 1.0F);
  const bool look = large && (looked_[s] != Looked::large || (steps_ + s) % kInversionPeriod == 0);
  if (moves) looked_[s] = large ? Looked::large : Looked::small;
  return look;
}

/// Lists those of some elements that have J ≤ 0.
void SubmeshBody::list_inverted(std::span<const std::uint32_t> elements, Findings& found) const {
  for (const std::uint32_t e : elements) {
    if (e == kNoElement) continue;
    const Tet& t = body_.elements[e];
    std::array<Vec3d, 4> u;
    for (std::size_t a = 0; a < 4; ++a) u[a] = displacement_of(t[a]);
    const Mat3d H = displacement_gradient<double>(body_.rest[e].s, {u[1] - u[0], u[2] - u[0], u[3] - u[0]});
    if (!(jacobian(H) > 0.0)) found.inverted.push_back(body_.mesh_tet[e]);
  }
}

/// The same of a block of batches whose lanes have found some. Floats tell the few from which they cannot be told.
void SubmeshBody::list_inverted(const Submesh& part, std::size_t batch, std::size_t n, const Block& block,
                                Findings& found) const {
  constexpr float kUnsure = 1e-4F;  // J of floats is off by some 1e-6 (1 + ‖H‖²)^(3/2)
  const std::span<const std::uint32_t> elements = part.chains.elements_of(batch, n);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const float* at = block.gradient + i / kernels_.lanes * 9 * kernels_.lanes + i % kernels_.lanes;
    Mat3<float> H;
    for (std::size_t k = 0; k < 9; ++k) H(k / 3, k % 3) = at[k * kernels_.lanes];
    const float size = 1.0F + squared_norm(H);
    if (!(jacobian(H) > kUnsure * size * std::sqrt(size))) list_inverted(elements.subspan(i, 1), found);
  }
}

void SubmeshBody::fill_slots(const Submesh& part, bool split, const Scratch& scratch) {
  const std::size_t from = part.interior_count * kForceFloats, n = part.shared.size() * kForceFloats;
  std::copy_n(scratch.elastic.data() + from, n, slots_elastic_.data() + part.first_slot * kForceFloats);
  if (!any_split_) return;
  float* viscous = slots_viscous_.data() + part.first_slot * kForceFloats;
  if (split) {
    std::copy_n(scratch.viscous.data() + from, n, viscous);
  } else {
    std::fill_n(viscous, n, 0.0F);
  }
}

/// Kick and drift of the vertices between those active. Without `viscous`, `elastic` is the whole force.
void SubmeshBody::integrate(const RecordRun& run, float* elastic, float* viscous, const Step& step, VertexWork& work) {
  std::size_t from = 0;
  const auto run_to = [&](std::size_t end) {
    double* state = records_.at(run.first + from);
    const float* f = elastic + from * kForceFloats;
    const Kick kick = records_.kick_from(step.kick, run.first + from);
    if (step.accounted) {
      kernels_.integrate_accounted(state, f, viscous + from * kForceFloats, end - from, kick, work);
    } else {
      kernels_.integrate(state, f, end - from, kick);
    }
  };
  for (const LocalVertex& active : run.active) {
    run_to(active.local);
    from = active.local + 1;
  }
  run_to(run.size);
}

void SubmeshBody::run_submesh(std::size_t s, const Step& step, Scratch& scratch) {
  const FlushDenormals flush;
  const Submesh& part = submeshes_.parts[s];
  Findings& found = found_[s];
  found.clear();
  const bool split = splits(s, step.accounted);
  const std::size_t floats = force_floats(part.local_vertices());
  std::fill_n(scratch.elastic.data(), floats, 0.0F);
  if (split || step.accounted) std::fill_n(scratch.viscous.data(), floats, 0.0F);

  narrow(part, scratch);
  if (part.edges.count > 0) {
    push_edges(part, split, scratch, found);
    if (must_look(s, found.longest_edge_squared, step.kick.step > 0.0)) list_inverted(part.elements, found);
  } else if (large_plans_[part.block] != nullptr) {
    push_response(s, split, scratch, found);
  } else {
    push_elements(part, split, scratch, found);
  }
  if (!found.inverted.empty()) looked_[s] = Looked::inverted;

  found.finite = kernels_.all_finite(scratch.elastic.data(), floats) &&
                 (!split || kernels_.all_finite(scratch.viscous.data(), floats));
  if (!found.finite) return;
  fill_slots(part, split, scratch);
  const float* viscous = split ? scratch.viscous.data() : nullptr;
  const RecordRun run = active_.interior(s);
  if (in_stages()) return begin_stages(run, scratch.elastic.data(), viscous, step);
  active_.take_forces(run, scratch.elastic.data(), viscous);
  if (split && !step.accounted) kernels_.add(scratch.elastic.data(), scratch.viscous.data(), floats);
  integrate(run, scratch.elastic.data(), scratch.viscous.data(), step, found.work);
}

void SubmeshBody::run_interface(std::size_t chunk, const Step& step, Scratch& scratch) {
  const FlushDenormals flush;
  const Interface& shared = submeshes_.interface;
  const RecordRun run = active_.interface(chunk);
  const std::uint32_t* slot_begin = shared.slot_begin.data() + chunk * kInterfaceChunk;
  float *elastic = scratch.elastic.data(), *viscous = scratch.viscous.data();
  kernels_.sum_slots(slots_elastic_.data(), slot_begin, shared.slots.data(), run.size, elastic);
  if (any_split_) {
    kernels_.sum_slots(slots_viscous_.data(), slot_begin, shared.slots.data(), run.size, viscous);
  } else {
    std::fill_n(viscous, run.size * kForceFloats, 0.0F);
  }
  interface_found_[chunk] = {};
  if (in_stages()) return begin_stages(run, elastic, any_split_ ? viscous : nullptr, step);
  active_.take_forces(run, elastic, viscous);
  if (!step.accounted && any_split_) kernels_.add(elastic, viscous, force_floats(run.size));
  integrate(run, elastic, viscous, step, interface_found_[chunk].work);
}

/// Adds up what the tasks found, in their order.
void SubmeshBody::gather_findings(bool accounted) {
  advance_.finite = true;
  advance_.inverted.clear(), advance_.stiff.clear();
  advance_.stiffening.assign(body_.blocks.size(), 0.0);
  advance_.work = {};
  const auto book = [&](const VertexWork& w) {
    KickWork& sum = advance_.work;
    sum.before.elastic += w.elastic_before, sum.after.elastic += w.elastic_after;
    sum.before.viscous += w.viscous_before, sum.after.viscous += w.viscous_after;
    sum.before.damping += w.damping_before, sum.after.damping += w.damping_after;
    sum.before.loads += w.loads_before, sum.after.loads += w.loads_after;
    sum.kinetic += w.kinetic;
  };
  for (std::size_t s = 0; s < found_.size(); ++s) {
    const Findings& found = found_[s];
    advance_.finite = advance_.finite && found.finite;
    advance_.inverted.insert(advance_.inverted.end(), found.inverted.begin(), found.inverted.end());
    double& r = advance_.stiffening[submeshes_.parts[s].block];
    r = std::max(r, found.stiffening);
    advance_.stiff.insert(advance_.stiff.end(), found.stiff.begin(), found.stiff.end());
    if (accounted) book(found.work);
  }
  if (accounted) {
    for (const Findings& found : interface_found_) book(found.work);
  }
  std::sort(advance_.inverted.begin(), advance_.inverted.end());
}

const Advance& SubmeshBody::advance(double h, const Vec3d& gravity, bool accounted) {
  records_.set_step(h);
  set_maxwell_step(h);
  any_split_ = false;
  for (std::size_t s = 0; s < submeshes_.parts.size(); ++s) any_split_ = any_split_ || splits(s, accounted);
  if (any_shared_) {
    pool_.run(submeshes_.parts.size(), [&](std::size_t s, std::size_t thread) { spread_volume(s, *scratch_[thread]); });
  }
  const Step step{{h, {gravity.x, gravity.y, gravity.z, 0.0}}, accounted};
  pool_.run(submeshes_.parts.size(),
            [&](std::size_t s, std::size_t thread) { run_submesh(s, step, *scratch_[thread]); });
  const bool finite = std::all_of(found_.begin(), found_.end(), [](const Findings& f) { return f.finite; });
  if (finite) {
    pool_.run(interface_found_.size(),
              [&](std::size_t c, std::size_t thread) { run_interface(c, step, *scratch_[thread]); });
    if (in_stages()) run_drag_stages(step);
  }
  ++steps_;
  if (h > 0.0) since_memory_ = h;
  gather_findings(accounted);
  return advance_;
}

}  // namespace glisson::engine
