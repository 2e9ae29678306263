// stiffness_law.h — the one list of laws that a modulus can follow.
//
// A law is one file under laws/ with `kName`, `kHelp`, `kFields` (its parameters: the scene's schema, its
// documentation and its error messages come from there), `value`, `derivative` and, where the parameters
// can contradict each other, `check`. Adding a law: write that file, add the type to the list below
// (docs/adding_a_law.md).
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
inline double law_value(const StiffnessLaw& law, double base, double x) {
  return std::visit([&](const auto& l) { return static_cast<double>(l.value(base, x)); }, law);
}

/// d(modulus)/dx [Pa].
inline double law_derivative(const StiffnessLaw& law, double base, double x) {
  return std::visit([&](const auto& l) { return static_cast<double>(l.derivative(base, x)); }, law);
}

inline std::string_view law_name(const StiffnessLaw& law) {
  return std::visit([](const auto& l) { return l.kName; }, law);
}

}  // namespace glisson
