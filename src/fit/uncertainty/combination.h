// combination.h — which combination of two parameters stays the same while both move: a · b, a / b², a + 3 b.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fit/uncertainty/covariance.h"

namespace glisson::fit {

/// What is fixed of parameters p and q, where they may move along `direction` (z): with its value and half its 95 % interval,
/// e.g. "a · b = 6.02 ± 0.4 %"; where one scale is linear and one logarithmic, what a step of one does in terms of the other.
std::string fixed_combination(const Problem& problem, const Covariance& covariance, std::size_t p, std::size_t q,
                              const std::vector<double>& direction);

/// A number with so many digits that count, and its unit.
std::string number(double value, const std::string& unit = "", int digits = 4);

}  // namespace glisson::fit
