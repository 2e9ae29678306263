#include "engine/submesh_body.h"

#include <algorithm>
#include <cmath>

#include "engine/pair_batches.h"
#include "mechanics/flush_denormals.h"
#include "tissue/shape_measure.h"

namespace glisson::engine {
namespace {

constexpr std::size_t kPrefetchTets = 16384;  ///< rest data of more do not fit a second-level cache of 1 MiB
constexpr std::size_t kInterfaceChunk = 512;  ///< interface vertices a task
/// A linear submesh with large gradients is looked over for inverted tets once in so many steps.
constexpr std::uint64_t kInversionPeriod = 16;

/// Floats of n force records, up to a whole vector of lanes.
std::size_t force_floats(std::size_t n) { return (n * kForceFloats + kMaxLanes - 1) / kMaxLanes * kMaxLanes; }

Vec3d vector_of(const float* f) {
  return {static_cast<double>(f[0]), static_cast<double>(f[1]), static_cast<double>(f[2])};
}
Vec3d vector_of(const double* f) { return {f[0], f[1], f[2]}; }
void put(const Vec3d& v, double* out) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

}  // namespace

/// What a thread works in.
struct SubmeshBody::Scratch {
  LaneVector<float> states, elastic, viscous;
  Block block;

  void make_room(std::size_t n) {
    states.resize(std::max(states.size(), n * kStateFloats));
    elastic.resize(std::max(elastic.size(), force_floats(n)));
    viscous.resize(elastic.size());
  }
};

SubmeshBody::Plan SubmeshBody::plan_of(const TissueBlock& block) {
  const Tissue& tissue = block.tissue;
  const double lambda = block.elastic.lambda, mu = block.elastic.mu;
  Plan plan;
  plan.tissue = {.lambda = float(lambda),
                 .mu = float(mu),
                 .viscous_lambda = float(block.viscous.lambda),
                 .viscous_mu = float(block.viscous.mu),
                 .bulk_over_two_mu = float((lambda + 2.0 / 3.0 * mu) / (2.0 * mu)),
                 .rest_mu = float(mu)};
  plan.measure = static_cast<std::size_t>(tissue.measure);
  plan.linear = is_linear(block);
  plan.viscous = tissue.viscosity > 0.0;
  if (tissue.lambda_law || tissue.mu_law) {
    plan.laws = 2;
    plan.law = {lane_law(tissue.lambda_law.value_or(ConstantLaw{}), lambda, 1.0),
                lane_law(tissue.mu_law.value_or(ConstantLaw{}), mu, 1.0)};
    plan.tissue.lambda = plan.tissue.mu = 1.0F;
  } else {
    plan.law[0] = lane_law(tissue.law, tissue.youngs_modulus, tissue.youngs_modulus);
  }
  return plan;
}

SubmeshBody::SubmeshBody(const Body& body, std::span<const double> nodal_damping, const SubmeshOptions& options)
    : body_(body), kernels_(options.kernels != nullptr ? *options.kernels : best_kernels()),
      submeshes_(build_submeshes(body, kernels_.lanes, options.submesh_tets)),
      pool_(options.threads > 0 ? options.threads : threads_for(body.elements.size())),
      state_(body.vertex_count * kStateDoubles, 0.0), masses_(body.vertex_count), damping_(body.vertex_count),
      watches_(submeshes_.parts.size()), holds_watched_(submeshes_.parts.size(), 0),
      looked_(submeshes_.parts.size(), Looked::small), found_(submeshes_.parts.size()) {
  for (const TissueBlock& block : body.blocks) plans_.push_back(plan_of(block));
  for (std::size_t v = 0; v < body.vertex_count; ++v) {
    masses_[submeshes_.record_of_vertex[v]] = body.masses[v];
    damping_[submeshes_.record_of_vertex[v]] = nodal_damping[v];
  }
  make_room();
}

SubmeshBody::~SubmeshBody() = default;

/// Memory for what depends on the sizes of submeshes and interface.
void SubmeshBody::make_room() {
  slots_elastic_.resize(submeshes_.interface.slot_count * kForceFloats);
  slots_viscous_.resize(slots_elastic_.size());
  const std::size_t chunks = (submeshes_.interface.size() + kInterfaceChunk - 1) / kInterfaceChunk;
  interface_watches_.resize(chunks);
  interface_found_.resize(chunks);
  std::size_t largest = kInterfaceChunk;
  for (const Submesh& part : submeshes_.parts) largest = std::max(largest, part.local_vertices());
  scratch_.resize(static_cast<std::size_t>(pool_.threads()));
  for (auto& scratch : scratch_) {
    if (scratch == nullptr) scratch = std::make_unique<Scratch>();
    scratch->make_room(largest);
  }
}

void SubmeshBody::set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) {
  for (std::size_t v = 0; v < displacement.size(); ++v) {
    double* record = state_.data() + submeshes_.record_of_vertex[v] * kStateDoubles;
    put(displacement[v], record);
    put(velocity[v], record + 4);
  }
  for (WatchedVertex& w : watched_) w.displacement = displacement[w.vertex], w.velocity = velocity[w.vertex];
  std::fill(looked_.begin(), looked_.end(), Looked::small);
}

