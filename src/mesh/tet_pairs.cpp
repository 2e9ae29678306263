#include "mesh/tet_pairs.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "mesh/faces.h"

namespace glisson::detail {
namespace {

constexpr std::size_t kSearched = 1 << 14;  // tets a search may see: all of a submesh, and longer lists stay cheap

using Neighbours = std::array<std::uint32_t, 4>;  // across the face opposite each corner, or kNoTet

struct Side {
  Triangle face;  // ascending vertex numbers
  std::uint32_t tet;
  std::uint8_t corner;
};

std::vector<Side> sorted_sides(std::span<const Tet> tets) {
  std::vector<Side> sides;
  sides.reserve(4 * tets.size());
  for (std::uint32_t t = 0; t < tets.size(); ++t) {
    for (std::uint8_t corner = 0; corner < 4; ++corner) {
      const auto& c = kFaceCorners[corner];
      Triangle face{tets[t][c[0]], tets[t][c[1]], tets[t][c[2]]};
      std::sort(face.begin(), face.end());
      sides.push_back({face, t, corner});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return std::tie(a.face, a.tet) < std::tie(b.face, b.tet); });
  return sides;
}

std::vector<Neighbours> face_neighbours(std::span<const Tet> tets) {
  std::vector<Neighbours> neighbours(tets.size(), {kNoTet, kNoTet, kNoTet, kNoTet});
  const std::vector<Side> sides = sorted_sides(tets);
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const Side &a = sides[i], &b = sides[i + 1];
    if (a.face != b.face || tets[a.tet][a.corner] == tets[b.tet][b.corner]) continue;
    neighbours[a.tet][a.corner] = b.tet;
    neighbours[b.tet][b.corner] = a.tet;
    ++i;
  }
  return neighbours;
}

class Matching {
 public:
  explicit Matching(std::span<const Tet> tets)
      : neighbours_(face_neighbours(tets)), mate_(tets.size(), kNoTet), free_neighbours_(tets.size()) {}

  /// Takes the tet with the fewest free neighbours again and again, and pairs it with the loosest of them.
  void match_loose_ends() {
    for (std::uint32_t t = static_cast<std::uint32_t>(mate_.size()); t-- > 0;) {
      free_neighbours_[t] =
          static_cast<std::uint8_t>(4 - std::count(neighbours_[t].begin(), neighbours_[t].end(), kNoTet));
      waiting_[free_neighbours_[t]].push_back(t);
    }
    for (std::size_t degree = 1; degree <= 4;) {
      if (waiting_[degree].empty()) {
        ++degree;
        continue;
      }
      const std::uint32_t t = waiting_[degree].back();
      waiting_[degree].pop_back();
      if (mate_[t] != kNoTet || free_neighbours_[t] != degree) continue;  // an entry that is out of date
      pair(t, loosest_neighbour(t));
      degree = 1;
    }
  }

  /// Joins tets left single in twos: single–a═b–c═d–single becomes single═a–b═c–d═single.
  void match_along_paths() {
    from_.assign(mate_.size(), kNoTet);
    for (std::uint32_t t = 0; t < mate_.size(); ++t) {
      if (mate_[t] == kNoTet) search_path(t);
    }
  }

  std::vector<TetPair> pairs() const {
    std::vector<TetPair> result;
    result.reserve(mate_.size() / 2 + 1);
    for (std::uint32_t t = 0; t < mate_.size(); ++t) {
      if (mate_[t] == kNoTet || mate_[t] > t) result.push_back({t, mate_[t]});
    }
    return result;
  }

 private:
  bool is_free(std::uint32_t t) const { return t != kNoTet && mate_[t] == kNoTet; }

  std::uint32_t loosest_neighbour(std::uint32_t t) const {
    std::uint32_t best = kNoTet;
    for (const std::uint32_t n : neighbours_[t]) {
      if (is_free(n) && (best == kNoTet || free_neighbours_[n] < free_neighbours_[best])) best = n;
    }
    return best;
  }

  void pair(std::uint32_t a, std::uint32_t b) {
    mate_[a] = b;
    mate_[b] = a;
    for (const std::uint32_t t : {a, b}) {
      for (const std::uint32_t n : neighbours_[t]) {
        if (is_free(n)) waiting_[--free_neighbours_[n]].push_back(n);
      }
    }
  }

  /// Breadth first from a single tet over (free edge, pair) steps. reached_ holds the tets at an even distance;
  /// from_[x] is the one before an odd x, and marks both x and its mate as seen.
  void search_path(std::uint32_t start) {
    reached_.assign(1, start);
    from_[start] = start;
    std::uint32_t end = kNoTet;
    for (std::size_t i = 0; i < reached_.size() && i < kSearched && end == kNoTet; ++i) {
      for (const std::uint32_t n : neighbours_[reached_[i]]) {
        if (n == kNoTet || from_[n] != kNoTet) continue;
        from_[n] = reached_[i];
        if (mate_[n] == kNoTet) {
          end = n;
          break;
        }
        from_[mate_[n]] = n;
        reached_.push_back(mate_[n]);
      }
    }
    const std::uint32_t found = end;
    while (end != kNoTet) end = turn_back(end, start);
    forget(found);
  }

  /// Pairs x with the tet before it; returns that tet's former mate, where the next pair is made.
  std::uint32_t turn_back(std::uint32_t x, std::uint32_t start) {
    const std::uint32_t before = from_[x], freed = mate_[before];
    mate_[x] = before;
    mate_[before] = x;
    return before == start ? kNoTet : freed;
  }

  void forget(std::uint32_t end) {
    if (end != kNoTet) from_[end] = kNoTet;
    for (const std::uint32_t t : reached_) {
      if (from_[t] != t) from_[from_[t]] = kNoTet;
      from_[t] = kNoTet;
    }
  }

  std::vector<Neighbours> neighbours_;
  std::vector<std::uint32_t> mate_;
  std::vector<std::uint8_t> free_neighbours_;
  std::array<std::vector<std::uint32_t>, 5> waiting_;  // by free neighbours; entries may be out of date
  std::vector<std::uint32_t> from_, reached_;
};

}  // namespace

std::vector<TetPair> pair_tets(std::span<const Tet> tets) {
  Matching matching(tets);
  matching.match_loose_ends();
  matching.match_along_paths();
  return matching.pairs();
}

}  // namespace glisson::detail
