#include "fit/uncertainty/left_out.h"

#include <cmath>
#include <limits>

#include "fit/model/curve_kinds.h"

namespace glisson::fit {
namespace {

constexpr std::size_t kFewestToLeaveOne = 3;

}  // namespace

std::vector<double> left_out_errors(const Problem& problem, const Optimum& optimum, const DescentOptions& options) {
  std::vector<double> errors;
  const std::size_t curves = problem.curves().size();
  const std::string unit = common_unit(problem.curves());
  for (std::size_t out = 0; curves >= kFewestToLeaveOne && out < curves; ++out) {
    if (options.stop != nullptr && options.stop->load()) return {};
    std::vector<std::size_t> others;
    std::vector<Curve> fitted;
    for (std::size_t c = 0; c < curves; ++c) {
      if (c != out) others.push_back(c), fitted.push_back(problem.curves()[c]);
    }
    const Optimum there = descend(*problem.with(std::move(fitted), others), optimum.scaled, options);
    const Prediction seen = problem.model().predict(problem.model_index(out), problem.to_values(there.scaled));
    const std::vector<double>& measured = problem.curves()[out].force;
    const double size = size_in(unit, problem.curves()[out]);
    double squares = seen.force.size() == measured.size() ? 0.0 : std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < measured.size() && std::isfinite(squares); ++i)
      squares += (seen.force[i] - measured[i]) * (seen.force[i] - measured[i]);
    errors.push_back(size * std::sqrt(squares / static_cast<double>(measured.size())));
  }
  return errors;
}

}  // namespace glisson::fit
