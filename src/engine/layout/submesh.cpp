#include "engine/layout/submesh.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

#include "engine/layout/chain_batches.h"
#include "engine/layout/edge_batches.h"
#include "engine/layout/response_batches.h"
#include "mesh/partition/partition.h"

namespace glisson::engine {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Elements of each submesh, block by block.
std::vector<Submesh> split(const Body& body, std::size_t target_tets) {
  std::vector<Submesh> parts;
  for (std::size_t b = 0; b < body.blocks.size(); ++b) {
    std::vector<std::uint32_t> chosen(body.blocks[b].end - body.blocks[b].begin);
    std::iota(chosen.begin(), chosen.end(), static_cast<std::uint32_t>(body.blocks[b].begin));
    std::erase_if(chosen, [&](std::uint32_t e) { return body.rest[e].volume == 0.0; });  // of a body that was cut
    if (chosen.empty()) continue;
    const detail::TetPartition partition =
        detail::partition_tets(body.rest_positions, body.elements, chosen, target_tets);
    for (std::size_t p = 0; p < partition.parts(); ++p) {
      parts.emplace_back();
      parts.back().block = b;
      parts.back().elements.assign(partition.part(p).begin(), partition.part(p).end());
    }
  }
  return parts;
}

/// Which submesh holds a vertex: its number, kNone before any, kShared where there are several.
constexpr std::uint32_t kShared = kNone - 1;
std::vector<std::uint32_t> owners(const Body& body, const std::vector<Submesh>& parts) {
  std::vector<std::uint32_t> owner(body.vertex_count, kNone);
  for (std::uint32_t p = 0; p < parts.size(); ++p) {
    for (const std::uint32_t e : parts[p].elements) {
      for (const std::uint32_t v : body.elements[e]) owner[v] = owner[v] == kNone || owner[v] == p ? p : kShared;
    }
  }
  return owner;
}

/// Numbers the state records: interiors of each submesh in order of first use, then all others.
void number_records(const Body& body, const std::vector<std::uint32_t>& owner, Submeshes& out) {
  out.record_of_vertex.assign(body.vertex_count, kNone);
  std::uint32_t next = 0;
  for (std::uint32_t p = 0; p < out.parts.size(); ++p) {
    Submesh& part = out.parts[p];
    part.first_interior = next;
    for (const std::uint32_t e : part.elements) {
      for (const std::uint32_t v : body.elements[e]) {
        if (owner[v] == p && out.record_of_vertex[v] == kNone) out.record_of_vertex[v] = next++;
      }
    }
    part.interior_count = next - part.first_interior;
  }
  out.interface.first_record = next;
  for (const Submesh& part : out.parts) {
    for (const std::uint32_t e : part.elements) {
      for (const std::uint32_t v : body.elements[e]) {
        if (out.record_of_vertex[v] == kNone) out.record_of_vertex[v] = next++;
      }
    }
  }
  for (std::uint32_t& record : out.record_of_vertex) {
    if (record == kNone) record = next++;  // in no tet
  }
}

bool in_interior(const Submesh& part, std::uint32_t record) {
  return record >= part.first_interior && record < part.first_interior + part.interior_count;
}

/// Lists the records of a submesh's elements that are not in its interior.
void list_shared(const Body& body, const std::vector<std::uint32_t>& record_of_vertex, Submesh& part) {
  part.shared.clear();
  for (const std::uint32_t e : part.elements) {
    for (const std::uint32_t v : body.elements[e]) {
      if (!in_interior(part, record_of_vertex[v])) part.shared.push_back(record_of_vertex[v]);
    }
  }
  std::sort(part.shared.begin(), part.shared.end());
  part.shared.erase(std::unique(part.shared.begin(), part.shared.end()), part.shared.end());
}

/// Local vertices of some elements of a submesh.
std::vector<Tet> local_tets(const Body& body, const std::vector<std::uint32_t>& record_of_vertex, const Submesh& part,
                            std::span<const std::uint32_t> elements) {
  std::vector<Tet> local;
  for (const std::uint32_t e : elements) {
    const Tet& t = body.elements[e];
    local.push_back({part.local_of_record(record_of_vertex[t[0]]), part.local_of_record(record_of_vertex[t[1]]),
                     part.local_of_record(record_of_vertex[t[2]]), part.local_of_record(record_of_vertex[t[3]])});
  }
  return local;
}

}  // namespace

