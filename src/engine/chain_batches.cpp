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

}  // namespace

ChainBatches make_chain_batches(const Body& body, std::span<const std::uint32_t> elements, std::span<const Tet> local,
                                std::size_t lanes) {
  const std::vector<detail::TetChain> chains = detail::chain_tets(local);
  ChainBatches out;
  out.count = (chains.size() + lanes - 1) / lanes;
  out.index.assign(out.count * kChainVertices * lanes, 0);
  out.rest.assign(out.count * kChainTets * kTetRest * lanes, 0.0F);
  out.element.assign(out.count * kChainTets * lanes, kNoElement);
  for (std::size_t k = 0; k < chains.size(); ++k) {
    const std::size_t batch = k % out.count, lane = k / out.count;  // lanes of a batch are far apart
    const Chain chain = placed(local, chains[k]);
    for (std::size_t a = 0; a < kChainVertices; ++a) {
      out.index[(batch * kChainVertices + a) * lanes + lane] =
          static_cast<std::uint16_t>(kIndexScale * chain.vertex[a]);
    }
    for (std::size_t which = 0; which < kChainTets; ++which) {
      const std::uint32_t t = chain.tet[which];
      if (t == detail::kNoTet) continue;
      out.element[(batch * kChainTets + which) * lanes + lane] = elements[t];
      const auto& [a, b, c] = kGradientVertices[which];
      write_tet(out, batch, which, lane, lanes, body.rest[elements[t]], local[t],
                {chain.vertex[a], chain.vertex[b], chain.vertex[c]});
    }
  }
  return out;
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

bool clear_element(ChainBatches& chains, std::uint32_t element, std::size_t lanes) {
  const std::size_t place = find_number(chains.element, element);
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
