// design.h — which experiment to make next: the one after which the least known parameter would be known best.
//
// What a curve tells adds up (JᵀJ over its variance). A candidate is simulated at the optimum, its J joins that of the curves
// that are there, and the covariance of both is what the next fit is expected to have.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fit/search/problem.h"
#include "fit/uncertainty/covariance.h"

namespace glisson::fit {

struct Candidate {
  std::string what;             ///< for tables, e.g. "10 mm/s to 12 mm"
  Curve plan;                   ///< time and displacement of the experiment; its force is not looked at
  std::size_t model_index = 0;  ///< of the model that predicts candidates
  double noise = 0.0;           ///< [N]; 0: that of the fit, in the same newtons
};

struct WidthForecast {
  bool determined_now = false, determined_after = false;
  /// Relative width of the 95 % interval: high / low − 1 where the scale is logarithmic or the bounds have one sign, else
  /// over the bounds' range. Open ends count at the bounds.
  double now = 0.0, after = 0.0;
  double sd_after = 0.0;  ///< in z; infinite where not determined
};

struct Design {
  std::size_t candidate = 0;                  ///< place in the list given
  std::string failure;                        ///< why it cannot be judged: the simulation failed; such come last
  std::vector<WidthForecast> of;              ///< one for each parameter
  std::size_t widest = 0;                     ///< parameter whose interval is widest now
  double width_now = 0.0, width_after = 0.0;  ///< of that one
  std::string words;
};

/// Forecasts for each candidate, ranked by what it leaves of the interval that is widest now; then by the sum of all widths.
///
///   C_after = (JᵀJ / σ² + JₖᵀJₖ / σₖ²)⁻¹, times the inflation of the covariance that is used now; to first order, so that
///   an optimum far off misleads it [SeberWild1989]
///
/// @param model  predicts the candidates, by their model_index, with the problem's parameters
std::vector<Design> rank_designs(const Problem& problem, const Covariance& covariance,
                                 std::span<const Candidate> candidates, const Model& model);

}  // namespace glisson::fit
