#include "fit/laws/next_experiments.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "fit/forward/offset_model.h"
#include "fit/uncertainty/design.h"

namespace glisson::fit {
namespace {

constexpr int kPoints = 60;
constexpr double kDeepestStrain = 0.85;  // of a specimen's height

double largest_displacement(const std::vector<Curve>& curves) {
  double most = 0.0;
  for (const Curve& c : curves) most = std::max(most, *std::max_element(c.displacement.begin(), c.displacement.end()));
  return most;
}

std::string named(const char* what, double velocity, double depth) {
  char text[96];
  std::snprintf(text, sizeof text, "%s: %.3g mm/s to %.3g mm", what, 1e3 * velocity, 1e3 * depth);
  return text;
}

/// Keys of single curves mean nothing to a test that is not made yet: it has the common ones.
bool common_keys_only(const LawSpec& law) {
  return std::none_of(law.parameters.begin(), law.parameters.end(), [](const ParameterSpec& p) {
    return is_curve_key(p.key) && p.key != "curve.contact_mm" && p.key != "curve.force_offset_N";
  });
}

/// Width of the 95 % interval about z with a deviation in z, in the parameter's unit and within its bounds.
double width_of(const Problem& problem, const std::vector<double>& z, std::size_t p, double half) {
  std::vector<double> low = z, high = z;
  low[p] = std::isfinite(half) ? std::max(0.0, z[p] - half) : 0.0;
  high[p] = std::isfinite(half) ? std::min(1.0, z[p] + half) : 1.0;
  return problem.to_values(high)[p] - problem.to_values(low)[p];
}

}  // namespace

Curve planned_curve(const ExperimentSpec& experiment) {
  Curve curve;
  curve.name = curve.group = experiment.name;
  curve.velocity = experiment.velocity;
  curve.held_out = true;
  const double rise = experiment.depth / experiment.velocity, end = rise + experiment.hold.value_or(0.0);
  for (int i = 0; i <= kPoints; ++i) {
    const double t = end * i / kPoints;
    curve.time.push_back(t);
    curve.displacement.push_back(std::min(experiment.depth, experiment.velocity * t));
    curve.force.push_back(0.0);
  }
  return curve;
}

std::vector<ExperimentSpec> usual_experiments(const std::vector<Curve>& fitted, double deepest) {
  const double depth = largest_displacement(fitted);
  double velocity = 0.0;
  for (const Curve& c : fitted) velocity = std::max(velocity, c.velocity);
  if (!(velocity > 0.0) || !(depth > 0.0)) return {};
  std::vector<ExperimentSpec> list;
  const auto add = [&](const char* what, double v, double d, std::optional<double> hold = {}) {
    if (d <= deepest) list.push_back({named(what, v, d), v, d, hold});
  };
  add("the same once more", velocity, depth);
  add("slower", 0.3 * velocity, depth);
  add("faster", 3.0 * velocity, depth);
  add("much faster", 10.0 * velocity, depth);
  add("shallower", velocity, 0.6 * depth);
  add("deeper", velocity, 1.25 * depth);
  add("held at depth", velocity, depth, 4.0 * depth / velocity);
  return list;
}

std::vector<DesignResult> next_experiments(const LawSearch& search, const FitSpec& spec, const Covariance& covariance) {
  const Problem& problem = search.problem();
  if (!covariance.failure.empty() || !common_keys_only(search.law())) return {};
  const bool presses = std::all_of(problem.curves().begin(), problem.curves().end(),
                                   [](const Curve& c) { return c.measurement.is_press(); });
  if (!presses) return {};  // the usual next tests are presses
  const double deepest =
      spec.specimen ? kDeepestStrain * spec.specimen->height : std::numeric_limits<double>::infinity();
  const std::vector<ExperimentSpec> experiments =
      spec.experiments.empty() ? usual_experiments(problem.curves(), deepest) : spec.experiments;
  if (experiments.empty()) return {};
  std::vector<Candidate> candidates;
  std::vector<Curve> plans;
  for (const ExperimentSpec& e : experiments) {
    plans.push_back(planned_curve(e));
    candidates.push_back({e.name, plans.back(), plans.size() - 1, 0.0});
  }
  const std::shared_ptr<const Model> model = search.model_of(plans);
  std::vector<DesignResult> results;
  for (const Design& d : rank_designs(problem, covariance, candidates, *model)) {
    if (!d.failure.empty()) continue;
    const std::size_t p = d.widest;
    const std::vector<double>& z = covariance.scaled;
    DesignResult out{candidates[d.candidate].what, problem.parameters()[p].name, 0.0, 0.0};
    out.width_now = width_of(problem, z, p, covariance.quantile * covariance.sd[p]);
    out.width_after = width_of(problem, z, p, covariance.quantile * d.of[p].sd_after);
    results.push_back(std::move(out));
  }
  return results;
}

}  // namespace glisson::fit
