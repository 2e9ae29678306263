#include "engine/chain_batches.h"

#include <algorithm>

#include "mesh/tet_chains.h"

namespace glisson::engine {
namespace {

/// Which vertices of a chain the gradients in rest belong to, of tets A, B, C.
constexpr std::array<std::array<std::size_t, 3>, kChainTets> kGradientVertices{{{1, 2, 4}, {1, 2, 3}, {1, 3, 5}}};

/// Three tets as the kernel sees them: local vertices 0 … 5 of layout.h.
struct Chain {
  std::array<std::uint32_t, kChainVertices> vertex;
  std::array<std::uint32_t, kChainTets> tet;  ///< A, B, C: positions in the list, or kNoTet
};

bool holds(const Tet& t, std::uint32_t vertex) { return std::find(t.begin(), t.end(), vertex) != t.end(); }

/// The corner of `t` that `other` does not have.
std::size_t corner_beyond(const Tet& t, const Tet& other) {
  std::size_t a = 0;
  while (holds(other, t[a])) ++a;
  return a;
}

/// Corners of the middle tet that lie opposite its ends; any others where an end is missing.
std::array<std::size_t, 2> opposite_corners(std::span<const Tet> local, const detail::TetChain& chain) {
  const Tet& B = local[chain.middle];
  const std::size_t a = chain.ends[0] == detail::kNoTet ? 3 : corner_beyond(B, local[chain.ends[0]]);
  const std::size_t c = chain.ends[1] == detail::kNoTet ? (a + 1) % 4 : corner_beyond(B, local[chain.ends[1]]);
  return {a, c};
}

Chain placed(std::span<const Tet> local, const detail::TetChain& chain) {
  const Tet& B = local[chain.middle];
  const std::array<std::size_t, 2> opposite = opposite_corners(local, chain);
  Chain placed{{}, {chain.ends[0], chain.middle, chain.ends[1]}};
  std::size_t on_edge = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    if (a != opposite[0] && a != opposite[1]) placed.vertex[on_edge++] = B[a];
  }
  placed.vertex[2] = B[opposite[1]];
  placed.vertex[3] = B[opposite[0]];
  const auto beyond = [&](std::uint32_t end) {
    return end == detail::kNoTet ? B[opposite[0]] : local[end][corner_beyond(local[end], B)];
  };
  placed.vertex[4] = beyond(chain.ends[0]);
  placed.vertex[5] = beyond(chain.ends[1]);
  return placed;
}

/// Shape gradient of the local vertex in an element.
Vec3d shape_gradient(const ElementRest& rest, const Tet& local, std::uint32_t vertex) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (local[a + 1] == vertex) return rest.s[a];
  }
  return -(rest.s[0] + rest.s[1] + rest.s[2]);
}

/// Writes one tet of a chain into its lane.
void write_tet(ChainBatches& out, std::size_t batch, std::size_t which, std::size_t lane, std::size_t lanes,
               const ElementRest& rest, const Tet& local, const std::array<std::uint32_t, 3>& vertices) {
  float* to = out.rest.data() + (batch * kChainTets + which) * kTetRest * lanes + lane;
  for (std::size_t a = 0; a < 3; ++a) {
    const Vec3d s = shape_gradient(rest, local, vertices[a]);
    for (std::size_t i = 0; i < 3; ++i) to[(3 * a + i) * lanes] = static_cast<float>(s[i]);
  }
  to[9 * lanes] = -static_cast<float>(rest.volume);
}

/// The elements that chains are made of.
struct Listed {
  const Body& body;
  std::span<const std::uint32_t> elements;
  std::span<const Tet> local;
};

void resize(ChainBatches& out, std::size_t count, std::size_t lanes) {
  out.count = count;
  out.index.resize(count * kChainVertices * lanes, 0);
  out.rest.resize(count * kChainTets * kTetRest * lanes, 0.0F);
  out.element.resize(count * kChainTets * lanes, kNoElement);
}

void write_chain(ChainBatches& out, std::size_t batch, std::size_t lane, std::size_t lanes, const Listed& list,
                 const detail::TetChain& tets) {
  const Chain chain = placed(list.local, tets);
  for (std::size_t a = 0; a < kChainVertices; ++a) {
    out.index[(batch * kChainVertices + a) * lanes + lane] = static_cast<std::uint16_t>(kIndexScale * chain.vertex[a]);
  }
  for (std::size_t which = 0; which < kChainTets; ++which) {
    const std::uint32_t t = chain.tet[which];
    if (t == detail::kNoTet) continue;
    out.element[(batch * kChainTets + which) * lanes + lane] = list.elements[t];
    const auto& [a, b, c] = kGradientVertices[which];
    write_tet(out, batch, which, lane, lanes, list.body.rest[list.elements[t]], list.local[t],
              {chain.vertex[a], chain.vertex[b], chain.vertex[c]});
  }
}

