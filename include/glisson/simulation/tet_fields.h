// tet_fields.h — results per tetrahedron.
#pragma once

#include <vector>

namespace glisson {

/// Fields in the order of the mesh's tets, computed in double for either precision of the elements.
struct TetFields {
  std::vector<double> q;         ///< mean ratio against the rest shape, in [0, 1] [-]
  std::vector<double> s;         ///< equivalent shear strain √(3 (1 − q) / 2) [-]
  std::vector<double> jacobian;  ///< J, ≤ 0 where inverted [-]
  /// Cauchy's stress, P Fᵀ/J: xx, yy, zz, xy, yz, zx of each tet [Pa]. In small strain the symmetric part of P.
  std::vector<double> stress;
  /// The first Piola–Kirchhoff stress P of the forces, f_a = −Σ V P s_a: xx, xy, xz, yx, … of each tet [Pa].
  /// Elastic part with averaged volume change, Kelvin–Voigt part, and unrelaxed part of Maxwell branches. With a law in
  /// energy form and small strain it is not symmetric.
  std::vector<double> piola;
  /// Share of the linear law in the tissue's forces, 0 unless precision is adaptive [-].
  std::vector<double> linear;
};

}  // namespace glisson
