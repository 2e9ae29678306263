// tissue.cpp — conversion of moduli and the refusal of tissues that mean nothing.
#include "glisson/material/tissue.h"

#include <algorithm>
#include <cmath>

#include "base/require_fields.h"
#include "base/text.h"
#include "material/branch_weights.h"
#include "material/stiffness_formulas.h"
#include "material/time_formulas.h"

namespace glisson {
namespace {

/// What must not stand beside a hyperelastic law, which takes the place of the stiffness laws, and what needs one.
Fault check_laws(const Tissue& t) {
  if (t.hyperelastic) {
    if (t.has_constant_moduli()) return {};
    return {"it cannot be combined with a stiffness law; give one or the other", "hyperelastic"};
  }
  if ((t.lambda_law || t.mu_law) && !std::holds_alternative<ConstantLaw>(t.law))
    return {"a law of E and one of λ or μ contradict each other; give one or the other", "law"};
  if (t.volume_change == VolumeChange::average_nodal && t.law_form == LawForm::energy) {
    return {
        "\"average_nodal\" and law_form \"energy\" exclude each other: a law of the element has no energy in averaged "
        "volumes; "
        "set law_form to \"secant\" or volume_change to \"element\"",
        "volume_change"};
  }
  if (t.viscous_tensor == ViscousTensor::pioletti && t.kinematics == Kinematics::small) {
    return {
        "\"pioletti\" is a law of large strain; set `kinematics` to \"green\" or \"corotational\" or give a "
        "`hyperelastic` law",
        "viscous_tensor"};
  }
  return {};
}

}  // namespace

LameParameters lame_from_young(double youngs_modulus, double poisson_ratio) {
  const double E = youngs_modulus, nu = poisson_ratio;
  return {E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), E / (2.0 * (1.0 + nu))};
}

LameParameters Tissue::lame() const {
  if (!hyperelastic) return lame_from_young(youngs_modulus, poisson_ratio);
  const double mu = shear_modulus(*hyperelastic);
  return {bulk_modulus(*hyperelastic) - 2.0 / 3.0 * mu, mu};
}

bool Tissue::is_tensor_mass() const {
  if (measure == DeformationMeasure::radius_ratio || measure == DeformationMeasure::solid_angle) return false;
  const bool paper = has_small_strain() && law_form == LawForm::secant && viscous_tensor != ViscousTensor::pioletti;
  return paper && !fibres && maxwell.empty() && volume_change == VolumeChange::element;
}

bool Tissue::relaxation_follows() const {
  return std::any_of(maxwell.begin(), maxwell.end(), [](const MaxwellBranch& b) { return b.time_law.has_value(); });
}

Fault Tissue::check() const {
  if (maxwell.size() > kMostBranches)
    return {std::to_string(maxwell.size()) + " branches; allowed: at most " + std::to_string(kMostBranches), "maxwell"};
  double sum = 0.0;
  for (const MaxwellBranch& b : maxwell) sum += b.share;
  if (!(sum < 1.0)) {
    return {
        "the shares sum up to " + detail::show(sum) + "; allowed: below 1, the rest is the modulus after long times",
        "maxwell"};
  }
  return check_laws(*this);
}

void require_valid(const Tissue& t) { detail::require_fields("tissue \"" + t.name + "\"", t); }

double time_factor(const TimeLaw& law, double x) {
  return std::exp(std::visit([x](const auto& l) { return l.at(l.numbers(), x).value; }, law));
}

double law_value(const StiffnessLaw& law, double base, double x) { return law_at(law, base, x).value; }
double law_derivative(const StiffnessLaw& law, double base, double x) { return law_at(law, base, x).slope; }

LameParameters lame_at(const Tissue& tissue, double x) {
  const LameParameters rest = tissue.lame();
  if (tissue.lambda_law || tissue.mu_law) {
    return {tissue.lambda_law ? law_value(*tissue.lambda_law, rest.lambda, x) : rest.lambda,
            tissue.mu_law ? law_value(*tissue.mu_law, rest.mu, x) : rest.mu};
  }
  const double f = law_value(tissue.law, tissue.youngs_modulus, x) / tissue.youngs_modulus;
  return {f * rest.lambda, f * rest.mu};
}

}  // namespace glisson
