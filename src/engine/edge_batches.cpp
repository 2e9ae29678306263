#include "engine/edge_batches.h"

#include <algorithm>

namespace glisson::engine {
namespace {

/// One element's share in an edge.
struct Share {
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

void add_shares(const Body& body, const TissueBlock& block, std::uint32_t element, const Tet& local,
                std::vector<Share>& shares) {
  const ElementRest& rest = body.rest[element];
  const std::array<Vec3d, 4> s{-(rest.s[0] + rest.s[1] + rest.s[2]), rest.s[0], rest.s[1], rest.s[2]};
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) {
      const bool ordered = local[a] < local[b];
      const std::size_t i = ordered ? a : b, j = ordered ? b : a;
      shares.push_back({local[i], local[j], edge_tensor(block, rest.volume, s[i], s[j])});
    }
  }
}

/// Adds up the shares of each edge, in order of element.
std::vector<Share> assembled(std::vector<Share> shares) {
  std::stable_sort(shares.begin(), shares.end(),
                   [](const Share& a, const Share& b) { return std::pair(a.i, a.j) < std::pair(b.i, b.j); });
  std::vector<Share> edges;
  for (const Share& s : shares) {
    if (edges.empty() || edges.back().i != s.i || edges.back().j != s.j) {
      edges.push_back(s);
    } else {
      for (std::size_t k = 0; k < 9; ++k) edges.back().tensor(k / 3, k % 3) += s.tensor(k / 3, k % 3);
    }
  }
  return edges;
}

}  // namespace

EdgeBatches make_edge_batches(const Body& body, const TissueBlock& block, std::span<const std::uint32_t> elements,
                              std::span<const Tet> local, std::size_t lanes) {
  std::vector<Share> shares;
  shares.reserve(6 * elements.size());
  for (std::size_t k = 0; k < elements.size(); ++k) add_shares(body, block, elements[k], local[k], shares);
  const std::vector<Share> edges = assembled(std::move(shares));

  EdgeBatches out;
  out.count = (edges.size() + lanes - 1) / lanes;
  out.index.assign(out.count * 2 * lanes, 0);
  out.tensor.assign(out.count * 9 * lanes, 0.0F);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const std::size_t batch = e % out.count, lane = e / out.count;
    out.index[batch * 2 * lanes + lane] = static_cast<std::uint16_t>(kIndexScale * edges[e].i);
    out.index[(batch * 2 + 1) * lanes + lane] = static_cast<std::uint16_t>(kIndexScale * edges[e].j);
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
  return {index[0] / kIndexScale, index[lanes] / kIndexScale};
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

Vec3d shape_gradient(const ElementRest& rest, const Tet& tet, std::uint32_t vertex) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (tet[a + 1] == vertex) return rest.s[a];
  }
  return -(rest.s[0] + rest.s[1] + rest.s[2]);
}

}  // namespace

void reassemble_edges(const Body& body, const TissueBlock& block, std::uint32_t element,
                      const detail::VertexStars& stars, const std::function<bool(std::uint32_t)>& in_submesh,
                      const std::function<std::uint32_t(std::uint32_t)>& local, EdgeBatches& edges, std::size_t lanes) {
  const Tet& corners = body.elements[element];
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) {
      const bool ordered = local(corners[a]) < local(corners[b]);
      const std::uint32_t i = corners[ordered ? a : b], j = corners[ordered ? b : a];
      Mat3d sum;
      for (const std::uint32_t e : stars.tets_at(i)) {
        const Tet& t = body.elements[e];
        if (std::find(t.begin(), t.end(), j) == t.end() || !in_submesh(e)) continue;
        const ElementRest& rest = body.rest[e];
        const Mat3d share = edge_tensor(block, rest.volume, shape_gradient(rest, t, i), shape_gradient(rest, t, j));
        for (std::size_t k = 0; k < 9; ++k) sum(k / 3, k % 3) += share(k / 3, k % 3);
      }
      const std::size_t at = find_edge(edges, {local(i), local(j)}, lanes);
      float* tensor = edges.tensor.data() + at % edges.count * 9 * lanes + at / edges.count;
      for (std::size_t k = 0; k < 9; ++k) tensor[k * lanes] = static_cast<float>(sum(k / 3, k % 3));
    }
  }
}

}  // namespace glisson::engine
