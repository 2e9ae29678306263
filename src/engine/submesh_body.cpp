// submesh_body.cpp — what a body of submeshes is and how it changes; how it makes a step is in submesh_step.cpp.
#include "engine/submesh_body.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>

#include "element/block_response.h"
#include "engine/layout/archive_submeshes.h"
#include "glisson/simulation/instruction_set.h"

namespace glisson::engine {
namespace {

const Kernels& kernels_of(const SubmeshOptions& options) {
  if (options.kernels != nullptr) return *options.kernels;
  cpu::use_instruction_set_of_environment();
  return best_kernels();
}

}  // namespace

SubmeshBody::SubmeshBody(const Body& body, std::span<const double> nodal_damping, const SubmeshOptions& options)
    : body_(body), kernels_(kernels_of(options)),
      submeshes_(build_submeshes(body, kernels_.lanes, options.submesh_tets)), active_(submeshes_, records_),
      changer_(body, submeshes_, kernels_.lanes),
      forces_(body, submeshes_, records_, kernels_, options.precision_error), volumes_(body, submeshes_),
      memory_(body, submeshes_, records_, kernels_.lanes), stages_(options.drag_stages, submeshes_, records_, kernels_),
      pool_(options.threads > 0 ? options.threads : detail::threads_for(body.elements.size())) {
  follow_layout(nodal_damping);
}

SubmeshBody::~SubmeshBody() = default;

/// Room, plans and masses for the submeshes there are.
void SubmeshBody::follow_layout(std::span<const double> nodal_damping) {
  records_.reset(body_.vertex_count);
  active_.rest({});
  forces_.reset();
  make_room();
  make_room_for_stages();
  take_masses(nodal_damping);
  prepare_linear();
}

/// Assembles the linear forms of all submeshes that may need one, so that no step has to.
void SubmeshBody::prepare_linear() {
  if (!forces_.precision().on()) return;
  pool_.run(submeshes_.parts.size(), [&](std::size_t s, std::size_t) {
    Submesh& part = submeshes_.parts[s];
    if (forces_.has_twin(part.block)) forces_.prepare_linear(part);
  });
}

/// Finds active vertices, and makes room for what depends on the sizes of submeshes and interface.
void SubmeshBody::make_room() {
  active_.locate();
  slots_elastic_.resize(submeshes_.interface.slot_count * kForceFloats);
  slots_viscous_.resize(slots_elastic_.size());
  found_.resize(submeshes_.parts.size());
  work_.resize(submeshes_.parts.size() + active_.chunks());
  std::size_t largest = kInterfaceChunk;
  for (const Submesh& part : submeshes_.parts) largest = std::max(largest, part.local_vertices());
  scratch_.resize(static_cast<std::size_t>(pool_.threads()));
  for (auto& scratch : scratch_) {
    if (scratch == nullptr) scratch = std::make_unique<SubmeshScratch>();
    scratch->make_room(largest);
  }
}

/// Stages of drag, where something drags.
void SubmeshBody::make_room_for_stages() {
  const bool any = std::any_of(body_.blocks.begin(), body_.blocks.end(),
                               [](const TissueBlock& b) { return b.tissue.viscosity > 0.0; });
  stages_.make_room(any ? body_.vertex_count : 0);
}

/// Masses and damping of all vertices, and what follows from them and the tissues.
void SubmeshBody::take_masses(std::span<const double> nodal_damping) {
  for (std::uint32_t v = 0; v < body_.vertex_count; ++v) {
    take_mass(v);
    records_.set_damping(record_of(v), nodal_damping[v]);
  }
  volumes_.weigh();
}

/// A vertex's mass, of which Body::stiff_mass has no weight.
void SubmeshBody::take_mass(std::uint32_t vertex) {
  records_.set_mass(record_of(vertex), body_.inertia(vertex), body_.masses[vertex]);
}

void SubmeshBody::inertia_changed(std::span<const std::uint32_t> vertices) {
  for (const std::uint32_t v : vertices) take_mass(v);
}

void SubmeshBody::set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) {
  for (std::uint32_t v = 0; v < displacement.size(); ++v) {
    records_.set_state(record_of(v), displacement[v], velocity[v]);
  }
  for (ActiveVertex& w : active_.active()) w.displacement = displacement[w.vertex], w.velocity = velocity[w.vertex];
  forces_.inversions().reset();
  forces_.precision().reset();
  memory_.relax();
}

