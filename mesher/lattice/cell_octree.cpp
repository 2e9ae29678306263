// cell_octree.cpp — see cell_octree.h.
#include "mesher/lattice/cell_octree.h"

namespace glisson::lattice {

CellOctree::CellOctree(const std::array<int, 3>& roots, int level)
    : roots_(roots), root_level_(level),
      root_count_(static_cast<std::uint32_t>(roots[0]) * static_cast<std::uint32_t>(roots[1]) *
                  static_cast<std::uint32_t>(roots[2])) {
  cells_.reserve(root_count_);
  for (int k = 0; k < roots[2]; ++k) {
    for (int j = 0; j < roots[1]; ++j) {
      for (int i = 0; i < roots[0]; ++i) cells_.push_back({{i << level, j << level, k << level}, level});
    }
  }
}

void CellOctree::split(std::uint32_t index) {
  const OctreeCell parent = cells_[index];
  cells_[index].children = static_cast<std::uint32_t>(cells_.size());
  const int half = parent.side() / 2;
  for (int c = 0; c < 8; ++c) {
    const std::array<int, 3> low{parent.low[0] + (c & 1 ? half : 0), parent.low[1] + (c & 2 ? half : 0),
                                 parent.low[2] + (c & 4 ? half : 0)};
    cells_.push_back({low, parent.level - 1});
  }
}

std::uint32_t CellOctree::find(const std::array<int, 3>& at, int level) const {
  std::array<int, 3> root{};
  for (std::size_t d = 0; d < 3; ++d) {
    if (at[d] < 0) return kNowhere;
    root[d] = at[d] >> root_level_;
    if (root[d] >= roots_[d]) return kNowhere;
  }
  auto index = static_cast<std::uint32_t>((root[2] * roots_[1] + root[1]) * roots_[0] + root[0]);
  while (cells_[index].level > level && !cells_[index].leaf()) {
    const int bit = cells_[index].level - 1;
    index = cells_[index].children + static_cast<std::uint32_t>(((at[0] >> bit) & 1) | (((at[1] >> bit) & 1) << 1) |
                                                                (((at[2] >> bit) & 1) << 2));
  }
  return index;
}

std::array<int, 3> CellOctree::beside(const OctreeCell& cell, const std::array<int, 3>& steps) {
  std::array<int, 3> at = cell.low;
  for (std::size_t d = 0; d < 3; ++d) at[d] += steps[d] * cell.side();
  return at;
}

void CellOctree::balance() {
  std::vector<std::uint32_t> open = leaves();
  while (!open.empty()) {
    const std::uint32_t index = open.back();
    open.pop_back();
    if (!cells_[index].leaf()) continue;
    const OctreeCell cell = cells_[index];
    for (int n = 0; n < 27; ++n) {
      const std::array<int, 3> at = beside(cell, {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1});
      std::uint32_t other = find(at, cell.level);
      while (other != kNowhere && cells_[other].level > cell.level + 1) {
        split(other);
        for (std::uint32_t c = 0; c < 8; ++c) open.push_back(cells_[other].children + c);
        other = find(at, cell.level);
      }
    }
  }
}

std::vector<std::uint32_t> CellOctree::leaves() const {
  std::vector<std::uint32_t> out, open;
  for (std::uint32_t root = 0; root < root_count_; ++root) {
    open.assign(1, root);
    while (!open.empty()) {
      const std::uint32_t index = open.back();
      open.pop_back();
      if (cells_[index].leaf()) {
        out.push_back(index);
        continue;
      }
      for (std::uint32_t c = 8; c-- > 0;) open.push_back(cells_[index].children + c);
    }
  }
  return out;
}

}  // namespace glisson::lattice