bool is_free(const ChainBatches& chains, std::size_t batch, std::size_t lane, std::size_t lanes) {
  for (std::size_t which = 0; which < kChainTets; ++which) {
    if (chains.element[(batch * kChainTets + which) * lanes + lane] != kNoElement) return false;
  }
  return true;
}

}  // namespace

ChainBatches make_chain_batches(const Body& body, std::span<const std::uint32_t> elements, std::span<const Tet> local,
                                std::size_t lanes) {
  const std::vector<detail::TetChain> chains = detail::chain_tets(local);
  ChainBatches out;
  resize(out, (chains.size() + lanes - 1) / lanes, lanes);
  for (std::size_t k = 0; k < chains.size(); ++k) {  // lanes of a batch are far apart
    write_chain(out, k % out.count, k / out.count, lanes, {body, elements, local}, chains[k]);
  }
  return out;
}

void add_chains(const Body& body, ChainBatches& out, std::span<const std::uint32_t> elements,
                std::span<const Tet> local, std::size_t lanes, std::size_t first_batch) {
  std::size_t at = first_batch * lanes;  // batch × lanes + lane
  for (const detail::TetChain& chain : detail::chain_tets(local)) {
    while (at < out.count * lanes && !is_free(out, at / lanes, at % lanes, lanes)) ++at;
    if (at == out.count * lanes) resize(out, out.count + 1, lanes);
    write_chain(out, at / lanes, at % lanes, lanes, {body, elements, local}, chain);
  }
}

namespace {

/// Position of a number that is there once at most, the size where it is not. Whole runs are compared in lanes.
std::size_t find_number(std::span<const std::uint32_t> numbers, std::uint32_t wanted) {
  constexpr std::size_t kRun = 64;
  for (std::size_t begin = 0; begin < numbers.size(); begin += kRun) {
    const std::size_t end = std::min(begin + kRun, numbers.size());
    std::uint32_t found = 0;
    for (std::size_t k = begin; k < end; ++k) found |= static_cast<std::uint32_t>(numbers[k] == wanted);
    if (found == 0) continue;
    return static_cast<std::size_t>(std::find(&numbers[begin], &numbers[end - 1], wanted) - numbers.data());
  }
  return numbers.size();
}

}  // namespace

std::size_t place_of_element(const ChainBatches& chains, std::uint32_t element) {
  return find_number(chains.element, element);
}

std::vector<std::uint32_t> elements_of_chain(const ChainBatches& chains, std::size_t place, std::size_t lanes) {
  std::vector<std::uint32_t> elements;
  const std::size_t first = place / (kChainTets * lanes) * kChainTets * lanes + place % lanes;
  for (std::size_t which = 0; which < kChainTets; ++which) {
    const std::uint32_t e = chains.element[first + which * lanes];
    if (e != kNoElement) elements.push_back(e);
  }
  return elements;
}

void rewrite_element(const Body& body, ChainBatches& chains, std::size_t place, const Tet& local, std::size_t lanes) {
  const std::size_t batch = place / (kChainTets * lanes), which = place / lanes % kChainTets, lane = place % lanes;
  std::array<std::uint32_t, 3> vertices;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t vertex = kGradientVertices[which][a];
    vertices[a] = chains.index[(batch * kChainVertices + vertex) * lanes + lane] / kIndexScale;
  }
  write_tet(chains, batch, which, lane, lanes, body.rest[chains.element[place]], local, vertices);
}

bool clear_element(ChainBatches& chains, std::uint32_t element, std::size_t lanes) {
  const std::size_t place = place_of_element(chains, element);
  if (place == chains.element.size()) return false;
  float* rest = chains.rest.data() + place / lanes * kTetRest * lanes + place % lanes;
  for (std::size_t k = 0; k < kTetRest; ++k) rest[k * lanes] = 0.0F;
  chains.element[place] = kNoElement;
  return true;
}

float gradient_reach(const Body& body, std::span<const std::uint32_t> elements) {
  double reach = 0.0;
  for (const std::uint32_t e : elements) {
    const auto& s = body.rest[e].s;
    reach = std::max(reach, norm(s[0]) + norm(s[1]) + norm(s[2]));
  }
  return static_cast<float>(reach);
}

}  // namespace glisson::engine
