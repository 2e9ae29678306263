#include "engine/edge_batches.h"

#include <hwy/cache_control.h>

#include <algorithm>

namespace glisson::engine {
namespace {

/// An edge of the submesh.
struct Edge {
  std::uint32_t i, j;  ///< local vertices, i < j
  Mat3d tensor;
};

/// −V s_i ⊗ s_j where the tissue is viscous, else −K_ij = −V [λ s_i ⊗ s_j + μ (s_j ⊗ s_i + (s_i·s_j) I)].
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
/// are added up. 14 + 14 bits, 28 for the place of the element, 2 + 2.
using Share = std::uint64_t;
constexpr unsigned kCornerBits = 2, kPlaceBits = 28, kLocalBits = 14;

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
    const std::array<Vec3d, 4> s{-(rest.s[0] + rest.s[1] + rest.s[2]), rest.s[0], rest.s[1], rest.s[2]};
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

LocalEdge edge_at(const EdgeBatches& edges, std::size_t k, std::size_t lanes) {
  const std::uint16_t* index = edges.index.data() + k % edges.count * 2 * lanes + k / edges.count;
  return {index[0], index[lanes]};
}

/// Number of an edge that is there: they are sorted, and the lanes after the last are (0, 0).
std::size_t find_edge(const EdgeBatches& edges, LocalEdge edge, std::size_t lanes) {
  std::size_t low = 0, high = edges.count * lanes;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    const LocalEdge at = edge_at(edges, middle, lanes);
    const bool padding = at.first == at.second;
    if (!padding && at < edge) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

/// Shape gradients of the four corners.
std::array<Vec3d, 4> shape_gradients(const ElementRest& rest) {
  return {-(rest.s[0] + rest.s[1] + rest.s[2]), rest.s[0], rest.s[1], rest.s[2]};
}

void add(Mat3d& sum, const Mat3d& share) {
  for (std::size_t k = 0; k < 9; ++k) sum(k / 3, k % 3) += share(k / 3, k % 3);
}

/// The part of an element in one of the six edges that are assembled anew.
struct EdgePart {
  std::uint32_t element;
  std::uint8_t edge, from, to;  ///< edge: 0 … 5; from, to: corners of the element
};

std::uint8_t corner_of(const Tet& tet, std::uint32_t vertex) {
  return static_cast<std::uint8_t>(std::find(tet.begin(), tet.end(), vertex) - tet.begin());
}

/// Finds the elements around the edges between four vertices, by edge, ascending. What is read lies far apart, so
/// that most of the time goes by waiting for memory: all of it is asked for ahead.
std::vector<EdgePart> parts_of_edges(const Body& body, const detail::VertexStars& stars, const Tet& vertices,
                                     const std::function<bool(std::uint32_t)>& in_submesh) {
  for (std::size_t a = 0; a < 3; ++a) {
    for (const std::uint32_t e : stars.tets_at(vertices[a])) hwy::Prefetch(&body.elements[e]);
  }
  std::vector<EdgePart> parts;
  std::uint8_t first_edge = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    for (const std::uint32_t e : stars.tets_at(vertices[a])) {
      const Tet& tet = body.elements[e];
      for (std::size_t b = a + 1; b < 4; ++b) {
        const std::uint8_t to = corner_of(tet, vertices[b]);
        if (to == 4 || !in_submesh(e)) continue;
        hwy::Prefetch(&body.rest[e].volume);
        hwy::Prefetch(&body.rest[e].s[2]);
        parts.push_back({e, static_cast<std::uint8_t>(first_edge + b - a - 1), corner_of(tet, vertices[a]), to});
      }
    }
    first_edge = static_cast<std::uint8_t>(first_edge + 3 - a);
  }
  return parts;
}

}  // namespace

void reassemble_edges(const Body& body, const TissueBlock& block, std::uint32_t element,
                      const detail::VertexStars& stars, const std::function<bool(std::uint32_t)>& in_submesh,
                      const std::function<std::uint32_t(std::uint32_t)>& local, EdgeBatches& edges, std::size_t lanes) {
  std::array<LocalEdge, 4> corners;  // local vertex, vertex of the mesh
  for (std::size_t a = 0; a < 4; ++a) corners[a] = {local(body.elements[element][a]), body.elements[element][a]};
  std::sort(corners.begin(), corners.end());
  const Tet vertices{corners[0].second, corners[1].second, corners[2].second, corners[3].second};

  std::array<Mat3d, 6> tensors{};
  for (const EdgePart& part : parts_of_edges(body, stars, vertices, in_submesh)) {
    const ElementRest& rest = body.rest[part.element];
    const std::array<Vec3d, 4> s = shape_gradients(rest);
    add(tensors[part.edge], edge_tensor(block, rest.volume, s[part.from], s[part.to]));
  }
  const Mat3d* sum = tensors.data();
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b, ++sum) {
      const std::size_t at = find_edge(edges, {corners[a].first, corners[b].first}, lanes);
      float* tensor = edges.tensor.data() + at % edges.count * 9 * lanes + at / edges.count;
      for (std::size_t k = 0; k < 9; ++k) tensor[k * lanes] = static_cast<float>((*sum)(k / 3, k % 3));
    }
  }
}

}  // namespace glisson::engine