std::size_t submesh_tets(std::size_t tets, bool changes) {
  constexpr std::size_t kSubmeshes = 16;
  constexpr auto kMost =
      static_cast<std::size_t>(static_cast<double>(kMaxLocalVertices) / 4 / (1 + detail::kPartSlack)) - 1;
  return changes ? kLeastSubmesh : std::clamp(tets / kSubmeshes, kLeastSubmesh, kMost);
}

bool is_linear(const TissueBlock& block) { return block.tissue.is_tensor_mass() && block.tissue.has_constant_moduli(); }

std::uint32_t Submesh::local_of_record(std::uint32_t record) const {
  if (in_interior(*this, record)) return record - static_cast<std::uint32_t>(first_interior);
  const auto at = std::lower_bound(shared.begin(), shared.end(), record) - shared.begin();
  return static_cast<std::uint32_t>(interior_count) + static_cast<std::uint32_t>(at);
}

void lay_out(const Body& body, const std::vector<std::uint32_t>& record_of_vertex, Submesh& part, std::size_t lanes) {
  list_shared(body, record_of_vertex, part);
  const std::vector<Tet> local = local_tets(body, record_of_vertex, part, part.elements);
  if (part.local_vertices() > kMaxLocalVertices) {
    throw std::invalid_argument("submesh: " + std::to_string(part.local_vertices()) + " vertices, above " +
                                std::to_string(kMaxLocalVertices) + " that can be numbered; aim at fewer tets");
  }
  const TissueBlock& block = body.blocks[part.block];
  part.gradient_reach = gradient_reach(body, part.elements);
  part.linear = {};
  if (is_linear(block)) {
    part.edges = make_edge_batches(body, block, part.elements, local, lanes);
  } else {
    const ChainBatches before = std::move(part.chains);
    part.chains = make_chain_batches(body, part.elements, local, lanes);
    part.laid_out = part.chains.count;
    lay_out_response(body, block.tissue, before, part, lanes);
  }
}

void assemble_linear(const Body& body, const TissueBlock& twin, const std::vector<std::uint32_t>& record_of_vertex,
                     Submesh& part, std::size_t lanes) {
  if (part.linear.edges.count > 0) return;
  std::vector<std::uint32_t> there = part.elements;
  std::erase_if(there, [&](std::uint32_t e) { return body.rest[e].volume == 0.0; });
  part.linear.edges = make_edge_batches(body, twin, there, local_tets(body, record_of_vertex, part, there), lanes);
}

void connect(Submeshes& out) {
  Interface& shared = out.interface;
  const std::size_t count = out.record_of_vertex.size() - shared.first_record;
  shared.slot_begin.assign(count + 1, 0);
  shared.slot_count = 0;
  for (Submesh& part : out.parts) {
    part.first_slot = shared.slot_count;
    shared.slot_count += part.shared.size();
    for (const std::uint32_t r : part.shared) ++shared.slot_begin[r - shared.first_record + 1];
  }
  std::partial_sum(shared.slot_begin.begin(), shared.slot_begin.end(), shared.slot_begin.begin());
  shared.slots.resize(shared.slot_count);
  std::vector<std::uint32_t> next(shared.slot_begin.begin(), shared.slot_begin.end() - 1);
  for (const Submesh& part : out.parts) {
    for (std::size_t k = 0; k < part.shared.size(); ++k) {
      shared.slots[next[part.shared[k] - shared.first_record]++] = static_cast<std::uint32_t>(part.first_slot + k);
    }
  }
}

Submeshes build_submeshes(const Body& body, std::size_t lanes, std::size_t target_tets) {
  Submeshes out;
  out.parts = split(body, target_tets);
  number_records(body, owners(body, out.parts), out);
  for (Submesh& part : out.parts) lay_out(body, out.record_of_vertex, part, lanes);
  connect(out);
  return out;
}

double bytes_per_tet(const Submeshes& submeshes, std::size_t tets) {
  std::size_t bytes = submeshes.record_of_vertex.size() * kStateDoubles * sizeof(double);
  for (const Submesh& part : submeshes.parts) {
    bytes += part.chains.index.size() * sizeof(std::uint16_t) + part.chains.rest.size() * sizeof(float);
    bytes += part.edges.index.size() * sizeof(std::uint16_t) + part.edges.tensor.size() * sizeof(float);
    bytes += (part.fibre.size() + part.memory.size()) * sizeof(float);
    bytes += part.shared.size() * (sizeof(std::uint32_t) + kForceFloats * sizeof(float));  // record, slot
  }
  bytes += submeshes.interface.slots.size() * sizeof(std::uint32_t);
  return static_cast<double>(bytes) / static_cast<double>(tets);
}

}  // namespace glisson::engine
