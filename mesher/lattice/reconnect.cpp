// reconnect.cpp — other tets in the place of those around an edge or at a face.
//
//          v                          v            A ring of four tets about the edge u–v: its polygon p₀ p₁ p₂ p₃ is cut
//         /|\                        / \           into two triangles, each with a tet to u and one to v. Where the ring is
//     p0 / | \ p2         p0 --------+-- p2        of two regions, the interface bends from the faces u–v–p, u–v–q to
//        \ | /                        \ /          u–p–q, v–p–q: the line p–q is in both polygons.
//          u                          u
#include "mesher/lattice/operations.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace glisson::lattice {
namespace {

constexpr std::size_t kLongestRing = 9;
constexpr double kLeastGain = 1e-4;

/// The division of a chain of ring vertices, from the first to the last, whose ends are joined.
class Division {
 public:
  Division(const Workspace& w, std::uint32_t u, std::uint32_t v, std::vector<std::uint32_t> chain)
      : w_(w), u_(u), v_(v), chain_(std::move(chain)) {
    const std::size_t n = chain_.size();
    for (std::size_t span = 2; span < n; ++span) {
      for (std::size_t i = 0; i + span < n; ++i) choose(i, i + span);
    }
  }

  double quality() const { return chain_.size() < 3 ? 1.0 : best_[0][chain_.size() - 1]; }
  void tets(std::vector<Tet>& out) const { collect(0, chain_.size() - 1, out); }

 private:
  Tet upper(std::size_t i, std::size_t k, std::size_t j) const { return {chain_[i], chain_[k], chain_[j], v_}; }
  Tet lower(std::size_t i, std::size_t k, std::size_t j) const { return {chain_[i], chain_[j], chain_[k], u_}; }

  void choose(std::size_t i, std::size_t j) {
    double best = -1e300;
    for (std::size_t k = i + 1; k < j; ++k) {
      double q = std::min(k > i + 1 ? best_[i][k] : 1.0, j > k + 1 ? best_[k][j] : 1.0);
      if (q <= best) continue;
      q = std::min(q, w_.quality(upper(i, k, j)));
      if (q <= best) continue;
      q = std::min(q, w_.quality(lower(i, k, j)));
      if (q <= best) continue;
      best = q;
      middle_[i][j] = k;
    }
    best_[i][j] = best;
  }

  void collect(std::size_t i, std::size_t j, std::vector<Tet>& out) const {
    if (j < i + 2) return;
    const std::size_t k = middle_[i][j];
    out.push_back(upper(i, k, j));
    out.push_back(lower(i, k, j));
    collect(i, k, out);
    collect(k, j, out);
  }

  const Workspace& w_;
  std::uint32_t u_, v_;
  std::vector<std::uint32_t> chain_;
  double best_[kLongestRing + 2][kLongestRing + 2];
  std::size_t middle_[kLongestRing + 2][kLongestRing + 2];
};

/// The chains of equal label that a ring is made of, at most two.
struct Chains {
  std::vector<std::uint32_t> first, second;
  Label first_label = kNone, second_label = kNone;
  bool valid = false;
};

Chains chains_of(const TetComplex& c, const EdgeRing& ring) {
  Chains out;
  const std::size_t n = ring.tets.size();
  const auto label = [&](std::size_t i) { return c.labels[ring.tets[i % n]]; };
  std::vector<std::size_t> changes;  ///< tets whose predecessor has another label
  for (std::size_t i = ring.closed ? 0 : 1; i < n; ++i) {
    if (label(i) != label(i + n - 1)) changes.push_back(i);
  }
  out.first_label = label(0);
  if (changes.empty()) {
    out.first = ring.ring;
    out.valid = true;
    return out;
  }
  if (!ring.closed || changes.size() != 2) return out;
  const std::size_t p = changes[0], q = changes[1];
  const auto part = [&](std::size_t from, std::size_t tets) {
    std::vector<std::uint32_t> chain;
    for (std::size_t i = 0; i <= tets; ++i) chain.push_back(ring.ring[(from + i) % n]);
    return chain;
  };
  out.first = part(p, q - p);
  out.second = part(q, n - (q - p));
  out.first_label = label(p);
  out.second_label = label(q);
  out.valid = out.first.size() > 2 && out.second.size() > 2;
  return out;
}

/// Whether the interface may bend from the line u–v to the line p–q.
bool may_bend(const Workspace& w, std::uint32_t u, std::uint32_t v, std::uint32_t p, std::uint32_t q) {
  const auto& m = w.complex.masks;
  const Mask common = m[u] & m[v] & m[p] & m[q] & ~kMarks;
  if (std::popcount(common) != 2) return false;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    return (w.complex.points[a] + w.complex.points[b]) * 0.5;
  };
  const Mask surface = surfaces_of(common);
  const double after = w.fields.off(middle(p, q), surface);
  return after < 0.5 * kFlipSlack * w.complex.edge_between(u, v) ||
         after <= std::max(0.0, w.fields.off(middle(u, v), surface));
}

