#include "engine/layout/chain_batches.h"

#include <algorithm>

#include "mesh/partition/tet_chains.h"
#include "mesh/partition/tet_fans.h"

namespace glisson::engine {
namespace {

/// The vertices of tets A, B, C beside 0 and 1.
constexpr std::array<std::array<std::size_t, 2>, kChainTets> kRingVertices{{{4, 2}, {2, 3}, {3, 5}}};

/// Three tets as the kernel sees them: local vertices 0 … 5 of layout.h.
struct Chain {
  std::array<std::uint32_t, kChainVertices> vertex;
  std::array<std::uint32_t, kChainTets> tet;  ///< A, B, C: positions in the list, or kNoTet
};

/// Whether the corners of a tet in this order are right-handed, as they are in the order of the mesh.
bool is_right_handed(const Tet& t, Tet order) {
  bool even = true;
  for (std::size_t k = 0; k < 3; ++k) {
    if (order[k] == t[k]) continue;
    std::iter_swap(&order[k], std::find(order.begin(), order.end(), t[k]));
    even = !even;
  }
  return even;
}

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
  const auto& v = placed.vertex;
  if (!is_right_handed(B, {v[0], v[1], v[2], v[3]})) std::swap(placed.vertex[0], placed.vertex[1]);
  const auto beyond = [&](std::uint32_t end) {
    return end == detail::kNoTet ? B[opposite[0]] : local[end][corner_beyond(local[end], B)];
  };
  placed.vertex[4] = beyond(chain.ends[0]);
  placed.vertex[5] = beyond(chain.ends[1]);
  return placed;
}

/// The corner of `t` that is none of these.
std::uint32_t remaining_vertex(const Tet& t, std::uint32_t p, std::uint32_t q, std::uint32_t r) {
  return *std::find_if(t.begin(), t.end(), [&](std::uint32_t v) { return v != p && v != q && v != r; });
}

/// The two chains of a fan, whose edge is 0–1 of both, with r₀ … r₃ and r₃ … r₆ as their vertices 4, 2, 3, 5.
std::array<Chain, 2> placed(std::span<const Tet> local, const detail::TetFan& fan) {
  const Tet& first = local[fan.tets[0]];
  std::array<std::uint32_t, 2> edge{};
  std::size_t on_edge = 0;
  for (const std::uint32_t v : first) {
    if (holds(local[fan.tets[1]], v) && holds(local[fan.tets[2]], v)) edge[on_edge++] = v;
  }
  const std::uint32_t behind = first[corner_beyond(first, local[fan.tets[1]])];
  const std::uint32_t ahead = remaining_vertex(first, edge[0], edge[1], behind);
  if (!is_right_handed(first, {edge[0], edge[1], behind, ahead})) std::swap(edge[0], edge[1]);
  std::array<std::uint32_t, detail::kFanTets + 1> ring{behind};
  for (std::size_t k = 0; k < detail::kFanTets; ++k) {
    ring[k + 1] = remaining_vertex(local[fan.tets[k]], edge[0], edge[1], ring[k]);
  }
  const auto chain = [&](std::size_t k) {
    return Chain{{edge[0], edge[1], ring[k + 1], ring[k + 2], ring[k], ring[k + 3]},
                 {fan.tets[k], fan.tets[k + 1], fan.tets[k + 2]}};
  };
  return {chain(0), chain(kChainTets)};
}

/// Where an element lies.
struct Place {
  std::size_t batch, which, lane;
};
Place place_at(std::size_t position, std::size_t lanes) {
  return {position / (kChainTets * lanes), position / lanes % kChainTets, position % lanes};
}

/// Rest position of the local vertex of an element.
const Vec3d& rest_position(const Body& body, std::uint32_t element, const Tet& local, std::uint32_t vertex) {
  const auto corner = static_cast<std::size_t>(std::find(local.begin(), local.end(), vertex) - local.begin());
  return body.rest_positions[body.elements[element][corner]];
}

/// Writes the rest data of one tet of a chain, those that the other chain of a fan has for both included. The vertices of
/// the chain are there already.
void write_tet(const Body& body, ChainBatches& out, const Place& to, std::uint32_t element, const Tet& local,
               std::size_t lanes) {
  const std::uint16_t* index = out.index.data() + to.batch * kChainVertices * lanes + to.lane;
  const auto position = [&](std::size_t vertex) { return rest_position(body, element, local, index[vertex * lanes]); };
  const auto rest = [&](std::size_t batch) { return out.rest.data() + batch * kChainRest * lanes + to.lane; };
  const auto put = [&](std::size_t batch, std::size_t row, const Vec3d& v) {
    for (std::size_t i = 0; i < 3; ++i) rest(batch)[(row + i) * lanes] = static_cast<float>(v[i]);
  };
  const bool second = to.batch < 2 * out.pairs && to.batch % 2 == 1, closed = to.batch < 2 * out.closed_pairs;
  const Vec3d e1 = position(1) - position(0);
  std::array<Vec3d, 2> edges;
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t vertex = kRingVertices[to.which][k];
    edges[k] = position(vertex) - position(0);
    const Vec3d spoke = cross(e1, edges[k]);
    put(to.batch, kRestSpoke[vertex], spoke);
    if (second && vertex == 4) put(to.batch - 1, kRestSpoke[5], spoke);
    if (second && closed && vertex == 5) put(to.batch - 1, kRestSpoke[4], spoke);
  }
  put(to.batch, kRestAcross + 3 * to.which, cross(edges[0], edges[1]));
  rest(to.batch)[(kRestScale + to.which) * lanes] = static_cast<float>(1.0 / (6.0 * body.rest[element].volume));
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
  out.rest.resize(count * kChainRest * lanes, 0.0F);
  out.element.resize(count * kChainTets * lanes, kNoElement);
}

