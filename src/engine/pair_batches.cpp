#include "engine/pair_batches.h"

#include <algorithm>

#include "mesh/tet_pairs.h"

namespace glisson::engine {
namespace {

/// Two tets as the kernel sees them: local vertices 0 … 4 of layout.h.
struct Pair {
  std::array<std::uint32_t, kPairVertices> vertex;
  std::array<std::uint32_t, 2> tet;  ///< positions in the list; the second may be kNoTet
};

bool holds(const Tet& t, std::uint32_t vertex) { return std::find(t.begin(), t.end(), vertex) != t.end(); }

Pair alone(std::span<const Tet> local, std::uint32_t tet) {
  const Tet& t = local[tet];
  return {{t[1], t[0], t[2], t[3], t[1]}, {tet, detail::kNoTet}};
}

Pair joined(std::span<const Tet> local, const detail::TetPair& pair) {
  const Tet &A = local[pair.first], &B = local[pair.second];
  Pair p{{}, {pair.first, pair.second}};
  const std::array<std::size_t, 3> places{0, 2, 3};
  std::size_t common = 0;
  for (const std::uint32_t v : A) {
    if (holds(B, v)) {
      p.vertex[places[common++]] = v;
    } else {
      p.vertex[1] = v;
    }
  }
  for (const std::uint32_t v : B) {
    if (!holds(A, v)) p.vertex[4] = v;
  }
  return p;
}

/// Shape gradient of the local vertex in an element.
Vec3d shape_gradient(const ElementRest& rest, const Tet& local, std::uint32_t vertex) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (local[a + 1] == vertex) return rest.s[a];
  }
  return -(rest.s[0] + rest.s[1] + rest.s[2]);
}

/// Writes one tet of a pair into its lane.
void write_tet(PairBatches& out, std::size_t batch, std::size_t which, std::size_t lane, std::size_t lanes,
               const ElementRest& rest, const Tet& local, const std::array<std::uint32_t, 3>& vertices) {
  float* to = out.rest.data() + (batch * 2 + which) * kTetRest * lanes + lane;
  for (std::size_t a = 0; a < 3; ++a) {
    const Vec3d s = shape_gradient(rest, local, vertices[a]);
    for (std::size_t i = 0; i < 3; ++i) to[(3 * a + i) * lanes] = static_cast<float>(s[i]);
  }
  to[9 * lanes] = -static_cast<float>(rest.volume);
}

}  // namespace

PairBatches make_pair_batches(const Body& body, std::span<const std::uint32_t> elements, std::span<const Tet> local,
                              std::size_t lanes) {
  const std::vector<detail::TetPair> pairs = detail::pair_tets(local);
  PairBatches out;
  out.count = (pairs.size() + lanes - 1) / lanes;
  out.index.assign(out.count * kPairVertices * lanes, 0);
  out.rest.assign(out.count * 2 * kTetRest * lanes, 0.0F);
  out.element.assign(out.count * 2 * lanes, kNoElement);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const std::size_t batch = k % out.count, lane = k / out.count;  // lanes of a batch are far apart
    const Pair p = pairs[k].second == detail::kNoTet ? alone(local, pairs[k].first) : joined(local, pairs[k]);
    for (std::size_t a = 0; a < kPairVertices; ++a) {
      out.index[(batch * kPairVertices + a) * lanes + lane] = static_cast<std::uint16_t>(kIndexScale * p.vertex[a]);
    }
    for (std::size_t which = 0; which < 2; ++which) {
      const std::uint32_t t = p.tet[which];
      if (t == detail::kNoTet) continue;
      out.element[(batch * 2 + which) * lanes + lane] = elements[t];
      const std::array<std::uint32_t, 3> vertices{p.vertex[which == 0 ? 1 : 4], p.vertex[2], p.vertex[3]};
      write_tet(out, batch, which, lane, lanes, body.rest[elements[t]], local[t], vertices);
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

bool clear_element(PairBatches& pairs, std::uint32_t element, std::size_t lanes) {
  const std::size_t place = find_number(pairs.element, element);
  if (place == pairs.element.size()) return false;
  float* rest = pairs.rest.data() + place / lanes * kTetRest * lanes + place % lanes;
  for (std::size_t k = 0; k < kTetRest; ++k) rest[k * lanes] = 0.0F;
  pairs.element[place] = kNoElement;
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
