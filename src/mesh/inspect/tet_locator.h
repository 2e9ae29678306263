// tet_locator.h — which tetrahedron of the rest mesh holds a point: a uniform grid of cells with the tets that reach
// into each.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "glisson/mesh.h"

namespace glisson::detail {

/// A point of the mesh: a tet and barycentric coordinates in it, which sum to 1.
struct LocatedPoint {
  std::uint32_t tet = 0;
  std::array<double, 4> weights{};
};

class TetLocator {
 public:
  /// @param mesh     must outlive this, unchanged
  /// @param removed  per tet: 1 where it is gone; empty: none is; copied into the grid
  /// Cost: O(tets); some 120 bytes a tet.
  TetLocator(const TetMesh& mesh, std::span<const char> removed);

  /// The tet that holds a rest position; of several the one of lowest number.
  /// @param x  rest position [m]
  /// @return none outside the body. Faces belong to it: coordinates down to −1e-9 count as inside
  std::optional<LocatedPoint> locate(const Vec3d& x) const;
  /// The same, quicker where the guess is right. @param guess  a tet that is not removed
  std::optional<LocatedPoint> locate(const Vec3d& x, std::uint32_t guess) const;

 private:
  std::optional<LocatedPoint> within(std::uint32_t tet, const Vec3d& x, double least) const;
  std::array<int, 3> cell_of(const Vec3d& x) const;
  std::size_t number(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(cells_[1]) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(cells_[0]) +
           static_cast<std::size_t>(i);
  }

  const TetMesh* mesh_;
  Vec3d low_{}, high_{};
  double cell_ = 1.0;  ///< [m]
  std::array<int, 3> cells_{1, 1, 1};
  std::vector<std::size_t> begin_;
  std::vector<std::uint32_t> tets_;
};

}  // namespace glisson::detail
