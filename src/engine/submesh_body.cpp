// submesh_body.cpp — what a body of submeshes is and holds; how it makes a step is in submesh_step.cpp.
#include "engine/submesh_body.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "base/sort_out.h"
#include "element/drag_stages.h"
#include "engine/layout/response_batches.h"
#include "engine/submesh_scratch.h"

namespace glisson::engine {

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
  return plan;
}

SubmeshBody::SubmeshBody(const Body& body, std::span<const double> nodal_damping, const SubmeshOptions& options)
    : body_(body), kernels_(options.kernels != nullptr ? *options.kernels : best_kernels()),
      submeshes_(build_submeshes(body, kernels_.lanes, options.submesh_tets)), changer_(body, submeshes_, kernels_.lanes),
      pool_(options.threads > 0 ? options.threads : threads_for(body.elements.size())),
      stages_(drag_stages(options.drag_stages)) {
  follow_layout(nodal_damping);
}

/// Room, plans and masses for the submeshes there are.
void SubmeshBody::follow_layout(std::span<const double> nodal_damping) {
  state_.assign(body_.vertex_count * kStateDoubles, 0.0);
  masses_.assign(body_.vertex_count, 0.0), damping_.assign(body_.vertex_count, 0.0);
  rests_.assign(body_.vertex_count, 0), resting_.clear();
  weighs_.clear();
  make_room_for_stages();
  holds_apart_.assign(submeshes_.parts.size(), 0);
  looked_.assign(submeshes_.parts.size(), Looked::small), found_.resize(submeshes_.parts.size());
  plans_.clear(), large_plans_.clear();
  for (const TissueBlock& block : body_.blocks) {
    plans_.push_back(plan_of(block));
    large_plans_.push_back(large_plan_of(block, plans_.back()));
  }
  make_room();
  find_watches();
  take_masses(nodal_damping);
}

/// Masses and damping of all vertices, and what follows from them and the tissues.
void SubmeshBody::take_masses(std::span<const double> nodal_damping) {
  for (std::size_t v = 0; v < body_.vertex_count; ++v) {
    take_mass(v);
    damping_[submeshes_.record_of_vertex[v]] = nodal_damping[v];
  }
  step_ = -1.0;  // coefficients of the records are made anew
  any_shared_ = std::any_of(submeshes_.parts.begin(), submeshes_.parts.end(),
                            [&](const Submesh& part) { return shares_volume(part); });
  if (any_shared_) weigh_vertices();
}

SubmeshBody::~SubmeshBody() = default;