void SubmeshBody::read_state(std::span<Vec3d> displacement, std::span<Vec3d> velocity) const {
  for (std::size_t v = 0; v < displacement.size(); ++v) {
    const double* record = state_.data() + submeshes_.record_of_vertex[v] * kStateDoubles;
    displacement[v] = vector_of(record);
    velocity[v] = vector_of(record + 4);
  }
}

Vec3d SubmeshBody::displacement_of(std::uint32_t vertex) const {
  return vector_of(state_.data() + submeshes_.record_of_vertex[vertex] * kStateDoubles);
}
Vec3d SubmeshBody::velocity_of(std::uint32_t vertex) const {
  return vector_of(state_.data() + submeshes_.record_of_vertex[vertex] * kStateDoubles + 4);
}

void SubmeshBody::watch(std::span<const std::uint32_t> vertices) {
  std::vector<std::uint32_t> all(vertices.begin(), vertices.end());
  for (const WatchedVertex& w : watched_) all.push_back(w.vertex);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::vector<WatchedVertex> now;
  for (const std::uint32_t v : all) {
    const auto known = std::lower_bound(watched_.begin(), watched_.end(), v,
                                        [](const WatchedVertex& w, std::uint32_t vertex) { return w.vertex < vertex; });
    const bool was = known != watched_.end() && known->vertex == v;
    now.push_back(was ? *known : WatchedVertex{v, {}, {}, displacement_of(v), velocity_of(v)});
  }
  watched_ = std::move(now);
  find_watches();
}

/// Sorts the watched vertices to the submesh or the run of the interface that has them.
void SubmeshBody::find_watches() {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> records;  // record, place
  std::vector<char> is_watched(masses_.size(), 0);
  for (std::uint32_t place = 0; place < watched_.size(); ++place) {
    records.emplace_back(submeshes_.record_of_vertex[watched_[place].vertex], place);
    is_watched[records.back().first] = 1;
  }
  std::sort(records.begin(), records.end());
  for (auto& list : watches_) list.clear();
  for (auto& list : interface_watches_) list.clear();
  std::size_t s = 0;
  for (const auto& [record, place] : records) {
    if (record >= submeshes_.interface.first_record) {
      const std::size_t k = record - submeshes_.interface.first_record;
      interface_watches_[k / kInterfaceChunk].push_back({static_cast<std::uint32_t>(k % kInterfaceChunk), place});
      continue;
    }
    while (record >= submeshes_.parts[s].first_interior + submeshes_.parts[s].interior_count) ++s;
    watches_[s].push_back({static_cast<std::uint32_t>(record - submeshes_.parts[s].first_interior), place});
  }
  for (std::size_t p = 0; p < watches_.size(); ++p) {
    const auto& shared = submeshes_.parts[p].shared;
    holds_watched_[p] = !watches_[p].empty() ||
                        std::any_of(shared.begin(), shared.end(), [&](std::uint32_t r) { return is_watched[r] != 0; });
  }
}

void SubmeshBody::place_watched() {
  for (const WatchedVertex& w : watched_) {
    double* record = state_.data() + submeshes_.record_of_vertex[w.vertex] * kStateDoubles;
    put(w.displacement, record);
    put(w.velocity, record + 4);
  }
}

/// c = h/(m + γh) and d = γh/(m + γh) of a record; a vertex without mass does not move.
void SubmeshBody::set_coefficients(std::size_t record) {
  const double denominator = masses_[record] + damping_[record] * step_;
  const bool moves = masses_[record] > 0.0;
  state_[record * kStateDoubles + 3] = moves ? step_ / denominator : 0.0;
  state_[record * kStateDoubles + 7] = moves ? damping_[record] * step_ / denominator : 1.0;
}

