#include "glisson/material/linear_law.h"

namespace glisson {

bool has_linear_law(const Tissue& t) {
  const bool linear = t.is_tensor_mass() && t.has_constant_moduli();
  const bool large_with_branches = !t.maxwell.empty() && !t.has_small_strain();
  return !linear && !t.fibres && t.volume_change == VolumeChange::element &&
         t.viscous_tensor != ViscousTensor::pioletti && !t.relaxation_follows() && !large_with_branches;
}

LameParameters relaxed_lame(const Tissue& tissue) {
  const LameParameters at_once = tissue.lame();
  double share = 0.0;
  for (const MaxwellBranch& branch : tissue.maxwell) share += branch.share;
  const double mu = (1.0 - share) * at_once.mu;
  if (tissue.maxwell_part != MaxwellPart::deviator) return {(1.0 - share) * at_once.lambda, mu};
  return {at_once.lambda + 2.0 / 3.0 * (at_once.mu - mu), mu};
}

Tissue linear_law(const Tissue& original) {
  Tissue tissue;
  tissue.name = original.name;
  tissue.density = original.density;
  tissue.viscosity = original.viscosity;
  const auto [lambda, mu] = relaxed_lame(original);
  tissue.youngs_modulus = mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu);
  tissue.poisson_ratio = lambda / (2.0 * (lambda + mu));
  return tissue;
}

}  // namespace glisson
