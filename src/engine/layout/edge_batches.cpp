#include "engine/layout/edge_batches.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <bit>
#include <limits>

namespace glisson::engine {
namespace {

/// An edge of the submesh.
struct Edge {
  std::uint32_t i, j;  ///< local vertices, i < j
  Mat3d tensor;
};

/// −V s_i ⊗ s_j where the tissue is viscous, else −K_ij = −V [λ s_i ⊗ s_j + μ (s_j ⊗ s_i + (s_i·s_j) I)]
/// [Schwartz2002, eq. 5].
Mat3d edge_tensor(const TissueBlock& block, double volume, const Vec3d& si, const Vec3d& sj) {
  const bool viscous = block.tissue.viscosity > 0.0;
  const double lambda = block.elastic.lambda, mu = block.elastic.mu, inner = dot(si, sj);
  Mat3d T;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double A = si[r] * sj[c], B = sj[r] * si[c] + (r == c ? inner : 0.0);
      T(r, c) = -volume * (viscous ? A : lambda * A + mu * B);
    }
  }
  return T;
}

/// One element's share in an edge: local vertices, element and its two corners in one number, in the order in which shares
/// are added up. 16 + 16 bits, 28 for the place of the element, 2 + 2.
using Share = std::uint64_t;
constexpr unsigned kCornerBits = 2, kPlaceBits = 28, kLocalBits = 16;
static_assert(kMaxLocalVertices <= 1U << kLocalBits);

std::vector<Share> sorted_shares(std::span<const Tet> local) {
  std::vector<Share> shares;
  shares.reserve(6 * local.size());
  for (std::size_t k = 0; k < local.size(); ++k) {
    for (std::uint64_t a = 0; a < 4; ++a) {
      for (std::uint64_t b = a + 1; b < 4; ++b) {
        const bool ordered = local[k][a] < local[k][b];
        const std::uint64_t from = ordered ? a : b, to = ordered ? b : a;
        const std::uint64_t edge = std::uint64_t{local[k][from]} << kLocalBits | local[k][to];
        shares.push_back((edge << kPlaceBits | k) << 2 * kCornerBits | from << kCornerBits | to);
      }
    }
  }
  std::sort(shares.begin(), shares.end());
  return shares;
}

/// Adds up the shares of each edge, in order of element.
std::vector<Edge> assembled(const Body& body, const TissueBlock& block, std::span<const std::uint32_t> elements,
                            std::span<const Tet> local) {
  std::vector<Edge> edges;
  edges.reserve(2 * local.size());
  for (const Share share : sorted_shares(local)) {
    const std::size_t place = share >> 2 * kCornerBits & ((1U << kPlaceBits) - 1U);
    const std::size_t from = share >> kCornerBits & 3U, to = share & 3U;
    const std::uint32_t i = local[place][from], j = local[place][to];
    const ElementRest& rest = body.rest[elements[place]];
    const std::array<Vec3d, 4> s = shape_gradients(rest);
    const Mat3d tensor = edge_tensor(block, rest.volume, s[from], s[to]);
    if (edges.empty() || edges.back().i != i || edges.back().j != j) {
      edges.push_back({i, j, tensor});
    } else {
      for (std::size_t k = 0; k < 9; ++k) edges.back().tensor(k / 3, k % 3) += tensor(k / 3, k % 3);
    }
  }
  return edges;
}

}  // namespace

EdgeBatches make_edge_batches(const Body& body, const TissueBlock& block, std::span<const std::uint32_t> elements,
                              std::span<const Tet> local, std::size_t lanes) {
  const std::vector<Edge> edges = assembled(body, block, elements, local);

  EdgeBatches out;
  out.count = (edges.size() + lanes - 1) / lanes;
  out.index.assign(out.count * 2 * lanes, 0);
  out.tensor.assign(out.count * 9 * lanes, 0.0F);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const std::size_t batch = e % out.count, lane = e / out.count;
    out.index[batch * 2 * lanes + lane] = static_cast<std::uint16_t>(edges[e].i);
    out.index[(batch * 2 + 1) * lanes + lane] = static_cast<std::uint16_t>(edges[e].j);
    for (std::size_t k = 0; k < 9; ++k) {
      out.tensor[(batch * 9 + k) * lanes + lane] = static_cast<float>(edges[e].tensor(k / 3, k % 3));
    }
  }
  return out;
}

