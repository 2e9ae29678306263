// octant.h — the eighth of a ball or of a shell, for pressure on a sphere.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "glisson/mesh.h"
#include "glisson/simulation/simulation.h"

namespace glisson::test {

/// x, y, z ≥ 0 of a shell, with the vertex sets x, y, z (its planes), inside and outside.
struct Octant {
  TetMesh mesh;

  /// Symmetry: the planes stay planes.
  void hold_planes(Simulation& s) const {
    s.fix("x", {true, false, false});
    s.fix("y", {false, true, false});
    s.fix("z", {false, false, true});
  }
};

/// Collects cells with eight corners; each becomes twelve tets about its middle, whose faces' diagonals start from the
/// smallest number, so that neighbours fit.
class CellMesh {
 public:
  std::uint32_t vertex(const Vec3d& x) {
    const auto rounded = [](double a) { return std::lround(a * 1e9); };
    const auto [at, fresh] = numbers_.try_emplace({rounded(x.x), rounded(x.y), rounded(x.z)},
                                                  static_cast<std::uint32_t>(mesh.vertices.size()));
    if (fresh) mesh.vertices.push_back(x);
    return at->second;
  }

  /// @param c  corners, i + 2 j + 4 k
  void add(const std::array<std::uint32_t, 8>& c) {
    Vec3d middle{};
    for (const std::uint32_t v : c) middle += mesh.vertices[v] * 0.125;
    const auto centre = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(middle);
    static constexpr std::array<std::array<std::size_t, 4>, 6> kFaces{
        {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};
    for (const auto& face : kFaces) {
      std::size_t first = 0;
      for (std::size_t i = 1; i < 4; ++i) {
        if (c[face[i]] < c[face[first]]) first = i;
      }
      const auto at = [&](std::size_t i) { return c[face[(first + i) % 4]]; };
      for (std::size_t i = 1; i < 3; ++i) tet({centre, at(0), at(i), at(i + 1)});
    }
  }

  TetMesh mesh;

 private:
  void tet(Tet t) {
    if (t[1] == t[2] || t[2] == t[3] || t[1] == t[3]) return;  // a face that is a line or a triangle
    const std::vector<Vec3d>& x = mesh.vertices;
    const double volume = dot(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]), x[t[3]] - x[t[0]]);
    if (std::abs(volume) < 1e-20) return;
    if (volume < 0.0) std::swap(t[2], t[3]);
    mesh.tets.push_back(t);
  }

  std::map<std::array<long, 3>, std::uint32_t> numbers_;
};

/// @param across  cells along each edge of its three patches @param deep  cells along the radius @param inside  radius; 0: a ball
inline Octant octant(int across, int deep, double inside, double outside) {
  CellMesh cells;
  const auto place = [&](std::size_t patch, int i, int j, int k) {
    Vec3d x;
    x[patch] = 1.0;
    x[(patch + 1) % 3] = std::tan(std::numbers::pi / 4.0 * i / across);
    x[(patch + 2) % 3] = std::tan(std::numbers::pi / 4.0 * j / across);
    return unit(x) * (inside + (outside - inside) * k / deep);
  };
  for (std::size_t patch = 0; patch < 3; ++patch) {
    for (int n = 0; n < across * across * deep; ++n) {
      const int i = n % across, j = n / across % across, k = n / across / across;
      std::array<std::uint32_t, 8> c;
      for (int q = 0; q < 8; ++q) {
        c[static_cast<std::size_t>(q)] = cells.vertex(place(patch, i + q % 2, j + q / 2 % 2, k + q / 4));
      }
      cells.add(c);
    }
  }
  Octant octant{std::move(cells.mesh)};
  for (std::uint32_t v = 0; v < octant.mesh.vertices.size(); ++v) {
    const Vec3d& x = octant.mesh.vertices[v];
    const double r = norm(x), close = 1e-9 * outside;
    auto& sets = octant.mesh.vertex_sets;
    if (std::abs(x.x) < close) sets["x"].push_back(v);
    if (std::abs(x.y) < close) sets["y"].push_back(v);
    if (std::abs(x.z) < close) sets["z"].push_back(v);
    if (std::abs(r - inside) < close && inside > 0.0) sets["inside"].push_back(v);
    if (std::abs(r - outside) < close) sets["outside"].push_back(v);
  }
  return octant;
}

}  // namespace glisson::test
