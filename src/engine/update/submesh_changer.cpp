#include "engine/update/submesh_changer.h"

#include <algorithm>
#include <map>

#include "engine/layout/chain_batches.h"
#include "engine/layout/edge_batches.h"
#include "engine/layout/patch_chains.h"
#include "engine/layout/response_batches.h"

namespace glisson::engine {

void SubmeshChanger::find_parts() {
  part_of_element_.assign(body_.elements.size(), 0);
  for (std::uint32_t p = 0; p < submeshes_.parts.size(); ++p) {
    for (const std::uint32_t e : submeshes_.parts[p].elements) part_of_element_[e] = p;
  }
}

void SubmeshChanger::take_out(std::uint32_t element, const detail::VertexStars& stars) {
  const std::uint32_t p = part_of_element_[element];
  Submesh& part = submeshes_.parts[p];
  if (part.edges.count == 0) {
    clear_element(part.chains, element, lanes_);
    return;
  }
  const auto local = [&](std::uint32_t vertex) { return part.local_of_record(submeshes_.record_of_vertex[vertex]); };
  reassemble_edges(body_, body_.blocks[part.block], element, stars, {part_of_element_, p}, local, part.edges, lanes_);
}

void SubmeshChanger::lay_out_touched(const BodyChange& change) {
  std::map<std::uint32_t, ChangedElements> touched;
  for (const detail::CornerChange& c : change.corners) touched[part_of_element_[c.tet]].turned.push_back(c.tet);
  for (const std::uint32_t e : change.reshaped) touched[part_of_element_[e]].reshaped.push_back(e);
  for (auto& [p, changed] : touched) {
    Submesh& part = submeshes_.parts[p];
    std::sort(changed.turned.begin(), changed.turned.end());
    changed.turned.erase(std::unique(changed.turned.begin(), changed.turned.end()), changed.turned.end());
    if (patch_chains(body_, submeshes_.record_of_vertex, changed, part, lanes_)) continue;
    std::erase_if(part.elements, [&](std::uint32_t e) { return body_.rest[e].volume == 0.0; });
    lay_out(body_, submeshes_.record_of_vertex, part, lanes_);
  }
}

std::vector<std::size_t> SubmeshChanger::parts_of(const BodyChange& change) {
  if (part_of_element_.empty()) find_parts();
  std::vector<std::size_t> parts;
  for (const std::uint32_t e : change.removed) parts.push_back(part_of_element_[e]);
  for (const std::uint32_t e : change.reshaped) parts.push_back(part_of_element_[e]);
  for (const detail::CornerChange& c : change.corners) parts.push_back(part_of_element_[c.tet]);
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
  return parts;
}

bool SubmeshChanger::apply(const BodyChange& change, const detail::VertexStars& stars) {
  if (part_of_element_.empty()) find_parts();
  for (const std::uint32_t e : change.removed) take_out(e, stars);
  if (change.corners.empty() && change.reshaped.empty()) return false;
  lay_out_touched(change);
  connect(submeshes_);
  return true;
}

bool SubmeshChanger::refit(Submesh& part) const {
  const TissueBlock& block = body_.blocks[part.block];
  const bool by_edges = part.edges.count > 0, turns = by_edges != is_linear(block);
  part.fibre.clear(), part.memory.clear();
  if (!turns && !by_edges) {
    lay_out_response(body_, block.tissue, {}, part, lanes_);
    return false;
  }
  if (turns) {
    part.edges = {}, part.chains = {};
    std::erase_if(part.elements, [&](std::uint32_t e) { return body_.rest[e].volume == 0.0; });
  }
  lay_out(body_, submeshes_.record_of_vertex, part, lanes_);
  return turns;
}

}  // namespace glisson::engine