namespace {

using LocalEdge = std::pair<std::uint32_t, std::uint32_t>;

/// Where an edge lies.
struct EdgePlace {
  std::size_t batch, lane;
};

LocalEdge edge_at(const EdgeBatches& edges, const EdgePlace& at, std::size_t lanes) {
  const std::uint16_t* index = edges.index.data() + at.batch * 2 * lanes + at.lane;
  return {index[0], index[lanes]};
}

/// How many of `n` come before each of six, found by halves; all six in step, so that they wait for memory together.
/// @param comes_before  whether the one numbered so comes before the k-th of the six
template <class ComesBefore>
std::array<std::size_t, 6> count_before(std::size_t n, const ComesBefore& comes_before) {
  std::array<std::size_t, 6> low{};
  while (n > 0) {
    const std::size_t half = n / 2;
    for (std::size_t k = 0; k < low.size(); ++k) low[k] += comes_before(low[k] + half, k) ? n - half : 0;
    n = half;
  }
  return low;
}

/// Places of edges that are there. They are sorted, lane after lane, and the lanes after the last are (0, 0).
std::array<EdgePlace, 6> find_edges(const EdgeBatches& edges, const std::array<LocalEdge, 6>& wanted,
                                    std::size_t lanes) {
  const auto is_there = [](const LocalEdge& e) { return e.first != e.second; };
  const auto begun = count_before(lanes, [&](std::size_t lane, std::size_t k) {
    const LocalEdge at = edge_at(edges, {0, lane}, lanes);
    return is_there(at) && !(wanted[k] < at);
  });
  const auto before = count_before(edges.count, [&](std::size_t batch, std::size_t k) {
    const LocalEdge at = edge_at(edges, {batch, begun[k] - 1}, lanes);
    return is_there(at) && at < wanted[k];
  });
  std::array<EdgePlace, 6> places{};
  for (std::size_t k = 0; k < places.size(); ++k) places[k] = {before[k], begun[k] - 1};
  return places;
}

void add(Mat3d& sum, const Mat3d& share) {
  for (std::size_t k = 0; k < 9; ++k) sum(k / 3, k % 3) += share(k / 3, k % 3);
}

/// Without a branch, which nothing could foresee; the last one where it is none.
std::size_t corner_of(const Tet& tet, std::uint32_t vertex) {
  unsigned at = 1U << 3;
  for (unsigned c = 0; c < 3; ++c) at |= static_cast<unsigned>(tet[c] == vertex) << c;
  return static_cast<std::size_t>(std::countr_zero(at));
}

/// An element around some of four vertices, and which of them it holds: bit k for the k-th.
struct Around {
  std::uint32_t element;
  unsigned holds;
};

/// The elements that hold two of four vertices or more, ascending: their stars gone through side by side. Nothing hangs on a
/// branch that could not be foreseen, and what is read next is asked for.
std::vector<Around> around_edges(const Body& body, const detail::VertexStars& stars, const Tet& vertices) {
  constexpr std::uint32_t kEnd = std::numeric_limits<std::uint32_t>::max();
  std::array<std::span<const std::uint32_t>, 4> left;
  std::array<std::uint32_t, 4> head{};
  std::size_t most = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    left[k] = stars.tets_at(vertices[k]);
    head[k] = left[k].empty() ? kEnd : left[k].front();
    most += left[k].size();
  }
  std::vector<Around> around(most + 1);
  std::size_t n = 0;
  for (;;) {
    const std::uint32_t e = std::min(std::min(head[0], head[1]), std::min(head[2], head[3]));
    if (e == kEnd) break;
    unsigned holds = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const bool here = head[k] == e;
      holds |= static_cast<unsigned>(here) << k;
      left[k] = left[k].subspan(here ? 1 : 0);
      head[k] = left[k].empty() ? kEnd : left[k].front();
    }
    around[n] = {e, holds};
    n += std::popcount(holds) > 1 ? 1 : 0;
  }
  around.resize(n);
  for (const Around& a : around) {
    hwy::Prefetch(&body.elements[a.element]);
    hwy::Prefetch(&body.rest[a.element].volume);
    hwy::Prefetch(&body.rest[a.element].s[2]);
  }
  return around;
}

}  // namespace

void reassemble_edges(const Body& body, const TissueBlock& block, std::uint32_t element,
                      const detail::VertexStars& stars, const InSubmesh& submesh,
                      const std::function<std::uint32_t(std::uint32_t)>& local, EdgeBatches& edges, std::size_t lanes) {
  std::array<LocalEdge, 4> corners;  // local vertex, vertex of the mesh
  for (std::size_t a = 0; a < 4; ++a) corners[a] = {local(body.elements[element][a]), body.elements[element][a]};
  std::sort(corners.begin(), corners.end());
  const Tet vertices{corners[0].second, corners[1].second, corners[2].second, corners[3].second};

  const std::vector<Around> around = around_edges(body, stars, vertices);
  std::array<LocalEdge, 6> wanted;
  for (std::size_t a = 0, edge = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b, ++edge) wanted[edge] = {corners[a].first, corners[b].first};
  }
  const std::array<EdgePlace, 6> places = find_edges(edges, wanted, lanes);
  std::array<Mat3d, 6> tensors{};
  for (const Around& a : around) {
    if (submesh.of_element[a.element] != submesh.number) continue;
    const ElementRest& rest = body.rest[a.element];
    const std::array<Vec3d, 4> s = shape_gradients(rest);
    std::array<std::size_t, 4> corner{};
    for (std::size_t k = 0; k < 4; ++k) corner[k] = corner_of(body.elements[a.element], vertices[k]);
    for (std::size_t from = 0, edge = 0; from < 4; ++from) {
      for (std::size_t to = from + 1; to < 4; ++to, ++edge) {
        if ((a.holds >> from & a.holds >> to & 1U) == 0) continue;
        add(tensors[edge], edge_tensor(block, rest.volume, s[corner[from]], s[corner[to]]));
      }
    }
  }
  for (std::size_t edge = 0; edge < 6; ++edge) {
    float* tensor = edges.tensor.data() + places[edge].batch * 9 * lanes + places[edge].lane;
    for (std::size_t k = 0; k < 9; ++k) tensor[k * lanes] = static_cast<float>(tensors[edge](k / 3, k % 3));
  }
}

}  // namespace glisson::engine
