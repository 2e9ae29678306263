// secant_descent.h — the nearest optimum in few runs, for models whose runs are dear.
//
// Levenberg and Marquardt's steps with derivatives that are carried along (secant_jacobian.h). Bounds are part of the step: it
// is solved with a parameter held where it would leave the box, or where it stands at a bound that the cost pushes it against.
#pragma once

#include <span>

#include "fit/search/least_squares.h"

namespace glisson::fit {

/// As descend(). Converged is an end from which a step by a Jacobian of differences, taken at the very end, promises or gains
/// less than the tolerance. Iterations are steps tried.
Optimum secant_descent(const Problem& problem, std::span<const double> start, const DescentOptions& options);

}  // namespace glisson::fit
