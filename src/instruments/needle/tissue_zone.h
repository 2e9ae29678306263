// tissue_zone.h — a point of a needle's path as the tissue around it: a weighted mean over a ball, through the mesh.
//
//   ū(X) = ∫ φ(|Y − X|/r) u(Y) dY / ∫ φ dY,   φ(s) = (1 − s²)²,   u(Y) = Σ N_i(Y) u_i      ⇒   ū = Σ w_i u_i,  Σ w_i = 1
//
// A force at X acts on vertex i by w_i. A mesh of edge h spreads a load by itself: a ball of radius r on it yields as one of
// √(r² + 1.05 h²) in a continuum. So r² = R² − 1.05 h², and the tissue yields as the zone of radius R does. h is the edge of a
// regular tet of the volume that tets around X have. Above 0.6 R less of it is made up for, from 0.7 R on nothing: such a mesh
// does not resolve the zone. What of the ball lies outside the body does not count.
//
// The integral is a sum over points. Where the mesh resolves the zone: Gauss's rule for φ along the radius, on each sphere a
// spiral about the needle and its mirror image through X, so that linear fields are exact. The points lie closer than the mesh's
// edges: a load does not fall apart into single points. None lies in the plane through X across the needle, where rounding would
// decide which side of a surface it is on; no two are at one depth, so that they enter the body one by one. On coarser meshes:
// 28 points, two radii and Lebedev's 14 directions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "glisson/simulation/interaction.h"
#include "mesh/inspect/tet_locator.h"

namespace glisson {

class TissueZones {
 public:
  /// @param mesh, removed  as for TetLocator, @param radius  R [m], @param axes  of the rule, as columns
  TissueZones(const TetMesh& mesh, std::span<const char> removed, double radius,
              const Mat3d& axes = identity<double>());

  const detail::TetLocator& locator() const { return locator_; }

  /// Weights of the mean around X, ascending by vertex; empty where the ball does not meet the body.
  /// @param x  rest position [m]
  std::vector<VertexWeight> weights(const Vec3d& x);

 private:
  double edge_squared(const Vec3d& x) const;
  std::vector<VertexWeight> joined(std::span<const VertexWeight> weights, double sum);

  const TetMesh* mesh_;
  detail::TetLocator locator_;
  double radius_;
  Mat3d axes_;
  std::vector<double> edge_squared_;  ///< per vertex: mean over its tets, weighted by volume [m²]
  std::vector<std::uint32_t>
      guesses_;  ///< per point of the rule: the tet that held it last, where a needle that moves on finds it again
  std::vector<std::uint32_t> count_;  ///< per vertex, for joined(): 0 between calls
  std::vector<double> by_vertex_;
};

/// Axes for a needle along `direction`, a unit vector, which is the third; the first is across it along an edge of the mesh.
Mat3d zone_axes(const TetMesh& mesh, const Vec3d& direction);

}  // namespace glisson
