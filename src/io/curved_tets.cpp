// curved_tets.cpp — see curved_tets.h.
#include "io/curved_tets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "base/text.h"

namespace glisson::detail {
namespace {

constexpr double kRounding = 1e-12;  // of the volume: straight edges lose nothing
constexpr std::array<std::array<std::size_t, 2>, 6> kEdges{{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

/// det ∂x/∂ξ at barycentric coordinates, of N_i = L_i (2 L_i − 1) and N_ij = 4 L_i L_j.
double jacobian(const std::vector<Vec3d>& x, const CurvedTet& tet, const std::array<double, 4>& at) {
  // Along ξ_k, L_k+1 grows by 1 and L_0 falls.
  std::array<Vec3d, 3> along{};
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<double, 4> slope{-1.0, 0.0, 0.0, 0.0};
    slope[k + 1] = 1.0;
    for (std::size_t i = 0; i < 4; ++i) along[k] += x[tet.corners[i]] * ((4.0 * at[i] - 1.0) * slope[i]);
    for (std::size_t e = 0; e < 6; ++e) {
      const auto [i, j] = kEdges[e];
      along[k] += x[tet.middles[e]] * (4.0 * (at[i] * slope[j] + at[j] * slope[i]));
    }
  }
  return dot(along[0], cross(along[1], along[2]));
}

double curved_volume(const std::vector<Vec3d>& x, const CurvedTet& tet) {
  double sum = -0.8 * jacobian(x, tet, {0.25, 0.25, 0.25, 0.25});
  for (std::size_t i = 0; i < 4; ++i) {
    std::array<double, 4> at{1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0};
    at[i] = 0.5;
    sum += 0.45 * jacobian(x, tet, at);
  }
  return sum / 6.0;
}

double straight_volume(const std::vector<Vec3d>& x, const Tet& t) {
  return dot(x[t[1]] - x[t[0]], cross(x[t[2]] - x[t[0]], x[t[3]] - x[t[0]])) / 6.0;
}

/// Leaves out the middles that are no corners of tets, and renumbers what refers to vertices. @return how many
std::size_t drop_middles(RawMesh& raw) {
  TetMesh& mesh = raw.mesh;
  std::vector<char> dropped(mesh.vertices.size(), 0);
  for (const CurvedTet& tet : raw.curved) {
    for (const std::uint32_t v : tet.middles) dropped[v] = 1;
  }
  for (const Tet& t : mesh.tets) {
    for (const std::uint32_t v : t) dropped[v] = 0;
  }
  std::vector<std::uint32_t> place(mesh.vertices.size());
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < place.size(); ++v) {
    place[v] = kept;
    if (dropped[v] == 0) mesh.vertices[kept++] = mesh.vertices[v];
  }
  const std::size_t gone = mesh.vertices.size() - kept;
  mesh.vertices.resize(kept);
  for (Tet& t : mesh.tets) {
    for (std::uint32_t& v : t) v = place[v];
  }
  for (auto& [name, set] : mesh.vertex_sets) {
    std::erase_if(set, [&](std::uint32_t v) { return v < dropped.size() && dropped[v] != 0; });
    for (std::uint32_t& v : set) v = v < place.size() ? place[v] : v;
  }
  return gone;
}

}  // namespace

void take_corners(RawMesh& raw) {
  if (raw.curved.empty()) return;
  const std::vector<Vec3d>& x = raw.mesh.vertices;
  std::set<Tet> seen;  // a file may hold an element once for each of its groups
  double straight = 0.0, lost = 0.0;
  for (const Tet& t : raw.mesh.tets) straight += std::abs(straight_volume(x, t));
  for (const CurvedTet& tet : raw.curved) {
    if (!seen.insert(tet.corners).second) continue;
    const double own = straight_volume(x, tet.corners), curved = curved_volume(x, tet);
    lost += own < 0.0 ? own - curved : curved - own;
  }
  if (std::abs(lost) < kRounding * straight) lost = 0.0;
  const std::size_t tets = seen.size(), middles = drop_middles(raw);
  const double share = 100.0 * lost / (straight + lost);
  raw.notes.push_back(count_text(tets, "tet", "tets") + " of 10 nodes " + (tets == 1 ? "was" : "were") +
                      " taken by the corners: straight edges " + (lost < 0.0 ? "add " : "lose ") +
                      number_text(1e6 * std::abs(lost), 3) + " ml of the body's " +
                      number_text(1e6 * (straight + lost), 4) + " ml (" + number_text(std::abs(share), 2) + " %); " +
                      count_text(middles, "middle node", "middle nodes") + " left out.");
}

}  // namespace glisson::detail
