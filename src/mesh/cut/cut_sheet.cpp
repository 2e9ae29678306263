#include "mesh/cut/cut_sheet.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "mesh/topology/faces.h"

namespace glisson::detail {
namespace {

constexpr double kSameCut = 0.25;  ///< of an edge: a crossing nearer than that to one of an earlier cut is at its place
constexpr std::size_t kCrumb =
    4;  ///< tets gone through that hang together without any other are no piece, up to so many
constexpr std::size_t kAllCorners = 15;  ///< of a tet, a bit each

/// The corners connected with corner 0 by edges that are not crossed, as bits; 0 unless the others are connected, too.
constexpr std::uint8_t group_of(unsigned crossed) {
  const auto reach = [&](unsigned from) {
    for (int pass = 0; pass < 3; ++pass) {
      for (std::size_t k = 0; k < 6; ++k) {
        const unsigned ends = 1U << kEdgeCorners[k][0] | 1U << kEdgeCorners[k][1];
        if ((crossed >> k & 1U) == 0 && (from & ends) != 0) from |= ends;
      }
    }
    return from;
  };
  const unsigned one = reach(1);
  if (one == 15) return 0;
  unsigned first = 1;
  while ((one & first) != 0) first <<= 1;
  return (one | reach(first)) == 15 ? static_cast<std::uint8_t>(one) : std::uint8_t{0};
}

constexpr std::array<std::uint8_t, 64> make_groups() {
  std::array<std::uint8_t, 64> groups{};
  for (unsigned crossed = 0; crossed < 64; ++crossed) groups[crossed] = group_of(crossed);
  return groups;
}
constexpr std::array<std::uint8_t, 64> kGroups = make_groups();

unsigned crossed_edges(const CutTet& cut) {
  unsigned crossed = 0;
  for (std::size_t k = 0; k < 6; ++k) crossed |= cut.crossed(k) ? 1U << k : 0U;
  return crossed;
}

unsigned corner_bit(const Tet& tet, std::uint32_t vertex) {
  return 1U << static_cast<unsigned>(std::find(tet.begin(), tet.end(), vertex) - tet.begin());
}

std::vector<std::uint32_t> tets_around(std::span<const Tet> tets, const VertexStars& stars, const EdgeCrossing& c) {
  std::vector<std::uint32_t> around;
  for (const std::uint32_t t : stars.tets_at(c.low)) {
    if (holds(tets[t], c.high)) around.push_back(t);
  }
  return around;
}

/// The local edge of a tet, and whether it runs from high to low.
struct LocalEdge {
  std::size_t edge;
  bool turned;
};
LocalEdge local_edge(const Tet& tet, const EdgeCrossing& c) {
  for (std::size_t k = 0; k < 6; ++k) {
    const std::uint32_t a = tet[kEdgeCorners[k][0]], b = tet[kEdgeCorners[k][1]];
    if (a == c.low && b == c.high) return {k, false};
    if (a == c.high && b == c.low) return {k, true};
  }
  return {6, false};
}

Triangle face_of(const Tet& tet, std::size_t corner) {
  const auto& f = kFaceCorners[corner];
  return {tet[f[0]], tet[f[1]], tet[f[2]]};
}

constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

std::uint32_t neighbour(std::span<const Tet> tets, const VertexStars& stars, std::uint32_t tet, const Triangle& face) {
  for (const std::uint32_t t : stars.tets_at(face[0])) {
    if (t != tet && holds(tets[t], face[1]) && holds(tets[t], face[2])) return t;
  }
  return kNobody;
}

/// Which vertices of a face, a bit each, a tet stays with.
unsigned stays_at(const Tet& tet, const CutTet& cut, const Triangle& face) {
  unsigned stays = 0;
  for (unsigned i = 0; i < 3; ++i) stays |= (corner_bit(tet, face[i]) & cut.stays) != 0 ? 1U << i : 0U;
  return stays;
}

}  // namespace

CutTet& CutSheet::record(std::uint32_t tet) {
  if (place_of_[tet] == kNone) {
    place_of_[tet] = static_cast<std::uint32_t>(cut_.size());
    cut_.emplace_back();
    cut_.back().tet = tet;
  }
  return cut_[place_of_[tet]];
}

/// Whether two tets part at the face between them.
bool CutSheet::parts(const Mesh& mesh, std::uint32_t tet, std::uint32_t other, const Triangle& face) const {
  constexpr unsigned kAll = 7;
  const CutTet *one = find(tet), *two = find(other);
  const bool one_through = one != nullptr && one->through, two_through = two != nullptr && two->through;
  const unsigned a = one_through ? stays_at(mesh.tets[tet], *one, face) : kAll;
  const unsigned b = two_through ? stays_at(mesh.tets[other], *two, face) : kAll;
  if (one_through && two_through && a != 0 && a != kAll && b != 0 && b != kAll) return a != b;
  return a == 0 || b == 0;
}

/// Whether a tet hangs together with one that is not gone through, or with enough others to be a piece of its own.
bool CutSheet::hangs_on(const Mesh& mesh, std::uint32_t tet) const {
  std::array<std::uint32_t, kCrumb + 1> piece{tet};
  std::size_t size = 1;
  bool alone = true;  // no neighbours at all
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      const Triangle face = face_of(mesh.tets[piece[i]], c);
      const std::uint32_t other = neighbour(mesh.tets, mesh.stars, piece[i], face);
      if (other == kNobody) continue;
      alone = false;
      if (parts(mesh, piece[i], other, face)) continue;
      const CutTet* cut = find(other);
      if (cut == nullptr || !cut->through) return true;
      const auto end = piece.begin() + static_cast<std::ptrdiff_t>(size);
      if (std::find(piece.begin(), end, other) != end) continue;
      piece[size++] = other;
      if (size > kCrumb) return true;
    }
  }
  return alone;
}

