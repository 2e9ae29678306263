// pieces.h — connected pieces of equal voxels, by their faces.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "glisson/image/image.h"

namespace glisson::image {

struct Piece {
  std::uint32_t value = 0;  ///< of its voxels
  std::size_t voxels = 0;
  std::size_t first = 0;   ///< its first voxel in memory
  bool at_border = false;  ///< of the grid
};

/// Pieces in the order of their first voxels, and the piece of each voxel.
struct Pieces {
  std::vector<Piece> all;
  std::vector<std::uint32_t> of;
};

/// @param voxels  a value for each voxel of the grid
template <class Value>
Pieces find_pieces(const ImageGrid& grid, const std::vector<Value>& voxels) {
  constexpr std::uint32_t kNone = ~0u;
  Pieces p;
  p.of.assign(voxels.size(), kNone);
  const std::size_t nx = grid.size[0], nxy = nx * grid.size[1];
  std::vector<std::size_t> open;
  for (std::size_t start = 0; start < voxels.size(); ++start) {
    if (p.of[start] != kNone) continue;
    const auto number = static_cast<std::uint32_t>(p.all.size());
    Piece piece{static_cast<std::uint32_t>(voxels[start]), 0, start, false};
    p.of[start] = number;
    open.assign(1, start);
    while (!open.empty()) {
      const std::size_t v = open.back();
      open.pop_back();
      ++piece.voxels;
      const std::array<std::size_t, 3> at = grid.place(v), step{1, nx, nxy};
      for (std::size_t a = 0; a < 3; ++a) {
        piece.at_border = piece.at_border || at[a] == 0 || at[a] + 1 == grid.size[a];
        for (const bool up : {false, true}) {
          if (up ? at[a] + 1 == grid.size[a] : at[a] == 0) continue;
          const std::size_t w = up ? v + step[a] : v - step[a];
          if (p.of[w] != kNone || voxels[w] != voxels[start]) continue;
          p.of[w] = number;
          open.push_back(w);
        }
      }
    }
    p.all.push_back(piece);
  }
  return p;
}

}  // namespace glisson::image