/// Memory for what depends on the sizes of submeshes and interface.
void SubmeshBody::make_room() {
  slots_elastic_.resize(submeshes_.interface.slot_count * kForceFloats);
  slots_viscous_.resize(slots_elastic_.size());
  const std::size_t chunks = (submeshes_.interface.size() + kInterfaceChunk - 1) / kInterfaceChunk;
  for (Watches* watches : {&watches_, &rest_watches_}) {
    watches->interior.resize(submeshes_.parts.size());
    watches->interface.resize(chunks);
  }
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
  for (ActiveVertex& w : active_) w.displacement = displacement[w.vertex], w.velocity = velocity[w.vertex];
  std::fill(looked_.begin(), looked_.end(), Looked::small);
  since_memory_ = std::numeric_limits<double>::infinity();  // a state that is set has relaxed
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

void SubmeshBody::watch(std::span<const std::uint32_t> vertices, std::span<const std::uint32_t> apart) {
  apart_.assign(apart.begin(), apart.end());
  std::vector<std::uint32_t> all(vertices.begin(), vertices.end());
  for (const ActiveVertex& w : active_) all.push_back(w.vertex);
  detail::sort_out(all);
  std::vector<ActiveVertex> now;
  now.reserve(all.size());
  std::size_t known = 0;
  for (const std::uint32_t v : all) {
    const bool was = known < active_.size() && active_[known].vertex == v;
    now.push_back(was ? active_[known++] : ActiveVertex{v, {}, {}, displacement_of(v), velocity_of(v)});
  }
  active_ = std::move(now);
  find_watches();
}

void SubmeshBody::watch_only(std::span<const std::uint32_t> vertices) {
  std::erase_if(active_,
                [&](const ActiveVertex& w) { return !std::binary_search(vertices.begin(), vertices.end(), w.vertex); });
  find_watches();
}

/// Sorts vertices to the submesh or the run of the interface that has them. @param records  theirs, in their order
void SubmeshBody::find_watches(std::span<const std::uint32_t> records, Watches& watches) const {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sorted;  // record, place
  for (std::uint32_t place = 0; place < records.size(); ++place) sorted.emplace_back(records[place], place);
  std::sort(sorted.begin(), sorted.end());
  for (auto& list : watches.interior) list.clear();
  for (auto& list : watches.interface) list.clear();
  std::size_t s = 0;
  for (const auto& [record, place] : sorted) {
    if (record >= submeshes_.interface.first_record) {
      const std::size_t k = record - submeshes_.interface.first_record;
      watches.interface[k / kInterfaceChunk].push_back({static_cast<std::uint32_t>(k % kInterfaceChunk), place});
      continue;
    }
    while (record >= submeshes_.parts[s].first_interior + submeshes_.parts[s].interior_count) ++s;
    watches.interior[s].push_back({static_cast<std::uint32_t>(record - submeshes_.parts[s].first_interior), place});
  }
}

void SubmeshBody::find_watches() {
  std::vector<std::uint32_t> records;
  std::vector<char> is_apart(masses_.size(), 0);
  for (const ActiveVertex& w : active_) {
    records.push_back(submeshes_.record_of_vertex[w.vertex]);
    is_apart[records.back()] = std::binary_search(apart_.begin(), apart_.end(), w.vertex) ? 1 : 0;
  }
  find_watches(records, watches_);
  records.clear();
  for (const RestingVertex& r : resting_) records.push_back(submeshes_.record_of_vertex[r.vertex]);
  find_watches(records, rest_watches_);
  for (std::size_t p = 0; p < submeshes_.parts.size(); ++p) {
    const Submesh& part = submeshes_.parts[p];
    const std::vector<Watch>& own = watches_.interior[p];
    const auto asked = [&](std::uint32_t record) { return is_apart[record] != 0; };
    holds_apart_[p] =
        std::any_of(own.begin(), own.end(),
                    [&](const Watch& w) { return asked(static_cast<std::uint32_t>(part.first_interior) + w.local); }) ||
        std::any_of(part.shared.begin(), part.shared.end(), asked);
  }
}

void SubmeshBody::rest(std::span<const std::uint32_t> vertices) {
  std::vector<std::uint32_t> changed;
  for (const RestingVertex& r : resting_) changed.push_back(submeshes_.record_of_vertex[r.vertex]);
  rests_.assign(masses_.size(), 0);
  resting_.clear();
  for (const std::uint32_t v : vertices) {
    const std::uint32_t record = submeshes_.record_of_vertex[v];
    rests_[record] = 1;
    put(Vec3d{}, state_.data() + record * kStateDoubles + 4);
    resting_.push_back({v, {}});
    changed.push_back(record);
  }
  for (const std::uint32_t record : changed) set_coefficients(record);
  find_watches();
}

void SubmeshBody::place_active() {
  for (const ActiveVertex& w : active_) {
    double* record = state_.data() + submeshes_.record_of_vertex[w.vertex] * kStateDoubles;
    put(w.displacement, record);
    put(w.velocity, record + 4);
  }
}

/// A vertex's mass, of which Body::stiff_mass has no weight.
void SubmeshBody::take_mass(std::size_t vertex) {
  const std::uint32_t record = submeshes_.record_of_vertex[vertex];
  const double own = body_.masses[vertex], mass = body_.inertia(vertex);
  masses_[record] = mass;
  if (weighs_.empty() && mass == own) return;
  weighs_.resize(masses_.size(), 1.0);
  weighs_[record] = mass > 0.0 ? own / mass : 1.0;
}

/// c = h/(m + γh) and d = γh/(m + γh) of a record; a vertex without mass, or at rest, does not move.
void SubmeshBody::set_coefficients(std::size_t record) {
  const double denominator = masses_[record] + damping_[record] * step_;
  const bool moves = masses_[record] > 0.0 && rests_[record] == 0;
  state_[record * kStateDoubles + 3] = moves ? step_ / denominator : 0.0;
  state_[record * kStateDoubles + 7] = moves ? damping_[record] * step_ / denominator : 1.0;
}

void SubmeshBody::set_velocity(std::uint32_t vertex, const Vec3d& velocity) {
  put(velocity, state_.data() + submeshes_.record_of_vertex[vertex] * kStateDoubles + 4);
}

void SubmeshBody::inertia_changed(std::span<const std::uint32_t> vertices) {
  for (const std::uint32_t v : vertices) {
    take_mass(v);
    set_coefficients(submeshes_.record_of_vertex[v]);
  }
}

void SubmeshBody::set_step(double h) {
  if (h == step_) return;
  step_ = h;
  for (std::size_t record = 0; record < masses_.size(); ++record) set_coefficients(record);
}

/// Appends the records of new vertices, with the state of those they are copies of.
void SubmeshBody::add_records(std::span<const std::uint32_t> origins) {
  for (const std::uint32_t origin : origins) {
    const auto record = static_cast<std::uint32_t>(masses_.size());
    state_.resize(state_.size() + kStateDoubles);
    std::copy_n(state_.data() + submeshes_.record_of_vertex[origin] * kStateDoubles, kStateDoubles,
                state_.data() + record * kStateDoubles);
    submeshes_.record_of_vertex.push_back(record);
    masses_.push_back(0.0);
    if (!weighs_.empty()) weighs_.push_back(1.0);
    damping_.push_back(0.0);
    rests_.push_back(0);
  }
  make_room_for_stages();
}

/// Takes over the state of vertices that are other points of the material now.
void SubmeshBody::take_states(std::span<const MovedVertex> moved) {
  for (const MovedVertex& m : moved) {
    double* record = state_.data() + submeshes_.record_of_vertex[m.vertex] * kStateDoubles;
    put(m.displacement, record);
    put(m.velocity, record + 4);
    const auto w = std::lower_bound(active_.begin(), active_.end(), m.vertex,
                                    [](const ActiveVertex& a, std::uint32_t vertex) { return a.vertex < vertex; });
    if (w != active_.end() && w->vertex == m.vertex) w->displacement = m.displacement, w->velocity = m.velocity;
  }
}

void SubmeshBody::apply(const BodyChange& change, const detail::VertexStars& stars,
                        std::span<const double> nodal_damping) {
  as_built_ = as_built_ && change.touched.empty();
  take_states(change.moved);
  add_records(change.origins);
  for (const std::uint32_t v : change.touched) {
    const std::uint32_t record = submeshes_.record_of_vertex[v];
    take_mass(v);
    damping_[record] = nodal_damping[v];
    set_coefficients(record);
  }
  if (changer_.apply(change, stars)) {
    make_room();
    find_watches();
  }
  if (any_shared_) weigh_vertices();
}

bool SubmeshBody::supports_tissues() const {
  return std::all_of(body_.blocks.begin(), body_.blocks.end(),
                     [](const TissueBlock& block) { return has_lanes(block.tissue); });
}

void SubmeshBody::tissues_changed(std::span<const std::size_t> blocks, std::span<const double> nodal_damping) {
  std::vector<char> changed(body_.blocks.size(), 0), stays(body_.blocks.size(), 0);
  for (const std::size_t b : blocks) {
    const bool was_viscous = plans_[b].viscous;
    plans_[b] = plan_of(body_.blocks[b]);
    large_plans_[b] = large_plan_of(body_.blocks[b], plans_[b]);
    changed[b] = 1;
    stays[b] = was_viscous && plans_[b].viscous && is_linear(body_.blocks[b]) ? 1 : 0;
  }
  std::atomic<bool> moved = false;
  pool_.run(submeshes_.parts.size(), [&](std::size_t s, std::size_t) {
    Submesh& part = submeshes_.parts[s];
    const bool same_edges = stays[part.block] != 0 && part.edges.count > 0;
    if (changed[part.block] != 0 && !same_edges && changer_.refit(part)) moved = true;
  });
  if (moved) {
    connect(submeshes_);
    make_room();
    find_watches();
  }
  as_built_ = false;
  make_room_for_stages();
  take_masses(nodal_damping);
}

}  // namespace glisson::engine
