#include "mesh/cut/cut_snap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "mesh/topology/faces.h"

namespace glisson::detail {
namespace {

constexpr double kSharp = 0.866;     ///< cosine of the angle between faces from which an edge is sharp
constexpr double kDependent = 1e-6;  ///< what is left of a unit normal that others hold already
constexpr double kSteep = 0.3;       ///< least part of the plane's normal along which the vertex may go
constexpr double kFlattening = 0.5;  ///< of the least present over rest volume around a vertex that must be left
constexpr std::array<double, 4> kParts{1.0, 0.75, 0.5, 0.25};

double six_volume(const std::array<Vec3d, 4>& x) { return dot(x[1] - x[0], cross(x[2] - x[0], x[3] - x[0])); }

std::array<double, 4> weights_in(const std::array<Vec3d, 4>& x, const Vec3d& p) {
  const double whole = six_volume(x);
  std::array<double, 4> w;
  for (std::size_t c = 0; c < 4; ++c) {
    std::array<Vec3d, 4> part = x;
    part[c] = p;
    w[c] = six_volume(part) / whole;
  }
  return w;
}

/// Takes what lies along earlier ones off a vector; false where nothing is left of it.
bool orthogonalise(const std::vector<Vec3d>& basis, Vec3d& v) {
  const double size = norm(v);
  if (!(size > 0.0)) return false;
  v *= 1.0 / size;
  for (int pass = 0; pass < 2; ++pass) {  // twice is enough
    for (const Vec3d& b : basis) v = v - b * dot(b, v);
  }
  const double left = norm(v);
  if (left < kDependent) return false;
  v *= 1.0 / left;
  return true;
}

}  // namespace

double mean_ratio_of(const std::array<Vec3d, 4>& x) {
  const double volume = six_volume(x);
  if (!(volume > 0.0)) return 0.0;
  double squares = 0.0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) squares += dot(x[b] - x[a], x[b] - x[a]);
  }
  const double root = std::cbrt(0.5 * volume);
  return 12.0 * root * root / squares;
}

double spread_of(const std::array<Vec3d, 4>& x) {
  const double volume = six_volume(x);
  if (!(volume > 0.0)) return std::numeric_limits<double>::infinity();
  Mat3d m;  // of the faces' area vectors, −3 V s
  for (const auto& f : kFaceCorners) {
    const Vec3d a = area_vector({x[f[0]], x[f[1]], x[f[2]]});
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) m(i, j) += a[i] * a[j];
    }
  }
  // m = q I + p B with tr B = 0: the largest eigenvalue is q + 2 p cos(⅓ arccos(½ det B))
  const double q = trace(m) / 3.0;
  for (std::size_t i = 0; i < 3; ++i) m(i, i) -= q;
  double squares = 0.0;
  for (const auto& row : m.m) squares += row[0] * row[0] + row[1] * row[1] + row[2] * row[2];
  const double p = std::sqrt(squares / 6.0);
  const double half = p > 0.0 ? std::clamp(0.5 * determinant(m) / (p * p * p), -1.0, 1.0) : 0.0;
  return 4.0 * (q + 2.0 * p * std::cos(std::acos(half) / 3.0)) / (volume * volume);
}

CutSnap::State CutSnap::state(std::uint32_t vertex) const {
  const auto at = moved_.find(vertex);
  return at != moved_.end() ? at->second : State{mesh_.rest[vertex], mesh_.displacement[vertex]};
}

std::array<Vec3d, 4> CutSnap::corners(std::uint32_t tet) const {
  const Tet& t = mesh_.tets[tet];
  return {state(t[0]).rest, state(t[1]).rest, state(t[2]).rest, state(t[3]).rest};
}