void SubmeshBody::read_state(std::span<Vec3d> displacement, std::span<Vec3d> velocity) const {
  for (std::uint32_t v = 0; v < displacement.size(); ++v) {
    displacement[v] = displacement_of(v);
    velocity[v] = velocity_of(v);
  }
}

void SubmeshBody::read_velocities(std::span<const std::uint32_t> vertices, std::span<Vec3d> velocities) const {
  for (std::size_t k = 0; k < vertices.size(); ++k) velocities[k] = velocity_of(vertices[k]);
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
  if (forces_.precision().on()) {
    for (const std::size_t s : changer_.parts_of(change)) leave_linear(s);
  }
  if (changer_.apply(change, stars)) make_room();
  volumes_.weigh();
}

/// A submesh goes by its own law from now on.
void SubmeshBody::leave_linear(std::size_t s) {
  Submesh& part = submeshes_.parts[s];
  std::vector<std::uint32_t> elements = part.elements;
  std::sort(elements.begin(), elements.end());
  if (part.linear.alone()) memory_.leave_linear(part, elements);
  if (part.linear.share > 0.0 && forces_.accounted()) {
    const TissueBlock& block = body_.blocks[part.block];
    const BlockResponse response(body_, block, ElementList(elements));
    const std::vector<Vec3d> u = records_.displacements(submeshes_.record_of_vertex);
    BranchMemory mixed;
    mixed.linear.assign(block.end - block.begin, part.linear.share);
    brought_in_ += response.energy(u) - response.energy(u, &mixed);
  }
  forces_.precision().leave(s);
  part.linear.edges = {};
}

bool SubmeshBody::supports_tissues() const {
  return std::all_of(body_.blocks.begin(), body_.blocks.end(),
                     [](const TissueBlock& block) { return has_lanes(block.tissue); });
}

void SubmeshBody::tissues_changed(std::span<const std::size_t> blocks, std::span<const double> nodal_damping) {
  std::vector<char> changed(body_.blocks.size(), 0), stays(body_.blocks.size(), 0);
  for (const std::size_t b : blocks) {
    const bool was_viscous = forces_.plan(b).viscous;
    forces_.take_tissue(b);
    changed[b] = 1;
    stays[b] = was_viscous && forces_.plan(b).viscous && is_linear(body_.blocks[b]) ? 1 : 0;
  }
  std::atomic<bool> moved = false;
  for (std::size_t s = 0; s < submeshes_.parts.size(); ++s) {
    if (changed[submeshes_.parts[s].block] == 0) continue;
    forces_.precision().leave(s);
    submeshes_.parts[s].linear = {};
  }
  pool_.run(submeshes_.parts.size(), [&](std::size_t s, std::size_t) {
    Submesh& part = submeshes_.parts[s];
    const bool same_edges = stays[part.block] != 0 && part.edges.count > 0;
    if (changed[part.block] != 0 && !same_edges && changer_.refit(part)) moved = true;
  });
  if (moved) {
    connect(submeshes_);
    make_room();
  }
  as_built_ = false;
  make_room_for_stages();
  take_masses(nodal_damping);
  prepare_linear();
}

