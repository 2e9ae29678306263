#include "fit/uncertainty/test_table.h"

#include <cmath>
#include <limits>

#include "fit/search/multi_start.h"

namespace glisson::fit {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

bool is_of(const Curve& curve, const TestResult& test) {
  return curve.group == test.name && curve.held_out == test.held_out;
}

/// 1 − Σ (fitted − measured)² / Σ (measured − mean)² over the curves of a test; its rms and points beside it.
void measure(TestResult& test, std::span<const Curve> curves, std::span<const Prediction> predictions) {
  double sum = 0.0, squares = 0.0, left = 0.0;
  test.points = 0;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    if (!is_of(curves[c], test)) continue;
    const bool known = predictions[c].force.size() == curves[c].size();
    for (std::size_t i = 0; i < curves[c].size(); ++i) {
      const double f = curves[c].force[i], off = known ? predictions[c].force[i] - f : kUnknown;
      sum += f, squares += f * f, left += off * off;
    }
    test.points += curves[c].size();
  }
  const auto n = static_cast<double>(test.points);
  const double about_mean = squares - sum * sum / n;
  test.r2 = about_mean > 0.0 ? 1.0 - left / about_mean : kUnknown;
  test.rms = std::sqrt(left / n);
}

}  // namespace

std::vector<TestResult> test_results(std::span<const Curve> curves, std::span<const Prediction> predictions) {
  std::vector<TestResult> tests;
  for (const Curve& c : curves) {
    const auto same = [&](const TestResult& t) { return is_of(c, t); };
    if (std::any_of(tests.begin(), tests.end(), same)) continue;
    TestResult& test = tests.emplace_back();
    test.name = c.group, test.test = c.measurement.test, test.held_out = c.held_out, test.unit = c.measurement.unit;
    measure(test, curves, predictions);
  }
  return tests;
}

void fill_alone(std::vector<TestResult>& tests, std::span<const Curve> curves, const Problem& problem,
                std::span<const double> optimum, int starts, const DescentOptions& how) {
  for (TestResult& t : tests) t.r2_of_alone.assign(tests.size(), kUnknown);
  for (std::size_t alone = 0; alone < tests.size(); ++alone) {
    if (tests[alone].held_out) continue;
    std::vector<std::size_t> origin;
    std::vector<Curve> own;
    for (std::size_t c = 0; c < problem.curves().size(); ++c) {
      if (is_of(problem.curves()[c], tests[alone])) origin.push_back(c), own.push_back(problem.curves()[c]);
    }
    const std::unique_ptr<Problem> part = problem.with(std::move(own), origin);
    MultiStartOptions options;
    options.starts = starts;
    options.descent = how;
    const MultiStart found = find_optimum(*part, options);
    Optimum best = descend(*part, optimum, how);
    if (!found.basins.empty() && found.basins.front().cost < best.cost) best.scaled = found.basins.front().scaled;
    if (how.stop != nullptr && how.stop->load()) return;
    const std::vector<double> values = problem.to_values(best.scaled);
    std::vector<Prediction> predictions;
    for (std::size_t c = 0; c < curves.size(); ++c) predictions.push_back(problem.model().predict(c, values));
    for (TestResult& t : tests) {
      TestResult there = t;
      measure(there, curves, predictions);
      t.r2_of_alone[alone] = there.r2;
    }
  }
}

}  // namespace glisson::fit
