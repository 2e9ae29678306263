// submesh_body.cpp — what a body of submeshes is and holds; how it makes a step is in submesh_step.cpp.
#include "engine/submesh_body.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

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
      active_(submeshes_, records_), stages_(drag_stages(options.drag_stages)) {
  follow_layout(nodal_damping);
}

/// Room, plans and masses for the submeshes there are.
void SubmeshBody::follow_layout(std::span<const double> nodal_damping) {
  records_.reset(body_.vertex_count);
  active_.rest({});
  make_room_for_stages();
  looked_.assign(submeshes_.parts.size(), Looked::small), found_.resize(submeshes_.parts.size());
  plans_.clear(), large_plans_.clear();
  for (const TissueBlock& block : body_.blocks) {
    plans_.push_back(plan_of(block));
    large_plans_.push_back(large_plan_of(block, plans_.back()));
  }
  make_room();
  take_masses(nodal_damping);
}

/// Masses and damping of all vertices, and what follows from them and the tissues.
void SubmeshBody::take_masses(std::span<const double> nodal_damping) {
  for (std::uint32_t v = 0; v < body_.vertex_count; ++v) {
    take_mass(v);
    records_.set_damping(record_of(v), nodal_damping[v]);
  }
  any_shared_ = std::any_of(submeshes_.parts.begin(), submeshes_.parts.end(),
                            [&](const Submesh& part) { return shares_volume(part); });
  if (any_shared_) weigh_vertices();
}

SubmeshBody::~SubmeshBody() = default;

/// Memory for what depends on the sizes of submeshes and interface.
void SubmeshBody::make_room() {
  slots_elastic_.resize(submeshes_.interface.slot_count * kForceFloats);
  slots_viscous_.resize(slots_elastic_.size());
  interface_found_.resize(active_.chunks());
  std::size_t largest = kInterfaceChunk;
  for (const Submesh& part : submeshes_.parts) largest = std::max(largest, part.local_vertices());
  scratch_.resize(static_cast<std::size_t>(pool_.threads()));
  for (auto& scratch : scratch_) {
    if (scratch == nullptr) scratch = std::make_unique<Scratch>();
    scratch->make_room(largest);
  }
}

void SubmeshBody::set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) {
  for (std::uint32_t v = 0; v < displacement.size(); ++v) {
    records_.set_state(record_of(v), displacement[v], velocity[v]);
  }
  for (ActiveVertex& w : active_.active()) w.displacement = displacement[w.vertex], w.velocity = velocity[w.vertex];
  std::fill(looked_.begin(), looked_.end(), Looked::small);
  since_memory_ = std::numeric_limits<double>::infinity();  // a state that is set has relaxed
}

void SubmeshBody::read_state(std::span<Vec3d> displacement, std::span<Vec3d> velocity) const {
  for (std::uint32_t v = 0; v < displacement.size(); ++v) {
    displacement[v] = displacement_of(v);
    velocity[v] = velocity_of(v);
  }
}

void SubmeshBody::rest(std::span<const std::uint32_t> vertices) {
  std::vector<std::uint32_t> records;
  for (const std::uint32_t v : vertices) records.push_back(record_of(v));
  records_.rest(records);
  active_.rest(vertices);
}

void SubmeshBody::place_active() {
  for (const ActiveVertex& w : active_.active()) records_.set_state(record_of(w.vertex), w.displacement, w.velocity);
}

/// A vertex's mass, of which Body::stiff_mass has no weight.
void SubmeshBody::take_mass(std::uint32_t vertex) {
  records_.set_mass(record_of(vertex), body_.inertia(vertex), body_.masses[vertex]);
}

void SubmeshBody::inertia_changed(std::span<const std::uint32_t> vertices) {
  for (const std::uint32_t v : vertices) take_mass(v);
}

/// Takes over the state of vertices that are other points of the material now.
void SubmeshBody::take_states(std::span<const MovedVertex> moved) {
  for (const MovedVertex& m : moved) {
    records_.set_state(record_of(m.vertex), m.displacement, m.velocity);
    if (ActiveVertex* w = active_.find(m.vertex)) w->displacement = m.displacement, w->velocity = m.velocity;
  }
}

void SubmeshBody::apply(const BodyChange& change, const detail::VertexStars& stars,
                        std::span<const double> nodal_damping) {
  as_built_ = as_built_ && change.touched.empty();
  take_states(change.moved);
  for (const std::uint32_t origin : change.origins) {
    submeshes_.record_of_vertex.push_back(static_cast<std::uint32_t>(records_.size()));
    records_.add_copy(record_of(origin));
  }
  make_room_for_stages();
  for (const std::uint32_t v : change.touched) {
    take_mass(v);
    records_.set_damping(record_of(v), nodal_damping[v]);
  }
  if (changer_.apply(change, stars)) {
    active_.locate();
    make_room();
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
    active_.locate();
    make_room();
  }
  as_built_ = false;
  make_room_for_stages();
  take_masses(nodal_damping);
}

}  // namespace glisson::engine
