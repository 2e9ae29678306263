// multi_start.h — is it the optimum? Descents from quasi-random starts, until the best basin has been found often enough.
//
//   Sobol points ─▶ screened: the best of `screen` points is a start ─▶ descents, side by side ─▶ basins
//                                                                       stop: best basin found `found_again` times
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "fit/search/least_squares.h"

namespace glisson::fit {

struct MultiStartOptions {
  int starts = 20;         ///< most descents, ≥ 1
  int found_again = 0;     ///< stops when the best basin has been found so often; 0: makes all starts
  int screen = 4;          ///< points of the sequence looked at for each start, ≥ 1
  std::uint64_t seed = 1;  ///< moves the sequence
  DescentOptions descent{};
};

/// One descent: where from and where to.
struct StartRecord {
  std::vector<double> from;  ///< z
  Optimum optimum;
};

/// Optima that are one and the same to the fit's accuracy.
struct Basin {
  std::vector<double> scaled;  ///< of its best descent
  double cost = 0.0;
  int found = 0;  ///< by how many descents
};

struct MultiStart {
  std::vector<StartRecord> starts;  ///< in the order of the sequence
  std::vector<Basin> basins;        ///< the best first; empty where every start failed
  bool complete = false;            ///< false: interrupted
};

/// Optima fall together whose costs differ by less than 1e-3 of the cost and whose parameters by less than 0.02 in z, or
/// whose costs are the same to 1e-6 and between which the cost stays so (a flat valley: the same optimum, not identifiable).
std::vector<Basin> basins_of(const Problem& problem, const std::vector<StartRecord>& starts);

/// The first start is the user's own. The starts of a batch of four run side by side, and the rule to stop is asked after
/// each batch, so the result does not depend on the number of threads.
/// @param known  records of an earlier run, which are not made again @param told  after each batch, with all so far
MultiStart find_optimum(const Problem& problem, const MultiStartOptions& options, std::vector<StartRecord> known = {},
                        const std::function<void(const MultiStart&)>& told = {});

}  // namespace glisson::fit
