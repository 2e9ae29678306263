// test_table.h — how well a fit meets each kind of test, and how well fits to one kind alone meet the others.
#pragma once

#include <span>
#include <vector>

#include "fit/model/model.h"
#include "fit/search/least_squares.h"
#include "fit/search/problem.h"

namespace glisson::fit {

/// r² and rms of each group, fitted and held out apart, in the order of their first curves.
std::vector<TestResult> test_results(std::span<const Curve> curves, std::span<const Prediction> predictions);

/// TestResult::r2_of_alone by fits to each test that is fitted. @param curves  all of the fit, whose numbers in the model are
/// their places @param starts  of each such fit, besides the optimum of all
void fill_alone(std::vector<TestResult>& tests, std::span<const Curve> curves, const Problem& problem,
                std::span<const double> optimum, int starts, const DescentOptions& how);

}  // namespace glisson::fit
