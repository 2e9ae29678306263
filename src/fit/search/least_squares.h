// least_squares.h — the nearest optimum from a start: bounded, robust, on scaled parameters. Ceres does the work.
#pragma once

#include <atomic>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "fit/search/problem.h"

namespace glisson::fit {

struct Optimum {
  std::vector<double> scaled;  ///< z of each parameter
  double cost = 0.0;           ///< ½ Σ ρ(r²)
  bool converged = false;
  int iterations = 0;
  std::string message;  ///< why it ended, in the optimiser's words
};

struct DescentOptions {
  std::vector<char> fixed;  ///< 1: this parameter stays where it starts; empty: all are free
  int most_iterations = 100;
  double tolerance = 1e-10;  ///< relative change of the cost
  bool secant = false;       ///< spares runs of dear models: secant_descent.h in place of Ceres
  const std::atomic<bool>* stop = nullptr;
};

/// Trust-region Levenberg–Marquardt within the bounds, from `start` (z). Never throws for a forward run that fails: such a
/// step is refused, and a start that fails is told in the message with a cost of infinity.
Optimum descend(const Problem& problem, std::span<const double> start, const DescentOptions& options = {});

}  // namespace glisson::fit
