// step.h — the paper's tissue 1: the modulus steps up where the deformation crosses a threshold.
#pragma once

#include <array>
#include <string_view>

#include "glisson/field.h"
#include "glisson/material/scalar.h"

namespace glisson {

/// M(x) = M₀ below the threshold and M₁ above it, joined over `width` by the cubic 3t² − 2t³ so that the
/// law can be differentiated; width 0 is the sharp step of [Schwartz2002, fig. 2], tissue 1.
struct StepLaw {
  double threshold = 0.1;  ///< middle of the step, in units of the measure [-]
  double above = 7200.0;   ///< M₁ [Pa]
  double width = 0.0;      ///< length of the smooth passage, in units of the measure [-]

  static constexpr std::string_view kName = "step";
  static constexpr std::string_view kHelp =
      "M(x) = M₀ below the threshold, `above_Pa` above it, joined smoothly over `width`: tissue 1 of the paper";
  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("threshold", &StepLaw::threshold, "-", at_least(0), "argument at the middle of the step").must(),
                field("above", &StepLaw::above, "Pa", at_least(0), "modulus above the threshold").must(),
                field("width", &StepLaw::width, "-", at_least(0), "length of the smooth passage; 0 is a sharp step"));
  }

  /// M₀, M₁ − M₀, threshold, width
  std::array<double, 4> numbers(double base) const { return {base, above - base, threshold, width}; }
  template <class C, class T>
  static ValueSlope<T> at(const C& numbers, T x);

  bool operator==(const StepLaw&) const = default;
};

}  // namespace glisson
