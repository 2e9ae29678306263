// further_batch.h — where the optimum of a further batch of specimens is to be expected, from the optima of the batches fitted.
//
//   z̄ ± t(B − 1) s √(1 + 1/B)      z_b the optimum of the curves of batch b alone, z̄ and s² their mean and variance, B batches
//
// Specimens of one batch share what made them: the mean over five of them is known better than the next batch meets it.
#pragma once

#include <string>
#include <vector>

#include "fit/search/least_squares.h"
#include "fit/uncertainty/covariance.h"

namespace glisson::fit {

inline constexpr std::size_t kFewestBatches = 3;

struct FurtherBatch {
  std::vector<std::string> batches;  ///< in the order of their first curves
  std::vector<Interval> parameters;  ///< of 95 %, in the parameter's unit; empty: not known
  std::string failure;               ///< a sentence, where a batch alone has no optimum
};

/// Fits each batch by itself from the optimum of all, as many short descents as there are batches. An end is open where it reaches
/// a bound, where a parameter is not determined, and where a batch's own optimum stands at that bound.
/// @param covariance  at the optimum of all @return nothing where fewer than three batches are named
FurtherBatch further_batch(const Problem& problem, const Covariance& covariance, const DescentOptions& options);

}  // namespace glisson::fit
