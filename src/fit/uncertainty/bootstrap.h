// bootstrap.h — how the optimum scatters when the curves are drawn again: no formula for the noise, only the curves.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fit/search/problem.h"
#include "fit/uncertainty/covariance.h"
#include "glisson/fit.h"

namespace glisson::fit {

struct BootstrapOptions {
  int replicates = 200;
  std::uint64_t seed = 1;
  int most_iterations = 15;  ///< of each refit, which starts at the optimum
  double level = 0.95;
  const std::atomic<bool>* stop = nullptr;
};

struct Bootstrap {
  int asked = 0;
  int failed = 0;      ///< a forward run failed
  int unfinished = 0;  ///< refits that had not converged when their iterations were spent; they count
  bool stopped = false;
  std::vector<std::vector<double>> scaled;  ///< z of each refit that is there, in the order of its number
  std::vector<double> sd;                   ///< of z
  std::vector<Interval> interval;           ///< widened percentiles, own units; an end at the parameter's bound is open
  std::vector<std::string> notes;           ///< for each group, how it was drawn
  double widening = 1.0;                    ///< t / 1.96
  std::uint64_t forward_runs = 0;
};

/// Refits to curves drawn anew, group by group. [EfronTibshirani1993]
///
///   three repetitions or more: n − 1 of n drawn with replacement, each weighing n / (n − 1), which leaves the variance of n
///   repetitions unbiased [RaoWu1988]; n of n would be √((n − 1) / n) short of it
///   fewer: the optimum's force and residuals drawn in circular blocks of three correlation times [Kunsch1989]
///   [PolitisRomano1992], about their mean and √(N_eff / (N_eff − p)) larger
///
/// Percentiles of few curves are too narrow, as normal quantiles are in place of Student's: they are moved away from the
/// median by t / 1.96, with n − 1 degrees of freedom for each group of repetitions and N_eff for a group drawn in blocks,
/// the expansion of [Hesterberg2015] by width instead of by level, which 200 refits would not resolve.
///
/// Refits go in parallel; each has its own random numbers, from seed and number, so that any number of threads gives the same
/// bytes. With `stop` those not begun are left out.
/// @param optimum  z @param covariance  at the optimum, for the correlation times
Bootstrap bootstrap(const Problem& problem, std::span<const double> optimum, const Covariance& covariance,
                    const BootstrapOptions& options = {});

}  // namespace glisson::fit