/// The same of the tet and of all its neighbours.
bool CutSheet::all_hang_on(const Mesh& mesh, std::uint32_t tet) const {
  if (!hangs_on(mesh, tet)) return false;
  for (std::size_t c = 0; c < 4; ++c) {
    const Triangle face = face_of(mesh.tets[tet], c);
    const std::uint32_t other = neighbour(mesh.tets, mesh.stars, tet, face);
    if (other != kNobody && parts(mesh, tet, other, face) && !hangs_on(mesh, other)) return false;
  }
  return true;
}

void CutSheet::put_on_cut(const Tet& tet, std::uint8_t corners) {
  for (unsigned c = 0; c < 4; ++c) {
    if ((corners >> c & 1U) != 0) on_cut_[tet[c]] = 1;
  }
}

/// Puts one end of each crossed edge between the two groups on the cut, the nearest first.
/// @return the group to stay with: the one that is not on the cut, or less near to it
std::uint8_t CutSheet::cover(const Tet& tet, const CutTet& cut, std::uint8_t one) {
  struct Near {
    double distance;
    std::uint8_t corner, other;
  };
  std::vector<Near> ends;
  std::array<double, 2> far{};  // of the two groups: sum of distances to the cut, in edges
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [a, b] = kEdgeCorners[k];
    if (!cut.crossed(k) || (one >> a & 1U) == (one >> b & 1U)) continue;
    ends.push_back(cut.at[k] <= 0.5 ? Near{cut.at[k], a, b} : Near{1.0 - cut.at[k], b, a});
    far[(one >> a & 1U)] += cut.at[k], far[(one >> b & 1U)] += 1.0 - cut.at[k];
  }
  std::stable_sort(ends.begin(), ends.end(), [](const Near& a, const Near& b) { return a.distance < b.distance; });
  for (const Near& e : ends) {
    if (on_cut_[tet[e.corner]] == 0 && on_cut_[tet[e.other]] == 0) on_cut_[tet[e.corner]] = 1;
  }
  std::uint8_t marked = 0;
  for (unsigned c = 0; c < 4; ++c)
    marked |= on_cut_[tet[c]] != 0 ? static_cast<std::uint8_t>(1U << c) : std::uint8_t{0};
  const auto two = static_cast<std::uint8_t>(15U ^ one);
  const bool one_on = (one & ~marked) == 0, two_on = (two & ~marked) == 0;
  if (one_on != two_on) return one_on ? two : one;
  return far[1] >= far[0] ? one : two;
}

/// A tet has been gone through: chooses where it stays, and lists the faces that part by it.
void CutSheet::settle(const Mesh& mesh, std::uint32_t tet, CutFaces& out) {
  CutTet& cut = record(tet);
  cut.through = true;
  const std::uint8_t one = kGroups[crossed_edges(cut)], before = stayed_before(cut, one);
  cut.stays = before != 0 ? before : cover(mesh.tets[tet], cut, one);
  if (before != 0) {
    put_on_cut(mesh.tets[tet], static_cast<std::uint8_t>(15U ^ before));
  } else if (!all_hang_on(mesh, tet)) {
    const auto turned = [&] { cut.stays = static_cast<std::uint8_t>(15U ^ cut.stays); };
    turned();
    if (!all_hang_on(mesh, tet)) turned();
    put_on_cut(mesh.tets[tet], static_cast<std::uint8_t>(15U ^ cut.stays));
  }
  out.through.push_back(tet);
  for (std::size_t c = 0; c < 4; ++c) {
    const Triangle face = face_of(mesh.tets[tet], c);
    const std::uint32_t other = neighbour(mesh.tets, mesh.stars, tet, face);
    if (other != kNobody && parts(mesh, tet, other, face)) out.faces.push_back(face);
  }
}

