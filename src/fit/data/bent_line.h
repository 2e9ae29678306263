// bent_line.h — a line that bends into a parabola: what a force does before and after contact.
//
//      F = b + s (x − x_c)                                x < x_c      s: slope of the baseline, 0 where it rests
//      F = b + s (x − x_c) + k₁ (x − x_c) + k₂ (x − x_c)²   x ≥ x_c,     k₁ ≥ 0
#pragma once

#include <cstddef>
#include <span>

namespace glisson::fit {

/// Least squares in b, s, k₁, k₂ for every x_c; the x_c of the least sum of squares.
struct BentLine {
  double touch = 0.0;            ///< x_c
  double deviation = 0.0;        ///< of it: where the sum of squares is one variance more
  double level = 0.0;            ///< b, the baseline at the touch
  double slope = 0.0;            ///< s
  double slope_deviation = 0.0;  ///< standard deviation of s, of noise alone
  double squares = 0.0;          ///< the least sum
  std::size_t before = 0;        ///< rows before the touch
};

/// @param x  rising but for noise @param f  as long, more than five rows @param sloped  whether s is free
BentLine bent_line(std::span<const double> x, std::span<const double> f, bool sloped);

/// By how much more likely the bend makes the rows than a polynomial of as many numbers does, as logarithm: of independent noise
///   n/2 ln(squares of the quartic over those of the bent line)
double evidence_of_bend(std::span<const double> x, std::span<const double> f, const BentLine& bent);

}  // namespace glisson::fit
