// stiffness_law.h — the one list of laws that a modulus can follow.
//
// A law is one file under stiffness/ with `kName`, `kHelp`, `fields` (its parameters: the scene's schema, its
// documentation, its error messages and its class in Python come from there), where parameters may contradict each other a
// `check`, and its formula, written once in the words of scalar.h:
//   numbers(base)   what the formula reads, worked out in double for the modulus `base` at rest
//   at(numbers, x)  M and dM/dx at measure x: a double, a number with a derivative, or a vector of lanes
// Adding a law: write that file, add the type to the list below (docs/adding_a_law.md).
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

/// The modulus and its slope at measure `x` for the modulus `base` at rest [Pa].
template <class T>
ValueSlope<T> law_at(const StiffnessLaw& law, double base, T x) {
  return std::visit([&](const auto& l) { return l.at(l.numbers(base), x); }, law);
}

/// The modulus at measure `x` for the modulus `base` at rest [Pa].
inline double law_value(const StiffnessLaw& law, double base, double x) { return law_at(law, base, x).value; }

/// d(modulus)/dx [Pa].
inline double law_derivative(const StiffnessLaw& law, double base, double x) { return law_at(law, base, x).slope; }

inline std::string_view law_name(const StiffnessLaw& law) {
  return std::visit([](const auto& l) { return l.kName; }, law);
}

}  // namespace glisson
