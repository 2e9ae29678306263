// improve.cpp — the order in which operations are tried.
//
// First vertices of interfaces are spread evenly along them, then the tets below the aim are taken in the order of their
// quality, the worst first. For each: its vertices are moved; its edges and faces are taken out; an edge is contracted; a
// vertex is put on an edge; it is given to the region next to it. The last three are trials: they and the moves after them are
// taken back unless all the tets they touched end up better than the one they are for.
#include "mesher/lattice/improve.h"

#include <algorithm>
#include <array>

#include "mesher/lattice/operations.h"

namespace glisson::lattice {
namespace {

constexpr int kSpreads = 3, kPasses = 12, kLastPasses = 4;
constexpr double kLastSlack = 0.2;    ///< of the edge
constexpr double kSpreadFloor = 0.3;  ///< quality that spreading vertices leaves
constexpr double kTrialGain = 1e-3;
constexpr double kMostOff = 0.12;      ///< of the edge: the middle of an interface's edge from its surface
constexpr double kCreaseFloor = 0.15;  ///< quality that following creases for the last time leaves
constexpr double kMust = 0.2;          ///< quality from which on no trials are made; 11.5° and 163.4°

constexpr std::array<std::array<std::size_t, 2>, 6> kEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

class Improver {
 public:
  Improver(Workspace& w, double aim) : w_(w), c_(w.complex), aim_(aim) {}

  void spread() {
    for (int i = 0; i < kSpreads; ++i) {
      for (std::uint32_t v = 0; v < c_.points.size(); ++v) {
        if (surfaces_of(c_.masks[v])) centre_vertex(w_, v, kSpreadFloor);
      }
    }
  }

  /// Lets vertices go further from their surfaces where a tet is still poor. @return whether there is one
  bool let_loose() {
    loose_ = kLastSlack;
    std::fill(tried_.begin(), tried_.end(), 0);
    for (std::uint32_t t = 0; t < c_.tets.size(); ++t) {
      if (c_.alive(t) && w_.quality(t) < kGood) return true;
    }
    return false;
  }

  /// @return how many tets got better
  std::size_t pass(const std::function<bool(double)>& go_on) {
    struct Poor {
      double quality;
      std::uint32_t index;
      Tet tet;
    };
    std::vector<Poor> poor;
    for (std::uint32_t t = 0; t < c_.tets.size(); ++t) {
      if (!c_.alive(t)) continue;
      if (const double q = w_.quality(t); q < aim_) poor.push_back({q, t, c_.tets[t]});
    }
    std::sort(poor.begin(), poor.end(), [](const Poor& a, const Poor& b) {
      return a.quality != b.quality ? a.quality < b.quality : a.tet < b.tet;
    });
    tried_.resize(c_.tets.size(), 0);
    std::size_t better = 0;
    for (std::size_t i = 0; i < poor.size(); ++i) {
      const Poor& p = poor[i];
      if (i % 4096 == 0 && !go_on(static_cast<double>(i) / static_cast<double>(poor.size()))) return 0;
      if (!c_.alive(p.index) || c_.tets[p.index] != p.tet || !changed_since_tried(p.index)) continue;
      tried_[p.index] = c_.clock++;
      better += mend(p.index);
    }
    return better;
  }

  /// Puts a vertex on edges of interfaces that leave their surface by more than kMostOff, where good tets come of it.
  std::size_t refine_curved() {
    std::size_t refined = 0;
    std::vector<std::uint32_t> around;
    const std::size_t count = c_.points.size();
    for (std::uint32_t u = 0; u < count; ++u) {
      if (!surfaces_of(c_.masks[u]) || c_.stars[u].empty()) continue;
      c_.neighbours(u, around);
      for (const std::uint32_t v : around) {
        if (v < u || !surfaces_of(c_.masks[u] & c_.masks[v])) continue;
        const Mask surfaces = surfaces_of(edge_mask(u, v));
        if (!surfaces) continue;
        const double off = w_.fields.off((c_.points[u] + c_.points[v]) * 0.5, surfaces);
        if (off > kMostOff * c_.edge_between(u, v)) refined += insert_on(u, v, kMust);
      }
    }
    return refined;
  }

 private:
  /// Whether anything about a tet is other than when it was last tried without success.
  bool changed_since_tried(std::uint32_t t) const {
    const Tet& tet = c_.tets[t];
    return std::any_of(tet.begin(), tet.end(), [&](std::uint32_t v) { return c_.changed[v] >= tried_[t]; });
  }

  bool mend(std::uint32_t t) {
    const double q = w_.quality(t);
    if (q >= aim_) return false;
    const Tet tet = c_.tets[t];
    bool moved = false;
    for (const std::uint32_t v : tet) moved = smooth_vertex(w_, v) || moved;
    if (w_.quality(t) >= aim_) return true;
    for (const auto& [i, j] : kEdges) {
      if (remove_edge(w_, tet[i], tet[j])) return true;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      if (remove_face(w_, t, i)) return true;
    }
    if (w_.quality(t) >= kMust) return moved;
    return contract(tet, w_.quality(t)) || insert(tet, w_.quality(t)) || give_away(t) ||
           (w_.quality(t) < kGood && loosen(tet)) || moved;
  }

  /// Keeps what an open trial did where all tets it touched are better than `before`.
  bool settle(double before) {
    c_.touched(touched_);
    const bool good = std::all_of(touched_.begin(), touched_.end(),
                                  [&](std::uint32_t t) { return !c_.alive(t) || w_.quality(t) > before + kTrialGain; });
    good ? c_.keep() : c_.take_back();
    return good;
  }