/// An orthonormal basis of the directions in which a vertex must not go. A face at the vertex that only one tet has, or
/// tets of two tissues, is of the body's or a tissue's surface, unless it is one side of the crack whose rim the vertex is.
std::vector<Vec3d> CutSnap::normals(std::uint32_t vertex) const {
  struct Side {
    std::size_t tissue;
    Vec3d area;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Side>> faces;
  std::map<std::size_t, Vec3d> growth;  // of each tissue's volume by its way
  double around = 0.0;
  for (const std::uint32_t t : mesh_.stars.tets_at(vertex)) {
    const std::array<Vec3d, 4> x = corners(t);
    const Tet& tet = mesh_.tets[t];
    const std::size_t tissue = mesh_.tissue(t);
    for (std::size_t c = 0; c < 4; ++c) {
      const auto& f = kFaceCorners[c];
      const Vec3d area = area_vector({x[f[0]], x[f[1]], x[f[2]]});
      if (tet[c] == vertex) {
        growth[tissue] += area;
        around += norm(area);
        continue;
      }
      std::array<std::uint32_t, 2> others{};
      for (std::size_t i = 0, k = 0; i < 3; ++i) {
        if (tet[f[i]] != vertex) others[k++] = mesh_.root[tet[f[i]]];
      }
      faces[std::minmax(others[0], others[1])].push_back({tissue, area});
    }
  }
  std::vector<Vec3d> patches;
  for (const auto& [key, sides] : faces) {
    const bool inner = sides.size() > 1 && sides[0].tissue == sides[1].tissue;
    if (inner || sides.size() > 2) continue;
    const Vec3d area = sides.size() == 2 && sides[1].tissue < sides[0].tissue ? sides[1].area : sides[0].area;
    const auto same = std::find_if(patches.begin(), patches.end(),
                                   [&](const Vec3d& sum) { return dot(sum, area) >= kSharp * norm(sum) * norm(area); });
    if (same == patches.end()) {
      patches.push_back(area);
    } else {
      *same += area;
    }
  }
  for (const auto& [tissue, area] : growth) {
    if (norm(area) > 1e-9 * around) patches.push_back(area);
  }
  std::vector<Vec3d> basis;
  for (Vec3d n : patches) {
    if (orthogonalise(basis, n)) basis.push_back(n);
  }
  return basis;
}

/// Moves the vertex if all around it bear that.
bool CutSnap::try_at(std::uint32_t vertex, const Vec3d& to) {
  const auto star = mesh_.stars.tets_at(vertex);
  std::array<double, 4> weights{};
  std::uint32_t home = 0;
  double depth = -std::numeric_limits<double>::infinity();
  for (const std::uint32_t t : star) {
    const std::array<double, 4> w = weights_in(corners(t), to);
    const double least = *std::min_element(w.begin(), w.end());
    if (least > depth) depth = least, weights = w, home = t;
  }
  if (!mesh_.may_become(vertex, mesh_.tets[home], weights)) return false;
  State next{to, {}};
  for (std::size_t c = 0; c < 4; ++c) next.displacement += state(mesh_.tets[home][c]).displacement * weights[c];

  double least_ratio = 1.0, next_ratio = std::numeric_limits<double>::infinity();
  for (const std::uint32_t t : star) {
    const Tet& tet = mesh_.tets[t];
    std::array<Vec3d, 4> before, after, before_now, after_now;
    for (std::size_t c = 0; c < 4; ++c) {
      const State s = state(tet[c]), n = tet[c] == vertex ? next : s;
      before[c] = s.rest, before_now[c] = s.rest + s.displacement;
      after[c] = n.rest, after_now[c] = n.rest + n.displacement;
    }
    if (mean_ratio_of(after) < std::min(limits_.quality, mean_ratio_of(before))) return false;
    if (spread_of(after) > std::max(limits_.spread[mesh_.tissue(t)], spread_of(before))) return false;
    least_ratio = std::min(least_ratio, six_volume(before_now) / six_volume(before));
    next_ratio = std::min(next_ratio, six_volume(after_now) / six_volume(after));
  }
  if (next_ratio < kFlattening * least_ratio) return false;
  moved_[vertex] = next;
  moves_.push_back({vertex, to});
  return true;
}

double CutSnap::bring(std::uint32_t vertex, const Vec3d& point, const Vec3d& normal) {
  const Vec3d x = state(vertex).rest;
  const double away = dot(normal, point - x);
  if (std::abs(away) < limits_.nearest) return 0.0;
  Vec3d along = normal;
  for (const Vec3d& n : normals(vertex)) along = along - n * dot(n, along);
  const double steep = dot(along, along);
  if (steep < kSteep * kSteep) return std::abs(away);
  const Vec3d way = along * (away / steep);
  for (const double part : kParts) {
    if (try_at(vertex, x + way * part)) return std::abs(away) * (1.0 - part);
  }
  return std::abs(away);
}

}  // namespace glisson::detail
