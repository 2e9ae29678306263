// cut_snap.h — brings vertices of a mesh onto a cut, at rest, as far as the tets around them bear it.
//
//        ·   ╲     ╱  ·                     A vertex goes the shortest way to the plane of the cut near it, within
//    ─ ─ ─ ─ ─●─ ─ ─ ─ ─ ─  plane           the faces and edges of the body and of its tissues that it is on: the
//        ·   ╱ ↑    ╲ ·                     volume of each stays what it was, to rounding.
//
// It goes all the way, three quarters, half or a quarter of it: the first that leaves every tet around it as good as it
// must be, at rest, and not turned over or much flattened in its present shape.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <unordered_map>
#include <vector>

#include "glisson/mesh.h"
#include "mesh/topology/vertex_stars.h"

namespace glisson::detail {

/// A body, as moving its vertices sees it.
struct SnapMesh {
  std::span<const Tet> tets;  ///< those in `stars` live
  const VertexStars& stars;
  std::span<const Vec3d> rest, displacement;  ///< per vertex [m]
  std::span<const std::uint32_t> root;        ///< per vertex: the vertex it is a copy of, first of all
  std::function<std::size_t(std::uint32_t tet)> tissue;
  /// Whether a vertex may become the point with these weights in this tet.
  std::function<bool(std::uint32_t vertex, const Tet& tet, const std::array<double, 4>& weights)> may_become;
};

/// What a tet must be after a move; one that is worse already may not become worse still.
struct SnapLimits {
  double quality = 0.0;        ///< least mean ratio at rest [-]
  std::vector<double> spread;  ///< largest spread_of at rest, by tissue [1/m²]
  double nearest = 0.0;        ///< ways shorter than that are not gone [m]
};

/// Mean ratio of four corners as of regular_mean_ratio, 0 where they are turned over.
double mean_ratio_of(const std::array<Vec3d, 4>& corners);
/// Largest eigenvalue of Σ s sᵀ over the gradients s of the four shape functions [1/m²]: what a tet's bound of the stable
/// step goes with; infinite where it is turned over.
double spread_of(const std::array<Vec3d, 4>& corners);

class CutSnap {
 public:
  /// @param mesh  must outlive this
  CutSnap(const SnapMesh& mesh, const SnapLimits& limits) : mesh_(mesh), limits_(limits) {}

  /// Moves a vertex towards a plane, as far as can be.
  /// @param normal  of length 1
  /// @return what is left of the way [m]: 0 where it is on the plane
  double bring(std::uint32_t vertex, const Vec3d& point, const Vec3d& normal);

  /// All moves so far, in their order.
  const std::vector<VertexMove>& moves() const { return moves_; }

 private:
  struct State {
    Vec3d rest, displacement;
  };
  State state(std::uint32_t vertex) const;
  std::array<Vec3d, 4> corners(std::uint32_t tet) const;
  std::vector<Vec3d> normals(std::uint32_t vertex) const;
  bool try_at(std::uint32_t vertex, const Vec3d& to);

  const SnapMesh& mesh_;
  SnapLimits limits_;
  std::unordered_map<std::uint32_t, State> moved_;
  std::vector<VertexMove> moves_;
};

}  // namespace glisson::detail
