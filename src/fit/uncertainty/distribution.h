// distribution.h — quantiles and tails of the distributions that intervals and tests rest on. Boost.Math does the work,
// in distribution.cpp alone.
#pragma once

namespace glisson::fit {

/// x with P(T ≤ x) = probability, T of Student's distribution.
/// @param freedom  degrees of freedom, > 0, need not be whole
double student_quantile(double probability, double freedom);

/// P(X > x), X of the χ² distribution.
double chi_squared_tail(double x, double freedom);

}  // namespace glisson::fit
