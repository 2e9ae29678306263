#include "engine/layout/archive_submeshes.h"

#include <algorithm>
#include <functional>
#include <numeric>

#include "engine/layout/chain_batches.h"
#include "engine/layout/response_batches.h"

namespace glisson::engine {
namespace {

/// The element numbers of batches are those of the submesh, each that is there once.
bool holds_all(const ChainBatches& chains, const Body& body, std::vector<std::uint32_t> elements) {
  std::erase_if(elements, [&](std::uint32_t e) { return body.rest[e].volume == 0.0; });
  std::vector<std::uint32_t> held = chains.element;
  std::erase(held, kNoElement);
  std::sort(held.begin(), held.end());
  std::sort(elements.begin(), elements.end());
  return held == elements;
}

void archive_chains(Archive& ar, const Body& body, Submesh& part, std::size_t lanes) {
  ChainBatches& c = part.chains;
  auto count = static_cast<std::uint64_t>(c.count), pairs = static_cast<std::uint64_t>(c.pairs),
       closed = static_cast<std::uint64_t>(c.closed_pairs), laid_out = static_cast<std::uint64_t>(part.laid_out);
  ar(count, pairs, closed, laid_out, c.rest, c.element);
  ar.all_below(c.index, part.local_vertices());
  ar.check(count <= c.element.size() && closed <= pairs && 2 * pairs <= laid_out && laid_out <= count);
  ar.check(c.index.size() == count * kChainVertices * lanes && c.rest.size() == count * kChainRest * lanes &&
           c.element.size() == count * kChainTets * lanes && holds_all(c, body, part.elements));
  if (ar.reads()) c.count = count, c.pairs = pairs, c.closed_pairs = closed, part.laid_out = laid_out;
}

/// Vertices and elements of a submesh, and where its elements lie.
void archive_part(Archive& ar, const Body& body, const Interface& interface, Submesh& part, std::size_t lanes) {
  auto block = static_cast<std::uint32_t>(part.block), inside = static_cast<std::uint32_t>(part.interior_count);
  ar.below(block, body.blocks.size());
  ar(inside, part.shared, part.elements, part.gradient_reach);
  if (ar.reads()) part.block = block, part.interior_count = inside;
  const TissueBlock& tissue = body.blocks[block];
  ar.check(part.local_vertices() <= kMaxLocalVertices &&
           std::adjacent_find(part.shared.begin(), part.shared.end(), std::greater_equal<>()) == part.shared.end());
  for (const std::uint32_t r : part.shared) ar.check(r >= interface.first_record && r < body.vertex_count);
  for (const std::uint32_t e : part.elements) ar.check(e >= tissue.begin && e < tissue.end);
  if (!is_linear(tissue)) archive_chains(ar, body, part, lanes);
}

bool has_record(const Submesh& part, std::uint32_t record) {
  return (record >= part.first_interior && record < part.first_interior + part.interior_count) ||
         std::binary_search(part.shared.begin(), part.shared.end(), record);
}

/// Where state records and submeshes are, checked against the body.
struct Layout {
  Submeshes& submeshes;
  const Body& body;
  std::size_t lanes;

  void archive(Archive& ar) {
    auto first = static_cast<std::uint32_t>(submeshes.interface.first_record);
    auto parts = static_cast<std::uint32_t>(submeshes.parts.size());
    ar(submeshes.record_of_vertex, first, parts);
    ar.check(parts <= body.elements.size() && submeshes.record_of_vertex.size() == body.vertex_count);
    if (ar.reads()) submeshes.interface.first_record = first, submeshes.parts.resize(parts);
    for (Submesh& part : submeshes.parts) archive_part(ar, body, submeshes.interface, part, lanes);
  }

  /// Every vertex has a record, every element that is there a submesh that has all its vertices.
  void check(const Archive& ar) {
    std::vector<std::uint32_t> records = submeshes.record_of_vertex, all(records.size());
    std::sort(records.begin(), records.end());
    std::iota(all.begin(), all.end(), 0U);
    ar.check(records == all);
    std::vector<char> held(body.elements.size(), 0);
    std::size_t next = 0;
    for (Submesh& part : submeshes.parts) {
      part.first_interior = next;
      next += part.interior_count;
      for (const std::uint32_t e : part.elements) {
        ar.check(held[e] == 0);
        held[e] = 1;
        for (const std::uint32_t v : body.elements[e]) ar.check(has_record(part, submeshes.record_of_vertex[v]));
      }
    }
    ar.check(next == submeshes.interface.first_record && next <= body.vertex_count);
    for (std::size_t e = 0; e < held.size(); ++e) ar.check(held[e] != 0 || body.rest[e].volume == 0.0);
  }

  /// What is not written.
  void complete() {
    for (Submesh& part : submeshes.parts) {
      const TissueBlock& tissue = body.blocks[part.block];
      const float reach = part.gradient_reach;
      if (is_linear(tissue)) {
        lay_out(body, submeshes.record_of_vertex, part, lanes);
      } else {
        lay_out_response(body, tissue.tissue, {}, part, lanes);
      }
      part.gradient_reach = reach;
    }
    connect(submeshes);
  }
};

}  // namespace

void write_submeshes(Archive& ar, Submeshes& submeshes, const Body& body, std::size_t lanes) {
  Layout{submeshes, body, lanes}.archive(ar);
}

Submeshes read_submeshes(Archive& ar, const Body& body, std::size_t written, std::size_t lanes) {
  Submeshes read;
  Layout layout{read, body, written};
  layout.archive(ar);
  layout.check(ar);
  if (written != lanes) return build_submeshes(body, lanes, submesh_tets(body.elements.size(), true));
  layout.complete();
  return read;
}

}  // namespace glisson::engine
