// change_submeshes.cpp — a body's change carried into its submeshes; only those it touches are laid out anew.
//
//   removed element   chains: its lane is emptied where it lies        edges: its six are assembled anew
//   split vertex      chains: those with corners that changed are made anew, the others stay (patch_chains.h)
//                     edges: the submesh is laid out anew
//                     the copies come last among the state records, as interface vertices: no other record moves
//   moved vertex      chains: the rest data around it are written anew       edges: the submesh is laid out anew
#include <algorithm>
#include <map>

#include "engine/layout/chain_batches.h"
#include "engine/layout/edge_batches.h"
#include "engine/layout/patch_chains.h"
#include "engine/submesh_body.h"
#include "engine/submesh_scratch.h"

namespace glisson::engine {

void SubmeshBody::find_parts() {
  part_of_element_.assign(body_.elements.size(), 0);
  for (std::uint32_t p = 0; p < submeshes_.parts.size(); ++p) {
    for (const std::uint32_t e : submeshes_.parts[p].elements) part_of_element_[e] = p;
  }
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

void SubmeshBody::take_out(std::uint32_t element, const detail::VertexStars& stars) {
  const std::uint32_t p = part_of_element_[element];
  Submesh& part = submeshes_.parts[p];
  if (part.edges.count == 0) {
    clear_element(part.chains, element, kernels_.lanes);
    return;
  }
  const auto local = [&](std::uint32_t vertex) { return part.local_of_record(submeshes_.record_of_vertex[vertex]); };
  reassemble_edges(body_, body_.blocks[part.block], element, stars, {part_of_element_, p}, local, part.edges,
                   kernels_.lanes);
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

void SubmeshBody::lay_out_touched(const BodyChange& change) {
  std::map<std::uint32_t, ChangedElements> touched;
  for (const detail::CornerChange& c : change.corners) touched[part_of_element_[c.tet]].turned.push_back(c.tet);
  for (const std::uint32_t e : change.reshaped) touched[part_of_element_[e]].reshaped.push_back(e);
  for (auto& [p, changed] : touched) {
    Submesh& part = submeshes_.parts[p];
    std::sort(changed.turned.begin(), changed.turned.end());
    changed.turned.erase(std::unique(changed.turned.begin(), changed.turned.end()), changed.turned.end());
    if (patch_chains(body_, submeshes_.record_of_vertex, changed, part, kernels_.lanes)) continue;
    std::erase_if(part.elements, [&](std::uint32_t e) { return body_.rest[e].volume == 0.0; });
    lay_out(body_, submeshes_.record_of_vertex, part, kernels_.lanes);
  }
  connect(submeshes_);
  make_room();
  find_watches();
}

void SubmeshBody::apply(const BodyChange& change, const detail::VertexStars& stars,
                        std::span<const double> nodal_damping) {
  if (part_of_element_.empty()) find_parts();
  as_built_ = as_built_ && change.touched.empty();
  take_states(change.moved);
  add_records(change.origins);
  for (const std::uint32_t v : change.touched) {
    const std::uint32_t record = submeshes_.record_of_vertex[v];
    take_mass(v);
    damping_[record] = nodal_damping[v];
    set_coefficients(record);
  }
  for (const std::uint32_t e : change.removed) take_out(e, stars);
  if (!change.corners.empty() || !change.reshaped.empty()) lay_out_touched(change);
  if (any_shared_) weigh_vertices();
}

}  // namespace glisson::engine
