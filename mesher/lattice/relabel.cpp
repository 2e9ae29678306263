// relabel.cpp — gives a thin tet at an interface to the region, or the void, on the other side.
#include "mesher/lattice/operations.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace glisson::lattice {
namespace {

/// Whether a vertex has a face that only one tet has.
bool on_boundary(const TetComplex& c, std::uint32_t v) {
  for (const std::uint32_t t : c.stars[v]) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (c.tets[t][i] != v && c.across(t, i) == ~0u) return true;
    }
  }
  return false;
}

}  // namespace

bool relabel(Workspace& w, std::uint32_t t) {
  TetComplex& c = w.complex;
  const Label own = c.labels[t];
  const Tet tet = c.tets[t];
  std::array<Label, 4> across{};
  std::size_t same = 0;
  Label other_label = kNone;
  std::size_t other_faces = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t other = c.across(t, i);
    across[i] = other == ~0u ? w.fields.outside() : c.labels[other];
    same += across[i] == own;
    if (across[i] == own) continue;
    if (other_label == kNone) other_label = across[i];
    if (across[i] != other_label) return false;
    ++other_faces;
  }
  if (other_faces < 2 || same == 0) return false;
  // With three faces on the interface its tip goes; the face that is left must be the interface within the slack.
  const Mask common = c.masks[tet[0]] & c.masks[tet[1]] & c.masks[tet[2]] & c.masks[tet[3]] & ~kMarks;
  const Mask all = (c.masks[tet[0]] | c.masks[tet[1]] | c.masks[tet[2]] | c.masks[tet[3]]) & ~kMarks;
  const bool empty = other_label == w.fields.outside();
  if (other_faces == 2 && std::popcount(common) < 2) return false;
  for (std::size_t i = 0; i < 4; ++i) {
    if (across[i] != own) continue;  // becomes part of the interface
    Vec3d middle{};
    Mask face = all;
    for (std::size_t j = 0; j < 4; ++j) {
      if (j == i) continue;
      middle += c.points[tet[j]] * (1.0 / 3.0);
      face &= c.masks[tet[j]];
    }
    if (std::popcount(face) < 2 || w.fields.off(middle, surfaces_of(face)) > kFlipSlack * c.edge_in(tet)) return false;
  }
  Mask hollow = bit(w.fields.outside());
  for (std::size_t k = 0; k < w.fields.count(); ++k) hollow |= w.fields.region(k).hole ? bit(static_cast<Label>(k)) : 0;
  c.remove_tet(t);
  if (!empty) c.add_tet(tet, other_label);
  for (const std::uint32_t v : tet) {
    if (c.stars[v].empty()) continue;
    Mask mask = c.labels_at(v);
    if (on_boundary(c, v)) mask |= (c.masks[v] & hollow) ? c.masks[v] & hollow : all & hollow;
    c.set_mask(v, std::popcount(mask) > 1 ? mask | (c.masks[v] & kMarks) : mask);
  }
  return true;
}

}  // namespace glisson::lattice