void write_chain(ChainBatches& out, std::size_t batch, std::size_t lane, std::size_t lanes, const Listed& list,
                 const Chain& chain) {
  for (std::size_t a = 0; a < kChainVertices; ++a) {
    out.index[(batch * kChainVertices + a) * lanes + lane] = static_cast<std::uint16_t>(chain.vertex[a]);
  }
  for (std::size_t which = 0; which < kChainTets; ++which) {
    const std::uint32_t t = chain.tet[which];
    if (t == detail::kNoTet) continue;
    out.element[(batch * kChainTets + which) * lanes + lane] = list.elements[t];
    write_tet(list.body, out, {batch, which, lane}, list.elements[t], list.local[t], lanes);
  }
}

bool is_free(const ChainBatches& chains, std::size_t batch, std::size_t lane, std::size_t lanes) {
  for (std::size_t which = 0; which < kChainTets; ++which) {
    if (chains.element[(batch * kChainTets + which) * lanes + lane] != kNoElement) return false;
  }
  return true;
}

/// How many fans are kept: whole batches of closed ones, then of any. What is left over makes chains.
void choose_fans(ChainBatches& out, std::vector<detail::TetFan>& fans, std::size_t lanes) {
  const auto closed = std::count_if(fans.begin(), fans.end(), [](const detail::TetFan& f) { return f.closed; });
  out.closed_pairs = static_cast<std::size_t>(closed) / lanes;
  out.pairs = fans.size() / lanes;
  fans.resize(out.pairs * lanes);
}

/// Tets of the list that no fan has, and their positions in it.
struct Leftover {
  std::vector<std::uint32_t> tets;
  std::vector<Tet> local;
};

Leftover left_over(std::span<const Tet> local, const std::vector<detail::TetFan>& fans) {
  std::vector<char> taken(local.size(), 0);
  for (const detail::TetFan& fan : fans) {
    for (const std::uint32_t t : fan.tets) taken[t] = 1;
  }
  Leftover rest;
  for (std::uint32_t t = 0; t < local.size(); ++t) {
    if (taken[t] == 0) rest.tets.push_back(t), rest.local.push_back(local[t]);
  }
  return rest;
}

Chain in_whole_list(Chain chain, const std::vector<std::uint32_t>& position) {
  for (std::uint32_t& t : chain.tet) t = t == detail::kNoTet ? t : position[t];
  return chain;
}

}  // namespace

ChainBatches make_chain_batches(const Body& body, std::span<const std::uint32_t> elements, std::span<const Tet> local,
                                std::size_t lanes) {
  std::vector<detail::TetFan> fans = detail::fan_tets(local);
  ChainBatches out;
  choose_fans(out, fans, lanes);
  const Leftover rest = left_over(local, fans);
  const std::vector<detail::TetChain> chains = detail::chain_tets(rest.local);
  const std::size_t first = 2 * out.pairs, single = (chains.size() + lanes - 1) / lanes;
  resize(out, first + single, lanes);
  const Listed list{body, elements, local};
  const auto put_pairs = [&](std::size_t from, std::size_t pairs) {  // lanes of a batch are far apart
    for (std::size_t k = 0; k < pairs * lanes; ++k) {
      const std::array<Chain, 2> both = placed(local, fans[from * lanes + k]);
      const std::size_t batch = 2 * (from + k % pairs);
      write_chain(out, batch, k / pairs, lanes, list, both[0]);
      write_chain(out, batch + 1, k / pairs, lanes, list, both[1]);
    }
  };
  put_pairs(0, out.closed_pairs);
  put_pairs(out.closed_pairs, out.pairs - out.closed_pairs);
  for (std::size_t k = 0; k < chains.size(); ++k) {
    write_chain(out, first + k % single, k / single, lanes, list,
                in_whole_list(placed(rest.local, chains[k]), rest.tets));
  }
  return out;
}

void add_chains(const Body& body, ChainBatches& out, std::span<const std::uint32_t> elements,
                std::span<const Tet> local, std::size_t lanes, std::size_t first_batch) {
  std::size_t at = first_batch * lanes;  // batch × lanes + lane
  for (const detail::TetChain& chain : detail::chain_tets(local)) {
    while (at < out.count * lanes && !is_free(out, at / lanes, at % lanes, lanes)) ++at;
    if (at == out.count * lanes) resize(out, out.count + 1, lanes);
    write_chain(out, at / lanes, at % lanes, lanes, {body, elements, local}, placed(local, chain));
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
  write_tet(body, chains, place_at(place, lanes), chains.element[place], local, lanes);
}

bool clear_element(ChainBatches& chains, std::uint32_t element, std::size_t lanes) {
  const std::size_t place = place_of_element(chains, element);
  if (place == chains.element.size()) return false;
  const Place at = place_at(place, lanes);
  chains.rest[(at.batch * kChainRest + kRestScale + at.which) * lanes + at.lane] = 0.0F;
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
