// contract.cpp — takes a vertex out by drawing it into a neighbour.
#include "mesher/lattice/operations.h"

#include <algorithm>
#include <bit>

namespace glisson::lattice {
namespace {

/// Edges opposite a vertex in its tets that do not have `other`, each once, ascending.
void opposite_edges(const TetComplex& c, std::uint32_t vertex, std::uint32_t other,
                    std::vector<std::array<std::uint32_t, 2>>& out) {
  out.clear();
  for (const std::uint32_t t : c.stars[vertex]) {
    const Tet& tet = c.tets[t];
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) {
        if (tet[i] == vertex || tet[j] == vertex || tet[i] == other || tet[j] == other) continue;
        out.push_back({std::min(tet[i], tet[j]), std::max(tet[i], tet[j])});
      }
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
}

/// Whether only the ring of the edge is joined to both ends, by vertices and by faces: else the contraction would fold tets onto
/// each other.
bool links_meet_in_ring(const TetComplex& c, std::uint32_t u, std::uint32_t v, const EdgeRing& ring) {
  std::vector<std::uint32_t> a, b, both;
  c.neighbours(u, a);
  c.neighbours(v, b);
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  if (both.size() != ring.ring.size()) return false;
  std::vector<std::array<std::uint32_t, 2>> faces_u, faces_v, common;
  opposite_edges(c, u, v, faces_u);
  opposite_edges(c, v, u, faces_v);
  std::set_intersection(faces_u.begin(), faces_u.end(), faces_v.begin(), faces_v.end(), std::back_inserter(common));
  return common.size() == ring.tets.size();
}

/// Whether the faces of interfaces at `from` stay near their surfaces when it goes to `into`.
bool surfaces_stay(const Workspace& w, std::uint32_t from, std::uint32_t into) {
  const TetComplex& c = w.complex;
  const Mask mask = c.masks[from];
  const Vec3d &p = c.points[from], &q = c.points[into];
  for (const std::uint32_t t : c.stars[from]) {
    if (c.has(t, into)) continue;
    for (std::size_t i = 0; i < 4; ++i) {
      const Tet& tet = c.tets[t];
      if (tet[i] == from) continue;
      const std::uint32_t other = c.across(t, i);
      if (other != ~0u && c.labels[other] >= c.labels[t]) continue;  // inside a region, or seen from the other side
      std::uint32_t rest[2];
      std::size_t n = 0;
      for (std::size_t j = 0; j < 4; ++j) {
        if (j != i && tet[j] != from) rest[n++] = tet[j];
      }
      const Vec3d &a = c.points[rest[0]], &b = c.points[rest[1]];
      const Vec3d before = cross(a - p, b - p), after = cross(a - q, b - q);
      if (dot(before, after) < 0.7 * norm(before) * norm(after)) return false;
      const Mask common = mask & c.masks[rest[0]] & c.masks[rest[1]];
      const double off = w.fields.off((a + b + q) * (1.0 / 3.0), surfaces_of(common));
      if (off > kFlipSlack * w.edge(into) && off > w.fields.off((a + b + p) * (1.0 / 3.0), surfaces_of(common)))
        return false;
    }
  }
  return true;
}

}  // namespace

bool contract_edge(Workspace& w, std::uint32_t from, std::uint32_t into, double floor) {
  TetComplex& c = w.complex;
  const Mask mask = c.masks[from];
  if ((mask & ~c.masks[into]) != 0) return false;
  const EdgeRing ring = c.edge_ring(from, into);
  if (!ring.simple) return false;
  if (mask & kCorner) return false;
  const bool on_surface = std::popcount(mask & ~kMarks) > 1;
  if (on_surface) {
    // The edge itself must lie in all of the interfaces of `from`.
    Mask at_edge = c.labels_at_edge(from, into);
    if (!ring.closed) at_edge |= mask & c.masks[into] & ~c.labels_at(from);
    if ((at_edge & ~kMarks) != (mask & ~kMarks)) return false;
  }
  for (const std::uint32_t t : c.stars[from]) {
    if (c.has(t, into)) continue;
    Tet moved = c.tets[t];
    *std::find(moved.begin(), moved.end(), from) = into;
    if (w.quality(moved) <= floor) return false;
  }
  if (!links_meet_in_ring(c, from, into, ring)) return false;
  if (on_surface && !surfaces_stay(w, from, into)) return false;
  const std::vector<std::uint32_t> star = c.stars[from];
  for (const std::uint32_t t : star) {
    const Label label = c.labels[t];
    Tet moved = c.tets[t];
    const bool gone = c.has(t, into);
    c.remove_tet(t);
    if (gone) continue;
    *std::find(moved.begin(), moved.end(), from) = into;
    c.add_tet(moved, label);
  }
  return true;
}

}  // namespace glisson::lattice
