// tet_fields.h — what a tetrahedron looks like from outside.
#pragma once

#include <vector>

namespace glisson {

/// Fields in the order of the mesh's tets, computed in double whatever the elements compute in.
struct TetFields {
  std::vector<double> q;         ///< mean ratio against the rest shape, in [0, 1] [-]
  std::vector<double> s;         ///< strain-like intensity √(3 (1 − q) / 2) [-]
  std::vector<double> jacobian;  ///< J, ≤ 0 where inverted [-]
  /// Stress with Kelvin–Voigt's part, Maxwell branches not relaxed: xx, yy, zz, xy, yz, zx of each tet [Pa]. Of the small
  /// strain where that is the kinematics, else Cauchy's.
  std::vector<double> stress;
};

}  // namespace glisson
