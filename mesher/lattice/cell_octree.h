// cell_octree.h — cubes that are halved where a mesh is finer, neighbours by no more than one level.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace glisson::lattice {

/// A cube of 2^level finest cubes a side.
struct OctreeCell {
  static constexpr std::uint32_t kLeaf = ~0u;
  std::array<int, 3> low{};  ///< its lowest finest cube
  int level = 0;
  std::uint32_t children = kLeaf;  ///< the first of eight, x fastest

  int side() const { return 1 << level; }
  bool leaf() const { return children == kLeaf; }
};

class CellOctree {
 public:
  static constexpr std::uint32_t kNowhere = ~0u;

  /// @param roots  cubes of the given level along x, y and z
  CellOctree(const std::array<int, 3>& roots, int level);

  const OctreeCell& cell(std::uint32_t index) const { return cells_[index]; }
  std::uint32_t root_count() const { return root_count_; }
  std::size_t size() const { return cells_.size(); }
  void split(std::uint32_t index);

  /// The cube of this or the next higher level there is that holds the finest cube `at`, or kNowhere.
  std::uint32_t find(const std::array<int, 3>& at, int level) const;
  /// The place of the neighbour of a cube, one step of its side along each axis.
  static std::array<int, 3> beside(const OctreeCell& cell, const std::array<int, 3>& steps);

  /// Splits cubes until those that share a corner differ by at most one level.
  void balance();
  /// Leaves in the order of the tree.
  std::vector<std::uint32_t> leaves() const;

 private:
  std::array<int, 3> roots_;
  int root_level_;
  std::uint32_t root_count_;
  std::vector<OctreeCell> cells_;
};

}  // namespace glisson::lattice
