// step.h — the paper's tissue 1: the modulus steps up where the deformation crosses a threshold.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <string_view>

#include "glisson/material/stiffness/law_field.h"

namespace glisson {

/// M(x) = M₀ below the threshold and M₁ above it, joined over `width` by the cubic 3t² − 2t³ so that the
/// law can be differentiated; width 0 is the sharp step of [Schwartz2002, fig. 2], tissue 1.
struct StepLaw {
  double threshold = 0.1;  ///< middle of the step, in units of the measure [-]
  double above = 7200.0;   ///< M₁ [Pa], ≥ 0
  double width = 0.0;      ///< length of the smooth passage, in units of the measure [-], ≥ 0

  static constexpr std::string_view kName = "step";
  static constexpr std::string_view kHelp =
      "M(x) = M₀ below the threshold, `above_Pa` above it, joined smoothly over `width`: tissue 1 of the paper";
  static constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  static constexpr std::array<LawField<StepLaw>, 3> kFields{
      {{.key = "threshold",
        .member = &StepLaw::threshold,
        .unit = "-",
        .min = 0.0,
        .max = kUnbounded,
        .help = "argument at the middle of the step"},
       {.key = "above_Pa",
        .member = &StepLaw::above,
        .unit = "Pa",
        .min = 0.0,
        .max = kUnbounded,
        .help = "modulus above the threshold"},
       {.key = "width",
        .member = &StepLaw::width,
        .unit = "-",
        .min = 0.0,
        .max = kUnbounded,
        .required = false,
        .help = "length of the smooth passage; 0 is a sharp step"}}};

  template <class T>
  T value(T base, T x) const {
    const T t = passage(x);
    return base + (T(above) - base) * t * t * (T(3) - T(2) * t);
  }
  template <class T>
  T derivative(T base, T x) const {
    if (width <= 0.0) return T(0);
    const T t = passage(x);
    return (T(above) - base) * T(6) * t * (T(1) - t) / T(width);
  }
  std::string check() const { return {}; }

  bool operator==(const StepLaw&) const = default;

 private:
  /// 0 before the passage, 1 after it.
  template <class T>
  T passage(T x) const {
    if (width <= 0.0) return x < T(threshold) ? T(0) : T(1);
    const T t = (x - T(threshold)) / T(width) + T(0.5);
    return t < T(0) ? T(0) : (t > T(1) ? T(1) : t);
  }
};

}  // namespace glisson