  bool contract(const Tet& tet, double before) {
    for (const auto& [i, j] : kEdges) {
      for (const bool forth : {true, false}) {
        const std::uint32_t from = tet[forth ? i : j], into = tet[forth ? j : i];
        c_.begin();
        if (!contract_edge(w_, from, into, 0.3 * before)) {
          c_.take_back();
          continue;
        }
        smooth_around(into);
        if (settle(before)) return true;
      }
    }
    return false;
  }

  void smooth_around(std::uint32_t v) {
    smooth_vertex(w_, v);
    std::vector<std::uint32_t> poor;
    for (const std::uint32_t t : c_.stars[v]) {
      if (w_.quality(t) < aim_) poor.insert(poor.end(), c_.tets[t].begin(), c_.tets[t].end());
    }
    std::sort(poor.begin(), poor.end());
    poor.erase(std::unique(poor.begin(), poor.end()), poor.end());
    for (const std::uint32_t p : poor) {
      if (p != v) smooth_vertex(w_, p);
    }
    smooth_vertex(w_, v);
  }

  /// A new vertex on the longest edges, and the edges around it taken out where that helps.
  bool insert(const Tet& tet, double before) {
    return std::any_of(kEdges.begin(), kEdges.end(),
                       [&](const auto& edge) { return insert_on(tet[edge[0]], tet[edge[1]], before); });
  }

  bool insert_on(std::uint32_t u, std::uint32_t v, double before) {
    const Mask mask = edge_mask(u, v);
    if (mask == 0) return false;
    Vec3d at = (c_.points[u] + c_.points[v]) * 0.5;
    if (const Mask s = surfaces_of(mask)) {
      const double edge = c_.edge_between(u, v);
      if (w_.fields.project(at, s, edge) > kSlack * edge) return false;
    }
    c_.begin();
    const std::uint32_t m = c_.split_edge(u, v, at);
    c_.set_mask(m, mask);
    if (w_.star_quality(m) > 0.0) {
      reconnect_around(m);
      smooth_around(m);
    }
    return settle(before);
  }

  /// Labels that meet along an edge, with what is empty; 0 where that cannot be told.
  Mask edge_mask(std::uint32_t u, std::uint32_t v) const {
    const EdgeRing ring = c_.edge_ring(u, v);
    if (!ring.simple || (c_.masks[u] & c_.masks[v] & kCrease)) return 0;
    const Mask inside = c_.labels_at_edge(u, v);
    if (ring.closed) return inside;
    const Mask region_bits = bit(w_.fields.outside()) - 1;
    const Mask empty = c_.masks[u] & c_.masks[v] & ~kMarks & ~(region_bits & ~holes());
    return empty ? inside | empty : 0;
  }
  Mask holes() const {
    Mask m = 0;
    for (std::size_t k = 0; k < w_.fields.count(); ++k) m |= w_.fields.region(k).hole ? bit(static_cast<Label>(k)) : 0;
    return m;
  }

  void reconnect_around(std::uint32_t m) {
    for (int round = 0; round < 2; ++round) {
      const std::vector<std::uint32_t> star = c_.stars[m];
      for (const std::uint32_t t : star) {
        if (!c_.alive(t) || !c_.has(t, m) || w_.quality(t) >= aim_) continue;
        const Tet tet = c_.tets[t];
        for (const auto& [i, j] : kEdges) {
          if (tet[i] != m && tet[j] != m && remove_edge(w_, tet[i], tet[j])) break;
        }
      }
      smooth_vertex(w_, m);
    }
  }

  bool give_away(std::uint32_t t) {
    const double before = w_.quality(t);
    const Tet tet = c_.tets[t];
    c_.begin();
    if (!relabel(w_, t)) {
      c_.take_back();
      return false;
    }
    if (c_.alive(t)) {
      for (const auto& [i, j] : kEdges) {
        if (remove_edge(w_, tet[i], tet[j])) break;
      }
    }
    for (const std::uint32_t v : tet) smooth_vertex(w_, v);
    return settle(before);
  }

  bool loosen(const Tet& tet) {
    bool moved = false;
    for (const std::uint32_t v : tet) moved = smooth_vertex(w_, v, loose_) || moved;
    return moved;
  }

  Workspace& w_;
  TetComplex& c_;
  double aim_;
  double loose_ = kFlipSlack;
  std::vector<std::uint32_t> touched_;
  std::vector<std::uint32_t> tried_;  ///< of tets: the complex's clock
};

}  // namespace

bool improve(Workspace& w, double aim, const std::function<bool(double)>& go_on) {
  Improver improver(w, aim);
  improver.spread();
  bool stopped = false;
  int done = 0;
  const auto passes = [&](int count) {
    for (int i = 0; i < count && !stopped; ++i, ++done) {
      const auto part = [&](double of_pass) {
        stopped = stopped || !go_on(std::min(1.0, (done + of_pass) / (2 * kPasses)));
        return !stopped;
      };
      if (improver.pass(part) == 0) break;
    }
  };
  follow_creases(w);
  passes(kPasses);
  follow_creases(w);
  improver.refine_curved();
  follow_creases(w, kCreaseFloor);  // edges may have come to lie across a crease
  passes(kPasses);
  if (!stopped && improver.let_loose()) passes(kLastPasses);
  return !stopped;
}

}  // namespace glisson::lattice
