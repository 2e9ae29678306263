// fit_curves.h — all curves of a fit, and how they are weighed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fit/spec/fit_spec.h"
#include "fit/uncertainty/validation.h"
#include "glisson/fit.h"

namespace glisson::fit {

struct FitCurves {
  std::vector<Curve> curves;          ///< fitted and held out, in the order of the file
  std::vector<std::string> accounts;  ///< what was done to each
  std::vector<std::string> skipped;   ///< of each that lost rows how many, in a sentence

  /// Numbers of the curves that are fitted, or held out.
  std::vector<std::size_t> indices(bool held_out) const;
  std::vector<Curve> chosen(const std::vector<std::size_t>& indices) const;
};

/// Reads the curves of all [[data]]; their names are unique. @param base  folder of relative files @throws SceneError
FitCurves read_curves(const FitSpec& spec, const SpecimenSize& size, const std::filesystem::path& base);

/// The standard deviation that the residuals of each curve are measured in [N]. Where a curve's noise is not known, or is
/// less than a thousandth of its largest force, that thousandth stands for it; not where it is given.
std::vector<double> spreads_of(const std::vector<Curve>& curves, Weighing how);

/// The errors of all curves in their common_unit (curve_kinds.h).
Validation errors_in_common_unit(const std::vector<Curve>& curves, std::vector<Prediction> predictions);

/// Young's modulus by the first tenth of the curves [Pa], for bounds; needs the specimen's size.
double initial_modulus(const std::vector<Curve>& curves, double area, double height);

}  // namespace glisson::fit