bool joined(const TetComplex& c, std::uint32_t p, std::uint32_t q) {
  return std::any_of(c.stars[p].begin(), c.stars[p].end(), [&](std::uint32_t t) { return c.has(t, q); });
}

/// Whether a new tet of a ring has a face of three of its vertices that tets elsewhere have: where tets are turned inside out, these
/// may lie over the ring. @param tets  each with its ring vertices first
bool face_exists(const TetComplex& c, const std::vector<Tet>& tets) {
  return std::any_of(tets.begin(), tets.end(), [&](const Tet& t) {
    return std::any_of(c.stars[t[0]].begin(), c.stars[t[0]].end(),
                       [&](std::uint32_t s) { return c.has(s, t[1]) && c.has(s, t[2]); });
  });
}

}  // namespace

bool remove_edge(Workspace& w, std::uint32_t u, std::uint32_t v) {
  TetComplex& c = w.complex;
  const EdgeRing ring = c.edge_ring(u, v);
  if (!ring.simple || ring.tets.size() < 2 || ring.tets.size() > kLongestRing) return false;
  if (ring.closed && ring.tets.size() < 3) return false;
  const Chains chains = chains_of(c, ring);
  if (!chains.valid) return false;
  const bool on_interface = !ring.closed || chains.second_label != kNone;
  double before = 1.0;
  for (const std::uint32_t t : ring.tets) before = std::min(before, w.quality(t));
  const Division first(w, u, v, chains.first);
  if (first.quality() <= before + kLeastGain) return false;
  const Division second(w, u, v, chains.second_label == kNone ? std::vector<std::uint32_t>{} : chains.second);
  if (second.quality() <= before + kLeastGain) return false;
  if (on_interface) {
    const std::uint32_t p = chains.first.front(), q = chains.first.back();
    if (joined(c, p, q) || !may_bend(w, u, v, p, q)) return false;
  }
  std::vector<Tet> new_first, new_second;
  first.tets(new_first);
  if (chains.second_label != kNone) second.tets(new_second);
  if (face_exists(c, new_first) || face_exists(c, new_second)) return false;
  for (const std::uint32_t t : ring.tets) c.remove_tet(t);
  for (const Tet& t : new_first) c.add_tet(t, chains.first_label);
  for (const Tet& t : new_second) c.add_tet(t, chains.second_label);
  return true;
}

bool remove_face(Workspace& w, std::uint32_t tet, std::size_t corner) {
  TetComplex& c = w.complex;
  const std::uint32_t other = c.across(tet, corner);
  if (other == ~0u || c.labels[other] != c.labels[tet]) return false;
  const double before = std::min(w.quality(tet), w.quality(other));
  const Tet t = c.tets[tet];
  std::uint32_t far = 0;
  for (const std::uint32_t x : c.tets[other]) {
    if (!c.has(tet, x)) far = x;
  }
  if (joined(c, t[corner], far)) return false;
  std::array<Tet, 3> made;
  std::size_t n = 0;
  for (std::size_t i = 0; i < 4; ++i) {  // replaces each corner of the face by the far vertex
    if (i == corner) continue;
    made[n] = t;
    made[n][i] = far;
    if (w.quality(made[n]) <= before + kLeastGain) return false;
    ++n;
  }
  const Label label = c.labels[tet];
  c.remove_tet(tet);
  c.remove_tet(other);
  for (const Tet& m : made) c.add_tet(m, label);
  return true;
}

}  // namespace glisson::lattice
