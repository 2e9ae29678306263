#include "mesh/partition/tet_fans.h"

#include <algorithm>
#include <tuple>

#include "mesh/topology/face_neighbours.h"

namespace glisson::detail {
namespace {

/// The tets around an edge in order: a part of FanSearch::around_.
struct Ring {
  std::uint32_t begin = 0, size = 0;
  bool closed = false;

  /// How many places a fan may begin at.
  std::uint32_t starts() const { return size < kFanTets ? 0 : closed ? (size == kFanTets ? 1 : size) : size - 5; }
  std::uint32_t place(std::uint32_t at) const { return begin + (at >= size ? at - size : at); }
};

struct EdgeOfTet {
  std::uint32_t p, q, tet;  // p < q
};

std::vector<EdgeOfTet> sorted_edges(std::span<const Tet> tets) {
  std::vector<EdgeOfTet> edges;
  edges.reserve(6 * tets.size());
  for (std::uint32_t t = 0; t < tets.size(); ++t) {
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) {
        const auto [p, q] = std::minmax(tets[t][a], tets[t][b]);
        edges.push_back({p, q, t});
      }
    }
  }
  std::sort(edges.begin(), edges.end(), [](const EdgeOfTet& a, const EdgeOfTet& b) {
    return std::tie(a.p, a.q, a.tet) < std::tie(b.p, b.q, b.tet);
  });
  return edges;
}

