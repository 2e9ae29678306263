// stiffness_law.h — the one list of laws that a modulus can follow.
//
// A law is one file under stiffness/ with `kName`, `kHelp`, `fields` (its parameters: the scene's schema, its
// documentation, its error messages and its class in Python come from there), where parameters may contradict each other a
// `check`, and
//   numbers(base)   the coefficients of its formula, in double, for the modulus `base` at rest
//   at(numbers, x)  M and dM/dx at measure x: a double, a number with a derivative, or a vector of lanes
// The formula itself is in src/material/stiffness_formulas.h. Adding a law: write that file and the formula, add the type to
// the list below (docs/adding_a_law.md).
#pragma once

#include <string_view>
#include <variant>

#include "glisson/material/stiffness/constant.h"
#include "glisson/material/stiffness/exponential.h"
#include "glisson/material/stiffness/linear.h"
#include "glisson/material/stiffness/polynomial.h"
#include "glisson/material/stiffness/step.h"
#include "glisson/material/stiffness/table.h"

namespace glisson {

using StiffnessLaw = std::variant<ConstantLaw, StepLaw, LinearLaw, PolynomialLaw, ExponentialLaw, TableLaw>;

/// The modulus at measure `x` for the modulus `base` at rest [Pa].
double law_value(const StiffnessLaw& law, double base, double x);

/// d(modulus)/dx [Pa].
double law_derivative(const StiffnessLaw& law, double base, double x);

inline std::string_view law_name(const StiffnessLaw& law) {
  return std::visit([](const auto& l) { return l.kName; }, law);
}

}  // namespace glisson
