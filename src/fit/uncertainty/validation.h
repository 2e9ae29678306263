// validation.h — the error of a fit on each curve, beside what repetitions of one test differ among themselves.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "fit/model/model.h"
#include "glisson/fit.h"

namespace glisson::fit {

struct CurveError {
  std::string name, group;
  bool held_out = false;
  std::size_t samples = 0;
  double rms = 0.0;     ///< [N]
  double mean = 0.0;    ///< of model − measured [N]
  std::string failure;  ///< why the curve could not be predicted; empty: it was
};

/// How repetitions of one test differ, at the same displacements while loading.
struct Spread {
  std::size_t curves = 0;        ///< that were compared; fewer than two: the rest is 0
  double low = 0.0, high = 0.0;  ///< displacements at which all have data [m]
  double about_mean = 0.0;       ///< rms of the curves about their pointwise mean [N]
  double deviation =
      0.0;  ///< standard deviation, about_mean √(n / (n − 1)) [N]: what a repetition differs from the true mean
};

struct GroupError {
  std::string name;
  double rms_fit = 0.0, rms_heldout = 0.0;  ///< [N]; NaN where there is no such curve
  Spread spread;
  /// Held-out error at or below the spread's deviation: no law can do better than the repetitions allow.
  bool within_spread = false;
};

struct Validation {
  std::vector<CurveError> curves;
  std::vector<GroupError> groups;           ///< in the order of their first curve
  double rms_fit = 0.0, rms_heldout = 0.0;  ///< [N] over all samples; NaN where there is none
};

/// rms = √(Σ (F_model − F)² / n) per curve, group and set; groups beside their spread.
/// @param predictions  one for each curve @param displacement_limit  samples beyond it are left out [m]
/// @throws std::invalid_argument  as many predictions as curves are needed
Validation validate(std::span<const Curve> curves, std::span<const Prediction> predictions,
                    double displacement_limit = std::numeric_limits<double>::infinity());

/// Spread of repetitions on 200 displacements common to all, by linear interpolation of each curve's loading: the samples up
/// to its largest displacement that go further than all before.
Spread spread_of(std::span<const Curve* const> repetitions,
                 double displacement_limit = std::numeric_limits<double>::infinity());

}  // namespace glisson::fit
