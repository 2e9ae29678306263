// linear_viscous.cpp — linear viscosity at small strain: a dashpot beside the spring, as the paper has it [Schwartz2002, eq. 7], and
// springs with dashpots in series beside it, the generalised Maxwell body.
//
//   Kelvin–Voigt   σ = μ γ + η γ̇                 relaxes at once, and its force grows with speed without bound
//   Maxwell        σ = ∫ μ(t − s) dγ/ds ds        the tissue's own branches
//
// Of a tissue with branches Kelvin–Voigt gets the μ and η with which μ t + η is nearest to the tissue's stress in a ramp of unit rate,
// ∫₀ᵗ μ(s) ds, over the time of the test, by least squares. A tissue without branches keeps its own.
#include <array>

#include "compare/models/calibration.h"
#include "compare/models/engine.h"
#include "glisson/simulation/simulation.h"

namespace glisson::models {
namespace {

/// The paper's spring and dashpot: shares of the instantaneous modulus, and times of it [s].
Tissue with_dashpot(const Problem& problem, const Tissue& tissue) {
  Tissue linear = linear_tissue(tissue, test_moduli(problem, tissue));
  linear.viscosity = tissue.viscosity;
  linear.viscous_tensor =
      tissue.viscous_tensor == ViscousTensor::pioletti ? ViscousTensor::deviatoric : tissue.viscous_tensor;
  if (tissue.viscous_tensor == ViscousTensor::pioletti) linear.viscosity = 0.0;  // of small strain it has none
  if (tissue.maxwell.empty()) return linear;
  constexpr int kPoints = 400;
  std::vector<TestPoint> ramp;  // its stretch is the time
  for (int i = 1; i <= kPoints; ++i) {
    const double t = problem.test_time * (i - 0.5) / kPoints;
    ramp.push_back({t, 1.0, t * mean_share(tissue, t)});
  }
  const LinearFit fit = fit_terms(
      ramp, [](const TestPoint& p) { return p.stretch; }, [](const TestPoint&) { return 1.0; });
  LameParameters lame = tissue.lame();
  const double bulk = lame.lambda + 2.0 / 3.0 * lame.mu, mu = lame.mu * fit.factors[0];
  const bool all = tissue.maxwell_part == MaxwellPart::all;
  linear = linear_tissue(tissue, {(all ? bulk * fit.factors[0] : bulk) - 2.0 / 3.0 * mu, mu});
  linear.viscosity = tissue.viscosity + lame.mu * fit.factors[1];
  linear.viscous_tensor = ViscousTensor::deviatoric;
  return linear;
}

}  // namespace

Answer kelvin_voigt(const Problem& problem, const Effort&, const Stop& stop) {
  if (!is_viscous(problem)) return without_viscosity("linear_tensor_mass");
  return run_engine(problem, changed(problem, [&](Tissue& t) { t = with_dashpot(problem, t); }),
                    {.integrator = Integrator::semi_implicit}, stop);
}

Answer linear_maxwell(const Problem& problem, const Effort&, const Stop& stop) {
  if (!is_viscous(problem)) return without_viscosity("linear_tensor_mass");
  const auto with_branches = [](Tissue& t) {
    Tissue linear = linear_tissue(t, t.lame());
    if (t.viscous_tensor != ViscousTensor::pioletti) {
      linear.viscosity = t.viscosity;
      linear.viscous_tensor = t.viscous_tensor;
    }
    linear.maxwell = t.maxwell;
    for (MaxwellBranch& branch : linear.maxwell) branch.time_law.reset();
    linear.maxwell_part = t.maxwell_part;
    t = linear;
  };
  return run_engine(problem, changed(problem, with_branches), {.integrator = Integrator::semi_implicit}, stop);
}

}  // namespace glisson::models
