// tet_fields.h — what a tetrahedron looks like from outside.
#pragma once

#include <vector>

namespace glisson {

/// Fields in the order of the mesh's tets, computed in double whatever the elements compute in.
struct TetFields {
  std::vector<double> q;         ///< mean ratio against the rest shape, in [0, 1] [-]
  std::vector<double> s;         ///< strain-like intensity √(3 (1 − q) / 2) [-]
  std::vector<double> jacobian;  ///< J, ≤ 0 where inverted [-]
  /// Cauchy's stress, P Fᵀ/J: xx, yy, zz, xy, yz, zx of each tet [Pa]. In small strain the symmetric part of P.
  std::vector<double> stress;
  /// The first Piola–Kirchhoff stress P of which the forces follow, f_a = −Σ V P s_a: xx, xy, xz, yx, … of each tet [Pa].
  /// Elastic with the volume change that tets share, Kelvin–Voigt's, and what Maxwell branches have not relaxed. Only with a
  /// law in energy form and small strain it is not symmetric there.
  std::vector<double> piola;
};

}  // namespace glisson
