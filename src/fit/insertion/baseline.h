// baseline.h — how near curves without any mechanics come to the same points: what a body's fit is to be held against.
#pragma once

#include <span>

namespace glisson::fit {

struct Baseline {
  double exponential = 0.0;  ///< rms of a + b exp(c x) [N]
  double parabola = 0.0;     ///< rms of a + b x + c x² [N]
};

/// Least squares of both, three numbers each. @param x, y  of four points at least
Baseline baseline_of(std::span<const double> x, std::span<const double> y);

}  // namespace glisson::fit
