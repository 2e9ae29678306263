// pioletti.cpp — the law of ligaments of Pioletti et al. [Pioletti1998]: an exponential potential of the strain, one of its rate, and
// memory that fades,
//
//   W = α e^(β (I₁ − 3)) − ½ α β (I₂ − 3)      W_v = ¼ η′ (I₁ − 3) tr(Ċ²)      S_v = 2 η′ (I₁ − 3) Ė.
//
// `pioletti_rate` is the law of three parameters: α, β and η′ are fitted together to the scene's tissue, pressed and pulled within the time
// of the test (calibration.h). It forgets at once: what is held has no more than the elastic stress. `pioletti_memory` has memory in the
// place of the rate: α and β are fitted to the tissue at once, and its branches fade.
#include <cmath>
#include <exception>

#include "compare/models/calibration.h"
#include "compare/models/engine.h"
#include "glisson/material/hyperelastic_law.h"

namespace glisson::models {
namespace {

double first_invariant(double l) { return l * l + 2.0 / l; }

/// p of W with α = 1.
double elastic_term(double l, double b) {
  return 2.0 * (l - 1.0 / (l * l)) * b * (std::exp(b * (first_invariant(l) - 3.0)) - 0.5 / l);
}

/// p of W_v with η′ = 1: S_v : ∂E/∂λ.
double rate_term(const TestPoint& p) {
  const double l = p.stretch;
  return 2.0 * (first_invariant(l) - 3.0) * (l * l + 0.5 / std::pow(l, 4)) * p.rate;
}

LinearFit fit_with(const std::vector<TestPoint>& test, double b, bool rate) {
  return fit_terms(
      test, [&](const TestPoint& p) { return elastic_term(p.stretch, b); },
      [&](const TestPoint& p) { return rate ? rate_term(p) : 0.0; });
}

Tissue as_ligament(const Tissue& tissue, const std::vector<TestPoint>& test, bool rate) {
  constexpr double kLeastB = 0.01, kMostB = 50.0;
  const double b = least_over(kLeastB, kMostB, [&](double x) { return fit_with(test, x, rate).rest; });
  const LinearFit fit = fit_with(test, b, rate);
  const LameParameters lame = tissue.lame();
  Tissue ligament = linear_tissue(tissue, lame);
  ligament.hyperelastic = VerondaWestmann{fit.factors[0], b, lame.lambda + 2.0 / 3.0 * lame.mu};
  ligament.viscosity = fit.factors[1];
  ligament.viscous_tensor = ViscousTensor::pioletti;
  return ligament;
}

template <class Change>
Answer run_as_ligament(const Problem& problem, const Stop& stop, Integrator integrator, Change change) {
  if (!is_viscous(problem)) return without_viscosity("an exponential law");
  try {
    return run_engine(problem, changed(problem, change), {.integrator = integrator}, stop);
  } catch (const std::exception& error) {
    Answer answer;
    answer.trouble = error.what();
    return answer;
  }
}

}  // namespace

Answer pioletti_rate(const Problem& problem, const Effort&, const Stop& stop) {
  return run_as_ligament(problem, stop, Integrator::semi_implicit,
                         [&](Tissue& t) { t = as_ligament(t, constant_volume_test(t, problem.test_time), true); });
}

Answer pioletti_memory(const Problem& problem, const Effort&, const Stop& stop) {
  return run_as_ligament(problem, stop, Integrator::central_difference, [](Tissue& t) {
    Tissue ligament = as_ligament(t, constant_volume_test(at_once(t), 1.0), false);
    ligament.viscosity = 0.0;
    ligament.maxwell = t.maxwell;
    for (MaxwellBranch& branch : ligament.maxwell) branch.time_law.reset();
    ligament.maxwell_part = t.maxwell_part;
    t = ligament;
  });
}

}  // namespace glisson::models
