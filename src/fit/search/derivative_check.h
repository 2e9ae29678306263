// derivative_check.h — how wide the differences are to be, and how far their derivatives can be trusted.
#pragma once

#include <span>

#include "fit/search/problem.h"

namespace glisson::fit {

struct DerivativeCheck {
  double step = 0.0;   ///< in z; 0: no derivative could be had
  double error = 0.0;  ///< ‖J(step) − J(next wider)‖ / ‖J‖, at most over the columns
};

/// Tries steps a decade apart, widest first, and takes the one whose derivatives agree best with those of its wider
/// neighbour: wider ones bend, narrower ones drown in the simulation's own rounding. Steps to where the model fails are left out.
/// @param enough  it goes no further where they agree to this: of a dear model nobody needs more; 0: tries all
DerivativeCheck check_derivatives(Problem& problem, std::span<const double> scaled, double enough = 0.0);

}  // namespace glisson::fit