void SubmeshBody::archive_layout(Archive& ar, std::span<const double> nodal_damping) {
  bool as_built = as_built_;
  auto lanes = static_cast<std::uint32_t>(kernels_.lanes);
  ar(as_built, lanes);
  if (as_built) {  // else what has changed here would have to go back; copies of vertices come from changes alone
    return ar.check(as_built_ && submeshes_.record_of_vertex.size() == body_.vertex_count);
  }
  ar.check(lanes > 0 && lanes <= kMaxLanes);
  if (!ar.reads()) return write_submeshes(ar, submeshes_, body_, lanes);
  submeshes_ = read_submeshes(ar, body_, lanes, kernels_.lanes);
  as_built_ = false;
  changer_.forget();
  follow_layout(nodal_damping);
}

namespace {

struct SavedLayout {
  Submeshes submeshes;
  bool as_built;
};

}  // namespace

std::shared_ptr<const void> SubmeshBody::save_layout() const {
  return std::make_shared<const SavedLayout>(SavedLayout{submeshes_, as_built_});
}

void SubmeshBody::load_layout(const std::shared_ptr<const void>& layout, std::span<const double> nodal_damping) {
  const auto& saved = *std::static_pointer_cast<const SavedLayout>(layout);
  active_.keep({});
  active_.rest({});
  submeshes_ = saved.submeshes;
  as_built_ = saved.as_built;
  changer_.forget();
  follow_layout(nodal_damping);
}

/// Steps made, when the branches were kept last, where to look for inverted tets, and the branches in the order of elements.
void SubmeshBody::archive_past(Archive& ar) {
  ar(steps_);
  memory_.archive_time(ar);
  forces_.inversions().archive(ar);
  memory_.archive_numbers(ar);
  if (forces_.precision().on()) archive_precision(ar);
}

/// Which elements are linear, and what their branches go on from. Submeshes that are others now, laid out for other lanes, go by
/// their own law unless all of their elements agree.
void SubmeshBody::archive_precision(Archive& ar) {
  std::vector<double> share(body_.elements.size(), 0.0);
  std::vector<std::uint8_t> wanted(share.size(), 0);
  double since = 0.0;
  for (const Submesh& part : submeshes_.parts) {
    for (const std::uint32_t e : part.elements) share[e] = part.linear.share, wanted[e] = part.linear.wanted ? 1 : 0;
    if (part.linear.alone()) since = part.linear.since;
  }
  ar.same_size(share), ar.same_size(wanted);
  bool accounted = forces_.accounted();
  ar(since, brought_in_, accounted);
  if (ar.reads()) forces_.set_accounted(accounted);
  ar.check(since >= 0.0);
  memory_.archive_stresses(ar);
  if (ar.reads()) {
    for (Submesh& part : submeshes_.parts) take_linear({share, wanted, since}, part, ar);
  }
  ar(forces_.precision());
}

void SubmeshBody::take_linear(const LinearElements& read, Submesh& part, const Archive& ar) {
  const auto same = [&](std::uint32_t e) {
    const std::uint32_t first = part.elements.front();
    return read.share[e] == read.share[first] && read.wanted[e] == read.wanted[first];
  };
  part.linear.wanted = false, part.linear.share = 0.0, part.linear.since = read.since;
  if (part.elements.empty()) return;
  if (std::all_of(part.elements.begin(), part.elements.end(), same)) {
    part.linear.share = read.share[part.elements.front()], part.linear.wanted = read.wanted[part.elements.front()] != 0;
    const double steps = part.linear.share / kShareStep;
    ar.check(steps >= 0.0 && part.linear.share <= 1.0 && steps == std::floor(steps));
    ar.check(forces_.has_twin(part.block) || (part.linear.share == 0.0 && !part.linear.wanted));
    if (part.linear.share > 0.0) forces_.prepare_linear(part);
    return;
  }
  std::vector<std::uint32_t> alone;
  std::copy_if(part.elements.begin(), part.elements.end(), std::back_inserter(alone),
               [&](std::uint32_t e) { return read.share[e] == 1.0; });
  std::sort(alone.begin(), alone.end());
  if (!alone.empty() && forces_.has_twin(part.block)) memory_.leave_linear(part, alone);
}

}  // namespace glisson::engine