class FanSearch {
 public:
  explicit FanSearch(std::span<const Tet> tets)
      : tets_(tets), neighbours_(face_neighbours(tets)), free_neighbours_(tets.size()), taken_(tets.size(), 0),
        placed_(tets.size(), 0), places_(tets.size(), {kNoTet, kNoTet, kNoTet, kNoTet, kNoTet, kNoTet}) {
    for (std::size_t t = 0; t < tets.size(); ++t) {
      free_neighbours_[t] =
          static_cast<std::uint8_t>(4 - std::count(neighbours_[t].begin(), neighbours_[t].end(), kNoTet));
    }
    const std::vector<EdgeOfTet> edges = sorted_edges(tets);
    for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
      while (end < edges.size() && edges[end].p == edges[i].p && edges[end].q == edges[i].q) ++end;
      if (end - i >= kFanTets) find_rings(std::span(edges).subspan(i, end - i));
    }
  }

  std::vector<TetFan> take_all() {
    for (std::uint32_t place = static_cast<std::uint32_t>(around_.size()); place-- > 0;) {
      const Ring& ring = rings_[ring_of_[place]];
      if (place - ring.begin < ring.starts()) put_in_line(place);
    }
    for (std::size_t outside = 0; outside < waiting_.size();) {
      if (waiting_[outside].empty()) {
        ++outside;
        continue;
      }
      const std::uint32_t place = waiting_[outside].back();
      waiting_[outside].pop_back();
      if (looseness(place) != outside) continue;  // taken, or an entry that is out of date
      take(place);
      outside = 0;
    }
    std::sort(fans_.begin(), fans_.end(), [](const TetFan& a, const TetFan& b) {
      return std::make_tuple(!a.closed, *std::min_element(a.tets.begin(), a.tets.end())) <
             std::make_tuple(!b.closed, *std::min_element(b.tets.begin(), b.tets.end()));
    });
    return std::move(fans_);
  }

 private:
  static constexpr std::size_t kMostOutside = 2 * (4 * kFanTets - 10) + 3;

  /// Two tets beside `t` hold the edge: across the faces opposite its other two corners.
  std::array<std::uint32_t, 2> beside(std::uint32_t t, const EdgeOfTet& edge) const {
    std::array<std::uint32_t, 2> found{kNoTet, kNoTet};
    std::size_t n = 0;
    for (std::size_t a = 0; a < 4; ++a) {
      if (tets_[t][a] != edge.p && tets_[t][a] != edge.q) found[n++] = neighbours_[t][a];
    }
    return found;
  }

  /// Rings begin at an end where there is one, else at the smallest tet.
  void find_rings(std::span<const EdgeOfTet> edges) {
    for (const EdgeOfTet& e : edges) placed_[e.tet] = 0;
    for (const EdgeOfTet& e : edges) {
      const auto [a, b] = beside(e.tet, e);
      if (placed_[e.tet] == 0 && (a == kNoTet || b == kNoTet)) walk(e, a == kNoTet ? b : a, false);
    }
    for (const EdgeOfTet& e : edges) {
      if (placed_[e.tet] == 0) walk(e, beside(e.tet, e)[0], true);
    }
  }

  void walk(const EdgeOfTet& edge, std::uint32_t next, bool closed) {
    Ring ring{static_cast<std::uint32_t>(around_.size()), 0, closed};
    std::uint32_t before = kNoTet;
    for (std::uint32_t t = edge.tet; t != kNoTet && placed_[t] == 0;) {
      placed_[t] = 1;
      add_place(t);
      const auto [a, b] = beside(t, edge);
      const std::uint32_t on = before == kNoTet ? next : (a == before ? b : a);
      before = t;
      t = on;
    }
    ring.size = static_cast<std::uint32_t>(around_.size()) - ring.begin;
    rings_.push_back(ring);
  }

  void add_place(std::uint32_t t) {
    *std::find(places_[t].begin(), places_[t].end(), kNoTet) = static_cast<std::uint32_t>(around_.size());
    around_.push_back(t);
    ring_of_.push_back(static_cast<std::uint32_t>(rings_.size()));
  }

  TetFan fan_at(std::uint32_t place) const {
    const Ring& ring = rings_[ring_of_[place]];
    TetFan fan{{}, ring.closed && ring.size == kFanTets};
    for (std::uint32_t k = 0; k < kFanTets; ++k) fan.tets[k] = around_[ring.place(place - ring.begin + k)];
    return fan;
  }

  /// Twice the free tets beside a fan, and one where it is open; kMostOutside where a tet of it is taken.
  std::size_t looseness(std::uint32_t place) const {
    const TetFan fan = fan_at(place);
    std::size_t sides = 0;
    for (const std::uint32_t t : fan.tets) {
      if (taken_[t] != 0) return kMostOutside;
      sides += free_neighbours_[t];
    }
    return fan.closed ? 2 * (sides - 12) : 2 * (sides - 10) + 1;
  }

  void put_in_line(std::uint32_t place) {
    const std::size_t outside = looseness(place);
    if (outside < kMostOutside) waiting_[outside].push_back(place);
  }

  void take(std::uint32_t place) {
    const TetFan fan = fan_at(place);
    fans_.push_back(fan);
    for (const std::uint32_t t : fan.tets) taken_[t] = 1;
    for (const std::uint32_t t : fan.tets) {
      for (const std::uint32_t n : neighbours_[t]) {
        if (n == kNoTet || taken_[n] != 0) continue;
        --free_neighbours_[n];
        for (const std::uint32_t at : places_[n]) {
          if (at != kNoTet) put_fans_over(at);
        }
      }
    }
  }

  /// The fans of a ring that hold the tet at this place.
  void put_fans_over(std::uint32_t place) {
    const Ring& ring = rings_[ring_of_[place]];
    const std::uint32_t at = place - ring.begin, starts = ring.starts();
    if (starts == 1) return put_in_line(ring.begin);
    for (std::uint32_t back = 0; back < kFanTets; ++back) {
      if (at < back && !ring.closed) return;
      const std::uint32_t start = at < back ? at + ring.size - back : at - back;
      if (start < starts) put_in_line(ring.begin + start);
    }
  }

  std::span<const Tet> tets_;
  std::vector<Neighbours> neighbours_;
  std::vector<std::uint8_t> free_neighbours_;
  std::vector<char> taken_, placed_;
  std::vector<Ring> rings_;
  std::vector<std::uint32_t> around_, ring_of_;       // tet and ring of each place
  std::vector<std::array<std::uint32_t, 6>> places_;  // of each tet
  std::array<std::vector<std::uint32_t>, kMostOutside> waiting_;
  std::vector<TetFan> fans_;
};

}  // namespace

std::vector<TetFan> fan_tets(std::span<const Tet> tets) { return FanSearch(tets).take_all(); }

}  // namespace glisson::detail
