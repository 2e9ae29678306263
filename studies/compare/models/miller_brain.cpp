// miller_brain.cpp — the law of brain of Miller and Chinzei [Miller2000]: a polynomial of both invariants under a convolution integral,
//
//   W = ∫ Σ C_ij(t − s) d/ds [(I₁ − 3)^i (I₂ − 3)^j] ds,   1 ≤ i + j ≤ 2,   C₁₀ = C₀₁, C₂₀ = C₀₂, C₁₁ = 0,
//   C_ij(t) = C_ij (1 − Σ g (1 − e^(−t/τ))), one course for all.
//
// C₁₀ and C₂₀ are fitted to the scene's tissue at once (calibration.h); its branches are taken as they are. Under a stretch that is held the stress is the published one; while it grows it differs in what is convolved, here the second
// Piola–Kirchhoff stress, there the nominal one: the same at small strain.
#include <exception>

#include "compare/models/calibration.h"
#include "compare/models/engine.h"
#include "glisson/material/hyperelastic_law.h"

namespace glisson::models {
namespace {

Tissue as_brain(const Tissue& tissue) {
  const auto slope = [](double stretch) { return 2.0 * (stretch - 1.0 / (stretch * stretch)); };
  const auto first = [&](const TestPoint& p) { return slope(p.stretch) * (1.0 + 1.0 / p.stretch); };
  const auto second = [&](const TestPoint& p) {
    const double l = p.stretch, i1 = l * l + 2.0 / l, i2 = 2.0 * l + 1.0 / (l * l);
    return slope(l) * 2.0 * ((i1 - 3.0) + (i2 - 3.0) / l);
  };
  const LinearFit fit = fit_terms(constant_volume_test(at_once(tissue), 1.0), first, second);
  const LameParameters lame = tissue.lame();
  Invariants law;
  law.c10 = law.c01 = fit.factors[0];
  law.c20 = law.c02 = fit.factors[1];
  law.bulk_modulus = lame.lambda + 2.0 / 3.0 * lame.mu;
  Tissue brain = linear_tissue(tissue, lame);
  brain.hyperelastic = law;
  brain.maxwell = tissue.maxwell;
  for (MaxwellBranch& branch : brain.maxwell) branch.time_law.reset();
  brain.maxwell_part = tissue.maxwell_part;
  return brain;
}

}  // namespace

Answer miller_brain(const Problem& problem, const Effort&, const Stop& stop) {
  if (!is_viscous(problem)) return without_viscosity("a polynomial of both invariants");
  try {
    return run_engine(problem, changed(problem, [](Tissue& t) { t = as_brain(t); }), {}, stop);
  } catch (const std::exception& error) {
    Answer answer;
    answer.trouble = error.what();
    return answer;
  }
}

}  // namespace glisson::models
