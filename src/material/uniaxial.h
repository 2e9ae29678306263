// uniaxial.h — the curve of a tensile or compression test with free sides, from a tissue's own response.
#pragma once

#include "material/response.h"

namespace glisson {

struct UniaxialState {
  double stress = 0.0;           ///< nominal stress along z, P_zz [Pa]
  double lateral_stretch = 1.0;  ///< across [-]
  bool converged = false;        ///< false: no lateral stretch between 0.05 and 20 leaves the sides free
};

/// P_zz at the stretch λ along z with P_xx = P_yy = 0; isotropic tissues, no fibres.
/// @param stretch  λ, > 0 [-]
UniaxialState uniaxial_state(const Response& response, double stretch);

}  // namespace glisson
