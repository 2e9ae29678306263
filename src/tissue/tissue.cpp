// tissue.cpp — conversion of moduli and the refusal of tissues that mean nothing.
#include "glisson/tissue.h"

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

}  // namespace

LameParameters lame_from_young(double youngs_modulus, double poisson_ratio) {
  const double E = youngs_modulus, nu = poisson_ratio;
  return {E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), E / (2.0 * (1.0 + nu))};
}

void require_valid(const Tissue& t) {
  const auto positive = [](double v) { return v > 0.0 && std::isfinite(v); };
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
