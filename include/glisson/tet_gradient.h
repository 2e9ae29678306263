// tet_gradient.h — the displacement gradient of a linear tetrahedron, from its shape at rest and what its vertices do.
#pragma once

#include <array>
#include <cstddef>

#include "glisson/math.h"

namespace glisson {

/// Rest geometry of a tetrahedron: volume and the gradients of its shape functions.
/// s[a] is row a of D_m⁻¹ for vertices 1, 2, 3; that of vertex 0 is −Σ s[a].
struct ElementRest {
  double volume = 0.0;       ///< V [m³]
  std::array<Vec3d, 3> s{};  ///< [1/m]
};

/// ∂N_a/∂X of all four vertices [1/m].
inline std::array<Vec3d, 4> shape_gradients(const ElementRest& rest) {
  return {-(rest.s[0] + rest.s[1] + rest.s[2]), rest.s[0], rest.s[1], rest.s[2]};
}

/// @param corners  rest positions of the four vertices [m], positively oriented
ElementRest element_rest(const std::array<Vec3d, 4>& corners);

/// H = Σ_a (u_a − u_0) ⊗ s_a: the displacement gradient of an element [-].
template <class T>
Mat3<T> displacement_gradient(const std::array<Vec3<T>, 3>& s, const std::array<Vec3<T>, 3>& difference) {
  Mat3<T> H;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      H(i, j) = difference[0][i] * s[0][j] + difference[1][i] * s[1][j] + difference[2][i] * s[2][j];
    }
  }
  return H;
}

}  // namespace glisson