/// What is known of a tet from the cuts before; none where they did not reach it.
const CutTet* CutSheet::earlier(std::uint32_t tet) const {
  const auto at = std::lower_bound(before_.begin(), before_.end(), tet,
                                   [](const CutTet& cut, std::uint32_t t) { return cut.tet < t; });
  return at != before_.end() && at->tet == tet ? &*at : nullptr;
}

/// The group a tet stayed with when an earlier cut went through it at the same places; 0 where none did.
std::uint8_t CutSheet::stayed_before(const CutTet& cut, std::uint8_t one) const {
  const CutTet* was = earlier(cut.tet);
  if (was == nullptr || !was->through || (was->stays != one && was->stays != (15U ^ one))) return 0;
  for (std::size_t k = 0; k < 6; ++k) {
    if (cut.crossed(k) && was->crossed(k) && std::abs(cut.at[k] - was->at[k]) >= kSameCut) return 0;
  }
  return was->stays;
}

double CutSheet::as_before(std::span<const std::uint32_t> around, const Mesh& mesh, const EdgeCrossing& c) const {
  for (const std::uint32_t t : around) {
    const CutTet* was = earlier(t);
    const auto [edge, turned] = local_edge(mesh.tets[t], c);
    if (was == nullptr || !was->crossed(edge)) continue;
    const double at = turned ? 1.0 - was->at[edge] : was->at[edge];
    if (std::abs(at - c.at) < kSameCut) return at;
  }
  return c.at;
}

CutFaces CutSheet::take(std::span<const Tet> tets, const VertexStars& stars, std::vector<EdgeCrossing> crossings) {
  std::sort(crossings.begin(), crossings.end(), [](const EdgeCrossing& a, const EdgeCrossing& b) {
    return std::tie(a.time, a.low, a.high) < std::tie(b.time, b.low, b.high);
  });
  const Mesh mesh{tets, stars};
  CutFaces out;
  for (const EdgeCrossing& c : crossings) {
    const std::vector<std::uint32_t> around = tets_around(tets, stars, c);
    const double at = as_before(around, mesh, c);
    for (const std::uint32_t t : around) {
      CutTet& cut = record(t);
      const auto [edge, turned] = local_edge(tets[t], c);
      if (cut.through || cut.crossed(edge)) continue;
      cut.at[edge] = turned ? 1.0 - at : at;
    }
    for (const std::uint32_t t : around) {
      if (!record(t).through && kGroups[crossed_edges(record(t))] != 0) settle(mesh, t, out);
    }
  }
  return out;
}

void CutSheet::add_copies(std::span<const std::uint32_t> origins) {
  for (const std::uint32_t origin : origins) on_cut_.push_back(char(on_cut_[origin]));
}

void CutSheet::begin_another() {
  for (const CutTet& cut : cut_) place_of_[cut.tet] = kNone;
  before_.insert(before_.end(), cut_.begin(), cut_.end());
  std::stable_sort(before_.begin(), before_.end(), [](const CutTet& a, const CutTet& b) { return a.tet < b.tet; });
  std::size_t kept = 0;  // the last of each tet
  for (std::size_t i = 0; i < before_.size(); ++i) {
    if (i + 1 == before_.size() || before_[i + 1].tet != before_[i].tet) before_[kept++] = before_[i];
  }
  before_.resize(kept);
  cut_.clear();
  std::fill(on_cut_.begin(), on_cut_.end(), char{0});
}

void CutTet::archive(Archive& ar) {
  ar(tet, at, through, stays);
  ar.check(stays <= kAllCorners);
}

void CutSheet::archive(Archive& ar) {
  ar(cut_, before_);
  ar.same_size(on_cut_);
  if (!ar.reads()) return;
  for (const auto* list : {&cut_, &before_}) {
    for (const CutTet& cut : *list) ar.check(cut.tet < place_of_.size());
  }
  std::fill(place_of_.begin(), place_of_.end(), kNone);
  for (std::uint32_t i = 0; i < cut_.size(); ++i) place_of_[cut_[i].tet] = i;
}

}  // namespace glisson::detail
