// influence.h — what one residual weighs in a robust fit.
//
//   cost = ½ Σ ρ(r²);   influence ψ(r) = ρ'(r²) r;   its slope ψ'(r) = ρ' + 2 r² ρ''
#pragma once

#include "fit/search/problem.h"

namespace glisson::fit {

struct Influence {
  double value = 0.0;  ///< ψ(r): the pull of the residual
  double slope = 0.0;  ///< dψ/dr: 1 for squares, less than 0 where a loss bends down
};

/// ψ and ψ' of a residual, as Problem::cost sees it. [Huber1981]
Influence influence(const Loss& loss, double residual);

}  // namespace glisson::fit
