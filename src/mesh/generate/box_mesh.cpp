// box_mesh.cpp — a box of cubes, each split in six tetrahedra around one of its space diagonals.
//
// The split of a cube (Kuhn): every path from corner 000 to corner 111 along three edges, one per axis and
// in any of the 3! orders, is a tetrahedron. All six share the diagonal 000–111, and every face of the cube
// is cut along the diagonal through its lowest corner, so that equal cubes side by side fit:
//
//        011──────111        000 → 100 → 110 → 111
//        /│       /│         000 → 100 → 101 → 111
//     001──────101 │         000 → 010 → 110 → 111
//      │ 010────│─110        000 → 010 → 011 → 111
//      │ /      │ /          000 → 001 → 101 → 111
//     000──────100           000 → 001 → 011 → 111
//
// The alternating split mirrors the cube in every second cell along each axis. Two neighbours are then
// mirror images in their common face, so they fit too, and the diagonals point to all four directions.
#include <algorithm>

#include "base/require_fields.h"
#include "base/text.h"
#include "glisson/mesh.h"

namespace glisson {
namespace {

constexpr double kMaxBoxCells = 1e8;

/// Axis orders of the six paths; the first three are even permutations (positive orientation).
constexpr std::array<std::array<int, 3>, 6> kPaths{{{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};

/// Vertex numbers of a grid of cells: x runs fastest, then y, then z.
struct Grid {
  std::array<int, 3> cells;

  std::uint32_t vertex(int i, int j, int k) const {
    const auto nx = static_cast<std::uint32_t>(cells[0] + 1), ny = static_cast<std::uint32_t>(cells[1] + 1);
    return static_cast<std::uint32_t>(i) + nx * (static_cast<std::uint32_t>(j) + ny * static_cast<std::uint32_t>(k));
  }
};

void add_vertices(const BoxOptions& options, TetMesh& mesh) {
  const auto& n = options.cells;
  const auto coordinate = [&](std::size_t axis, int index) {
    return options.origin[axis] + options.size[axis] * index / n[axis];
  };
  for (int k = 0; k <= n[2]; ++k) {
    for (int j = 0; j <= n[1]; ++j) {
      for (int i = 0; i <= n[0]; ++i) {
        mesh.vertices.push_back({coordinate(0, i), coordinate(1, j), coordinate(2, k)});
      }
    }
  }
}

/// Adds the six tetrahedra of a cell; `mirrored` tells along which axes its paths run backwards.
void add_cell(const Grid& grid, const std::array<int, 3>& cell, const std::array<bool, 3>& mirrored, TetMesh& mesh) {
  const bool odd_mirrors = (mirrored[0] != mirrored[1]) != mirrored[2];
  for (std::size_t p = 0; p < kPaths.size(); ++p) {
    std::array<int, 3> corner{mirrored[0], mirrored[1], mirrored[2]};
    Tet tet{};
    for (std::size_t step = 0; step < 4; ++step) {
      tet[step] = grid.vertex(cell[0] + corner[0], cell[1] + corner[1], cell[2] + corner[2]);
      if (step == 3) break;
      int& c = corner[static_cast<std::size_t>(kPaths[p][step])];
      c = 1 - c;
    }
    const bool odd_path = p >= 3;
    if (odd_path != odd_mirrors) std::swap(tet[2], tet[3]);
    mesh.tets.push_back(tet);
  }
}

void add_tets(const BoxOptions& options, const Grid& grid, TetMesh& mesh) {
  const bool alternating = options.split == BoxSplit::alternating;
  for (int k = 0; k < options.cells[2]; ++k) {
    for (int j = 0; j < options.cells[1]; ++j) {
      for (int i = 0; i < options.cells[0]; ++i) {
        const std::array<bool, 3> odd{i % 2 == 1, j % 2 == 1, k % 2 == 1};
        add_cell(grid, {i, j, k}, alternating ? odd : std::array<bool, 3>{}, mesh);
      }
    }
  }
}

void add_sides(const Grid& grid, TetMesh& mesh) {
  const char* names[3][2] = {{"x_min", "x_max"}, {"y_min", "y_max"}, {"z_min", "z_max"}};
  const auto& n = grid.cells;
  for (int k = 0; k <= n[2]; ++k) {
    for (int j = 0; j <= n[1]; ++j) {
      for (int i = 0; i <= n[0]; ++i) {
        const std::array<int, 3> index{i, j, k};
        for (std::size_t a = 0; a < 3; ++a) {
          if (index[a] == 0) mesh.vertex_sets[names[a][0]].push_back(grid.vertex(i, j, k));
          if (index[a] == n[a]) mesh.vertex_sets[names[a][1]].push_back(grid.vertex(i, j, k));
        }
      }
    }
  }
}

}  // namespace

Fault BoxOptions::check() const {
  const double all = 1.0 * cells[0] * cells[1] * cells[2];
  if (all <= kMaxBoxCells) return {};
  return {detail::show(all) + " cubes in all are too many; allowed: at most 1e8", "cells"};
}

TetMesh box_mesh(const BoxOptions& options) {
  detail::require_fields("box", options);
  const Grid grid{options.cells};
  const auto n = [&](std::size_t a) { return static_cast<std::size_t>(options.cells[a]); };
  TetMesh mesh;
  mesh.vertices.reserve((n(0) + 1) * (n(1) + 1) * (n(2) + 1));
  mesh.tets.reserve(6 * n(0) * n(1) * n(2));
  add_vertices(options, mesh);
  add_tets(options, grid, mesh);
  add_sides(grid, mesh);
  return mesh;
}

}  // namespace glisson
