// tissue_zone.h — a point of a needle's path as the tissue around it: a weighted mean over a ball, through the mesh.
//
//   ū(X) = ∫ φ(|Y − X|/R) u(Y) dY / ∫ φ dY,   φ(r) = (1 − r²)²,   u(Y) = Σ N_i(Y) u_i      ⇒   ū = Σ w_i u_i,  Σ w_i = 1
//
// A force at X acts on vertex i by w_i. Where the mesh is finer than R the mean hardly knows it; where it is coarser, w
// becomes the barycentric coordinates of X. What of the ball lies outside the body does not count. The integral is a
// rule of 28 points, exact for polynomials of degree 5 in a body without boundary: two radii, 14 directions each. The directions
// follow the needle and the mesh, so that a scene that is turned stays the same.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "mesh/inspect/tet_locator.h"

namespace glisson {

/// A vertex and its weight [-].
struct VertexWeight {
  std::uint32_t vertex = 0;
  double weight = 0.0;
};

/// Weights of the mean around X, ascending by vertex; empty where the ball does not meet the body.
/// @param x  rest position [m], @param radius  R [m], @param axes  of the rule, as columns
std::vector<VertexWeight> zone_weights(const detail::TetLocator& locator, const TetMesh& mesh, const Vec3d& x,
                                       double radius, const Mat3d& axes = identity<double>());

/// Axes for a needle along `direction`, a unit vector, which is the third; the first is across it along an edge of the mesh.
Mat3d zone_axes(const TetMesh& mesh, const Vec3d& direction);

}  // namespace glisson
