#include "compare/models/relaxation.h"

#include <algorithm>
#include <cmath>

namespace glisson::models {

bool is_viscous(const Tissue& tissue) { return tissue.viscosity > 0.0 || !tissue.maxwell.empty(); }

bool is_viscous(const Problem& problem) {
  return std::any_of(problem.tissues.begin(), problem.tissues.end(),
                     [](const auto& t) { return is_viscous(t.second); });
}

double mean_share(const Tissue& tissue, double time) {
  if (time <= 0.0) return 1.0;
  double share = 1.0;
  for (const MaxwellBranch& b : tissue.maxwell) share -= b.share * (1.0 + b.time / time * std::expm1(-time / b.time));
  return share;
}

LameParameters test_moduli(const Problem& problem, const Tissue& tissue) {
  LameParameters lame = tissue.lame();
  if (tissue.maxwell.empty()) return lame;
  const double share = mean_share(tissue, problem.test_time), bulk = lame.lambda + 2.0 / 3.0 * lame.mu;
  lame.mu *= share;
  lame.lambda = (tissue.maxwell_part == MaxwellPart::all ? share * bulk : bulk) - 2.0 / 3.0 * lame.mu;
  return lame;
}

}  // namespace glisson::models
