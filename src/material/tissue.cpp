// tissue.cpp — conversion of moduli and the refusal of tissues that mean nothing.
#include "glisson/material/tissue.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace glisson {
namespace {

[[noreturn]] void refuse(const Tissue& tissue, std::string_view field, double value, std::string_view range) {
  std::ostringstream text;
  text << "tissue \"" << tissue.name << "\": " << field << " = " << value << " is outside the allowed range, " << range;
  throw std::invalid_argument(text.str());
}

void require_law(const Tissue& tissue, std::string_view field, const StiffnessLaw& law) {
  const std::string problem = std::visit([](const auto& l) { return l.check(); }, law);
  if (problem.empty()) return;
  throw std::invalid_argument("tissue \"" + tissue.name + "\": " + std::string(field) + " (" +
                              std::string(law_name(law)) + "): " + problem);
}

/// A hyperelastic law stands in the place of the stiffness laws; it cannot have them beside it.
void require_hyperelastic(const Tissue& t) {
  if (!t.hyperelastic) {
    if (t.volume_change == VolumeChange::nodal && t.law_form == LawForm::energy) {
      throw std::invalid_argument(
          "tissue \"" + t.name +
          "\": volume_change nodal and law_form energy exclude each other: a law of the element has no energy in "
          "averaged volumes; take law_form secant or volume_change own");
    }
    return;
  }
  const std::string problem = std::visit([](const auto& l) { return l.check(); }, *t.hyperelastic);
  const std::string where =
      "tissue \"" + t.name + "\": hyperelastic (" + std::string(law_name(*t.hyperelastic)) + "): ";
  if (!problem.empty()) throw std::invalid_argument(where + problem);
  const double mu = shear_modulus(*t.hyperelastic), bulk = bulk_modulus(*t.hyperelastic);
  if (!(mu > 0.0 && std::isfinite(mu))) refuse(t, "hyperelastic shear modulus [Pa]", mu, "> 0 and finite");
  if (!(bulk > 0.0 && std::isfinite(bulk))) refuse(t, "hyperelastic bulk_modulus [Pa]", bulk, "> 0 and finite");
  const bool lawless = std::holds_alternative<ConstantLaw>(t.law) && !t.lambda_law && !t.mu_law;
  if (!lawless)
    throw std::invalid_argument(where + "it cannot be combined with a stiffness law; give one or the other");
}

void require_kinematics(const Tissue& t) {
  if (t.viscous_tensor == ViscousTensor::pioletti && !t.hyperelastic && t.kinematics == Kinematics::small) {
    throw std::invalid_argument(
        "tissue \"" + t.name + "\": viscous_tensor pioletti is a law of large strain and has no " +
        "meaning with kinematics small; take kinematics green or corotational, or a hyperelastic law");
  }
}

void require_fibres(const Tissue& t) {
  if (!t.fibres) return;
  const double c = t.fibres->stiffness, length = norm(t.fibres->direction);
  if (!(c >= 0.0 && std::isfinite(c))) refuse(t, "fibres stiffness [Pa]", c, ">= 0 and finite");
  if (!(length > 0.0 && std::isfinite(length))) refuse(t, "fibres |direction|", length, "> 0 and finite");
}

void require_maxwell(const Tissue& t) {
  constexpr std::size_t kMostBranches = 8;
  if (t.maxwell.size() > kMostBranches) {
    refuse(t, "maxwell branches", static_cast<double>(t.maxwell.size()), "at most 8");
  }
  double sum = 0.0;
  for (const MaxwellBranch& b : t.maxwell) {
    if (!(b.share > 0.0 && b.share < 1.0)) refuse(t, "maxwell share", b.share, "> 0 and < 1");
    if (!(b.time > 0.0 && std::isfinite(b.time))) refuse(t, "maxwell time [s]", b.time, "> 0 and finite");
    sum += b.share;
  }
  if (!(sum < 1.0)) {
    refuse(t, "sum of maxwell shares", sum, "< 1: what is left over is the modulus after long times");
  }
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
  const bool paper = kinematics == Kinematics::small && law_form == LawForm::secant && !hyperelastic &&
                     viscous_tensor != ViscousTensor::pioletti;
  return paper && !fibres && maxwell.empty() && volume_change == VolumeChange::own;
}

void require_valid(const Tissue& t) {
  const auto positive = [](double v) { return v > 0.0 && std::isfinite(v); };
  require_hyperelastic(t);
  require_kinematics(t);
  require_fibres(t);
  require_maxwell(t);
  if (!positive(t.youngs_modulus)) refuse(t, "youngs_modulus [Pa]", t.youngs_modulus, "> 0 and finite");
  if (!(t.poisson_ratio > -1.0 && t.poisson_ratio < 0.5)) {
    refuse(t, "poisson_ratio", t.poisson_ratio,
           "-1 < nu < 0.5 (at 0.5 lambda is infinite; nearly incompressible tissue: 0.45 to 0.499)");
  }
  if (!positive(t.density)) refuse(t, "density [kg/m^3]", t.density, "> 0 and finite");
  if (!(t.viscosity >= 0.0 && std::isfinite(t.viscosity)))
    refuse(t, "viscosity [Pa s]", t.viscosity, ">= 0 and finite");
  require_law(t, "law", t.law);
  if (t.lambda_law) require_law(t, "lambda_law", *t.lambda_law);
  if (t.mu_law) require_law(t, "mu_law", *t.mu_law);
  if ((t.lambda_law || t.mu_law) && !std::holds_alternative<ConstantLaw>(t.law)) {
    throw std::invalid_argument(
        "tissue \"" + t.name + "\": a law on E and a law on lambda or mu contradict each other; give one or the other");
  }
}

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
