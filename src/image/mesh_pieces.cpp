// mesh_pieces.cpp — see mesh_pieces.h.
#include "image/mesh_pieces.h"

#include <algorithm>
#include <numeric>

#include "mesh/topology/faces.h"

namespace glisson::image {
namespace {

/// A face between two tets.
struct Pair {
  std::uint32_t a, b;
  double area;
};

struct RegionPieces {
  std::vector<std::uint32_t> of;           ///< the piece of each tet: its first tet
  std::map<std::uint32_t, double> volume;  ///< of each piece [m³]
  std::vector<Pair> pairs;                 ///< faces between different regions
};

RegionPieces find_pieces(const TetMesh& mesh) {
  RegionPieces p;
  p.of.resize(mesh.tets.size());
  std::iota(p.of.begin(), p.of.end(), 0u);
  const auto root = [&](std::uint32_t t) {
    while (p.of[t] != t) t = p.of[t] = p.of[p.of[t]];
    return t;
  };
  detail::for_each_face(mesh, {}, [&](std::span<const detail::FaceSide> sides) {
    if (sides.size() != 2) return;
    const std::uint32_t a = sides[0].tet, b = sides[1].tet;
    if (mesh.regions[a] == mesh.regions[b]) {
      const std::uint32_t ra = root(a), rb = root(b);
      p.of[std::max(ra, rb)] = std::min(ra, rb);
      return;
    }
    std::array<Vec3d, 3> x{};
    for (std::size_t i = 0; i < 3; ++i) x[i] = mesh.vertices[mesh.tets[a][detail::kFaceCorners[sides[0].corner][i]]];
    p.pairs.push_back({a, b, norm(detail::area_vector(x))});
  });
  for (std::uint32_t t = 0; t < p.of.size(); ++t) {
    p.of[t] = root(t);
    p.volume[p.of[t]] += six_rest_volume(mesh, t) / 6.0;
  }
  return p;
}

/// Leaves out tets, and vertices that no other tet has.
void remove_tets(TetMesh& mesh, const std::vector<char>& going) {
  std::vector<std::uint32_t> number(mesh.vertices.size(), ~0u);
  TetMesh left;
  left.region_names = mesh.region_names;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (going[t]) continue;
    Tet tet = mesh.tets[t];
    for (std::uint32_t& v : tet) {
      if (number[v] == ~0u) {
        number[v] = static_cast<std::uint32_t>(left.vertices.size());
        left.vertices.push_back(mesh.vertices[v]);
      }
      v = number[v];
    }
    left.tets.push_back(tet);
    left.regions.push_back(mesh.regions[t]);
  }
  mesh = std::move(left);
}

}  // namespace

std::map<int, std::size_t> mesh_pieces(const TetMesh& mesh) {
  std::map<int, std::size_t> count;
  for (const auto& [first, volume] : find_pieces(mesh).volume) ++count[mesh.regions[first]];
  return count;
}

std::size_t absorb_specks(TetMesh& mesh, double speck, const std::map<int, std::size_t>& kept) {
  const RegionPieces pieces = find_pieces(mesh);
  std::map<int, std::vector<std::pair<double, std::uint32_t>>> by_region;
  for (const auto& [first, volume] : pieces.volume) by_region[mesh.regions[first]].push_back({-volume, first});
  std::map<std::uint32_t, std::map<int, double>> going;  // piece → area with each other region
  for (auto& [region, list] : by_region) {
    std::sort(list.begin(), list.end());
    const auto keep = kept.find(region);
    for (std::size_t i = keep == kept.end() ? list.size() : keep->second; i < list.size(); ++i) {
      if (-list[i].first < speck) going[list[i].second];
    }
  }
  if (going.empty()) return 0;
  for (const Pair& pair : pieces.pairs) {
    for (const auto& [own, other] : {std::pair(pair.a, pair.b), std::pair(pair.b, pair.a)}) {
      const auto it = going.find(pieces.of[own]);
      if (it != going.end() && !going.contains(pieces.of[other])) it->second[mesh.regions[other]] += pair.area;
    }
  }
  std::vector<char> removed(mesh.tets.size(), 0);
  bool any_removed = false;
  std::vector<int> regions = mesh.regions;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    const auto it = going.find(pieces.of[t]);
    if (it == going.end()) continue;
    const auto most = std::max_element(it->second.begin(), it->second.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most != it->second.end()) {
      regions[t] = most->first;
    } else {
      removed[t] = 1;
      any_removed = true;
    }
  }
  mesh.regions = std::move(regions);
  if (any_removed) remove_tets(mesh, removed);
  return going.size();
}

}  // namespace glisson::image