void SubmeshBody::set_step(double h) {
  if (h == step_) return;
  step_ = h;
  for (std::size_t record = 0; record < masses_.size(); ++record) set_coefficients(record);
}

/// Whether elastic and viscous forces of a submesh are kept apart.
bool SubmeshBody::splits(std::size_t s, bool accounted) const {
  return plans_[submeshes_.parts[s].block].viscous && (accounted || holds_watched_[s] != 0);
}

void SubmeshBody::narrow(const Submesh& part, Scratch& scratch) const {
  if (part.local_vertices() == 0) return;
  const double* own = state_.data() + part.first_interior * kStateDoubles;
  const double* origin = part.interior_count > 0 ? own : state_.data() + part.shared[0] * kStateDoubles;
  kernels_.narrow(own, origin, part.interior_count, scratch.states.data());
  kernels_.narrow_chosen(state_.data(), part.shared.data(), origin, part.shared.size(),
                         scratch.states.data() + part.interior_count * kStateFloats);
}

void SubmeshBody::push_elements(const Submesh& part, bool split, Scratch& scratch, Findings& found) const {
  const Plan& plan = plans_[part.block];
  const Elements elements{.states = scratch.states.data(),
                          .index = part.pairs.index.data(),
                          .rest = part.pairs.rest.data(),
                          .elastic = scratch.elastic.data(),
                          .viscous = scratch.viscous.data(),
                          .tissue = plan.tissue,
                          .prefetch = body_.elements.size() > kPrefetchTets,
                          .mu_law = plan.laws - 1};
  const auto gather = plan.viscous ? kernels_.gather_viscous : kernels_.gather_elastic;
  const auto push = plan.viscous && !split ? kernels_.push_merged : kernels_.push_elastic;
  const auto look = plan.laws == 2 ? kernels_.watch_lame : kernels_.watch_young;
  Block& block = scratch.block;
  for (std::size_t b = 0; b < part.pairs.count; b += kBlockBatches) {
    const std::size_t n = std::min(kBlockBatches, part.pairs.count - b), values = 2 * n * kernels_.lanes;
    gather(elements, b, n, block);
    if (kernels_.measure[plan.measure](elements, b, n, block)) found.inverted = true;
    for (std::size_t l = 0; l < plan.laws; ++l) {
      kernels_.law[plan.law[l].kind](plan.law[l], block.x, values, block.value[l], block.slope[l]);
    }
    look(block, plan.tissue, values, found.stiffness);
    push(elements, b, n, block);
    if (split) kernels_.push_viscous(elements, b, n, block);
  }
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
  found.stiffness.stiffness = 1.0F;
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

void SubmeshBody::list_inverted(const Submesh& part, Findings& found) const {
  for (const std::uint32_t e : part.elements) {
    const Tet& t = body_.elements[e];
    std::array<Vec3d, 4> u;
    for (std::size_t a = 0; a < 4; ++a) {
      u[a] = vector_of(state_.data() + submeshes_.record_of_vertex[t[a]] * kStateDoubles);
    }
    const Mat3d H = displacement_gradient<double>(body_.rest[e].s, {u[1] - u[0], u[2] - u[0], u[3] - u[0]});
    if (!(jacobian(H) > 0.0)) found.tets.push_back(body_.mesh_tet[e]);
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

void SubmeshBody::take_watched(std::span<const Watch> watches, std::size_t first_record, const float* elastic,
                               const float* viscous) {
  for (const Watch& watch : watches) {
    WatchedVertex& w = watched_[watch.place];
    const double* record = state_.data() + (first_record + watch.local) * kStateDoubles;
    w.elastic = vector_of(elastic + watch.local * kForceFloats);
    w.viscous = viscous != nullptr ? vector_of(viscous + watch.local * kForceFloats) : Vec3d{};
    w.displacement = vector_of(record);
    w.velocity = vector_of(record + 4);
  }
}

/// Kick and drift of the vertices between those watched. Without `viscous`, `elastic` is the whole force.
void SubmeshBody::integrate(std::size_t first_record, std::size_t n, std::span<const Watch> watches, float* elastic,
                            float* viscous, const Step& step, VertexWork& work) {
  std::size_t from = 0;
  const auto run_to = [&](std::size_t end) {
    double* state = state_.data() + (first_record + from) * kStateDoubles;
    const float* f = elastic + from * kForceFloats;
    if (step.accounted) {
      kernels_.integrate_accounted(state, f, viscous + from * kForceFloats, end - from, step.kick, work);
    } else {
      kernels_.integrate(state, f, end - from, step.kick);
    }
  };
  for (const Watch& watch : watches) {
    run_to(watch.local);
    from = watch.local + 1;
  }
  run_to(n);
}

void SubmeshBody::run_submesh(std::size_t s, const Step& step, Scratch& scratch) {
  const FlushDenormals flush;
  const Submesh& part = submeshes_.parts[s];
  Findings& found = found_[s];
  found = {};
  const bool split = splits(s, step.accounted);
  const std::size_t floats = force_floats(part.local_vertices());
  std::fill_n(scratch.elastic.data(), floats, 0.0F);
  if (split || step.accounted) std::fill_n(scratch.viscous.data(), floats, 0.0F);

  narrow(part, scratch);
  if (part.edges.count > 0) {
    push_edges(part, split, scratch, found);
    found.inverted = must_look(s, found.longest_edge_squared, step.kick.step > 0.0);
  } else {
    push_elements(part, split, scratch, found);
  }
  if (found.inverted) list_inverted(part, found);
  if (!found.tets.empty()) looked_[s] = Looked::inverted;

  found.finite = kernels_.all_finite(scratch.elastic.data(), floats) &&
                 (!split || kernels_.all_finite(scratch.viscous.data(), floats));
  if (!found.finite) return;
  fill_slots(part, split, scratch);
  take_watched(watches_[s], part.first_interior, scratch.elastic.data(), split ? scratch.viscous.data() : nullptr);
  if (split && !step.accounted) kernels_.add(scratch.elastic.data(), scratch.viscous.data(), floats);
  integrate(part.first_interior, part.interior_count, watches_[s], scratch.elastic.data(), scratch.viscous.data(), step,
            found.work);
}

void SubmeshBody::run_interface(std::size_t chunk, const Step& step, Scratch& scratch) {
  const FlushDenormals flush;
  const Interface& shared = submeshes_.interface;
  const std::size_t begin = chunk * kInterfaceChunk, n = std::min(kInterfaceChunk, shared.size() - begin);
  float *elastic = scratch.elastic.data(), *viscous = scratch.viscous.data();
  const std::uint32_t* slot_begin = shared.slot_begin.data() + begin;
  kernels_.sum_slots(slots_elastic_.data(), slot_begin, shared.slots.data(), n, elastic);
  if (any_split_) {
    kernels_.sum_slots(slots_viscous_.data(), slot_begin, shared.slots.data(), n, viscous);
  } else {
    std::fill_n(viscous, n * kForceFloats, 0.0F);
  }
  interface_found_[chunk] = {};
  const std::size_t first = shared.first_record + begin;
  take_watched(interface_watches_[chunk], first, elastic, viscous);
  if (!step.accounted && any_split_) kernels_.add(elastic, viscous, force_floats(n));
  integrate(first, n, interface_watches_[chunk], elastic, viscous, step, interface_found_[chunk].work);
}

/// Adds up what the tasks found, in their order.
void SubmeshBody::gather_findings(bool accounted) {
  advance_.finite = true;
  advance_.inverted.clear();
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
    advance_.inverted.insert(advance_.inverted.end(), found.tets.begin(), found.tets.end());
    double& r = advance_.stiffening[submeshes_.parts[s].block];
    r = std::max(r, double(found.stiffness.stiffness) + std::sqrt(double(found.stiffness.slope_squared)));
    if (accounted) book(found.work);
  }
  if (accounted) {
    for (const Findings& found : interface_found_) book(found.work);
  }
  std::sort(advance_.inverted.begin(), advance_.inverted.end());
}

const Advance& SubmeshBody::advance(double h, const Vec3d& gravity, bool accounted) {
  set_step(h);
  any_split_ = false;
  for (std::size_t s = 0; s < submeshes_.parts.size(); ++s) any_split_ = any_split_ || splits(s, accounted);
  const Step step{{h, {gravity.x, gravity.y, gravity.z, 0.0}}, accounted};
  pool_.run(submeshes_.parts.size(),
            [&](std::size_t s, std::size_t thread) { run_submesh(s, step, *scratch_[thread]); });
  const bool finite = std::all_of(found_.begin(), found_.end(), [](const Findings& f) { return f.finite; });
  if (finite) {
    pool_.run(interface_found_.size(),
              [&](std::size_t c, std::size_t thread) { run_interface(c, step, *scratch_[thread]); });
  }
  ++steps_;
  gather_findings(accounted);
  return advance_;
}

}  // namespace glisson::engine
