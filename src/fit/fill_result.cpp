#include "fit/fill_result.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "fit/data/units.h"
#include "fit/laws/next_experiments.h"
#include "fit/model/curve_kinds.h"
#include "fit/uncertainty/bootstrap.h"
#include "fit/uncertainty/covariance.h"
#include "fit/uncertainty/further_batch.h"
#include "fit/uncertainty/further_specimen.h"
#include "fit/uncertainty/local_problem.h"
#include "fit/uncertainty/profile.h"
#include "fit/uncertainty/test_table.h"
#include "fit/uncertainty/validation.h"
#include "fit/uncertainty/verdict.h"

namespace glisson::fit {
namespace {

bool stopped(const FitRun& options) { return options.stop != nullptr && options.stop->load(); }

std::string rounded(double x, int digits = 3) { return brief(x, digits); }

std::optional<double> known(double x) { return std::isfinite(x) ? std::optional(x) : std::nullopt; }

/// In the unit of the errors; of a specimen of known area as a stress, too.
std::string newtons_or_stress(double force, const FitResult& result) {
  if (!result.area || result.unit != "N") return measured_text(force, result.unit);
  return rounded(force) + " N (" + rounded(1e-3 * force / *result.area) + " kPa)";
}

void conclude_on_curves(const Validation& all, const FitResult& result, std::vector<std::string>& sentences) {
  sentences.push_back("The fitted curves are matched to " + newtons_or_stress(result.rms_fit, result) + " rms.");
  for (const GroupError& g : all.groups) {
    if (std::isnan(g.rms_heldout)) continue;
    std::string text = "Held out, " + g.name + " is met to " + newtons_or_stress(g.rms_heldout, result) + " rms";
    if (g.spread.curves >= 2) {
      text += "; its repetitions differ by " + newtons_or_stress(g.spread.deviation, result) +
              (g.within_spread ? ": within the repeatability of the test." : ": beyond the repeatability of the test.");
    } else {
      text += ".";
    }
    sentences.push_back(text);
  }
}

/// How well the law meets each of several tests; presses of one specimen are told by their rms alone.
void conclude_on_tests(const FitResult& result, std::vector<std::string>& sentences) {
  const bool presses = std::all_of(result.curves.begin(), result.curves.end(),
                                   [](const CurveResult& c) { return c.curve.measurement.is_press(); });
  if (result.tests.size() < 2 || presses) return;
  std::string text = "R² is";
  const auto known = [](const TestResult& t) { return std::isfinite(t.r2); };
  if (std::none_of(result.tests.begin(), result.tests.end(), known)) return;
  for (std::size_t t = 0; t < result.tests.size(); ++t)
    if (known(result.tests[t]))
      text += (text.back() == 's' ? " " : ", ") + rounded(result.tests[t].r2) + " in " + result.tests[t].name +
              (result.tests[t].held_out ? " (held out)" : "");
  sentences.push_back(text + ".");
}

/// What single values, such as the width of an isotherm, came to.
void conclude_on_values(const FitResult& result, std::vector<std::string>& sentences) {
  for (const CurveResult& c : result.curves) {
    if (c.curve.size() != 1 || c.fitted.size() != 1) continue;
    const std::string unit = c.curve.measurement.unit == "-" ? "" : " " + c.curve.measurement.unit;
    const double measured = c.curve.force[0], part = measured != 0.0 ? c.fitted[0] / measured - 1.0 : 0.0;
    std::string text = c.curve.name;
    text.append(" is ").append(rounded(c.fitted[0], 4)).append(unit);
    text.append(" where ").append(rounded(measured, 4)).append(unit).append(" was measured");
    if (unit != " °C" && measured != 0.0)
      text.append(" (").append(part < 0.0 ? "" : "+").append(rounded(100.0 * part, 2)).append(" %)");
    sentences.push_back(text.append(c.curve.held_out ? ", held out." : "."));
  }
}

/// The error of held-out curves up to a displacement, beside their spread, over all of them as one test.
std::string limited_errors(const FitCurves& curves, const std::vector<Prediction>& predictions, double limit) {
  const Validation near = validate(curves.curves, predictions, limit);
  if (std::isnan(near.rms_heldout)) return {};
  std::vector<const Curve*> all;
  for (const Curve& c : curves.curves) all.push_back(&c);
  const Spread spread = spread_of(all, limit);
  return "Up to " + rounded(1e3 * limit) + " mm the held-out curves are matched to " + rounded(near.rms_heldout) +
         " N rms; all curves differ there by " + rounded(spread.deviation) + " N.";
}

void conclude_on_search(const LawSearch& search, std::vector<std::string>& sentences) {
  const MultiStart& found = search.found();
  const std::size_t finished = found.starts.size();
  const Basin& best = found.basins.front();
  std::string text =
      "The best optimum was found from " + std::to_string(best.found) + " of " + std::to_string(finished) + " starts";
  int failed = static_cast<int>(finished);
  for (const Basin& b : found.basins) failed -= b.found;
  if (failed > 0) text += ", " + std::to_string(failed) + " of which could not be simulated";
  if (found.basins.size() == 1) {
    text += "; no other was found.";
  } else {
    text += "; the next best of " + std::to_string(found.basins.size() - 1) + " others costs " +
            rounded(found.basins[1].cost / std::max(best.cost, 1e-300)) + " times as much.";
  }
  sentences.push_back(text);
}

std::string derivative_words(const LawSearch& search) {
  const DerivativeCheck& check = search.derivatives();
  const std::string by = "Derivatives by differences of ";
  if (check.step > 0.0)
    return by + rounded(check.step) + " of the bounds' range agree with wider ones to " + rounded(check.error) + ".";
  return by + rounded(search.problem().difference_step) +
         " of the bounds' range were not checked: runs beside the start and beside the optimum failed.";
}

/// Where the optimum of a batch that was not fitted is to be expected, if batches are named.
void fill_further_batch(const LawSearch& search, const Covariance& covariance, FitResult& result) {
  const FurtherBatch further = further_batch(search.problem(), covariance, search.descent());
  if (!further.failure.empty()) result.conclusions.push_back(further.failure);
  if (further.parameters.empty()) return;
  std::string text = "The optimum of a further batch is to be expected (95 %, by the optima of " +
                     std::to_string(further.batches.size()) + " batches) at";
  for (std::size_t p = 0; p < result.parameters.size(); ++p) {
    const Interval& i = further.parameters[p];
    const Parameter& x = result.parameters[p].parameter;
    result.parameters[p].further_batch = i;
    text += (p == 0 ? " " : ", ") + x.name + (i.open() ? " anywhere" : "") +
            (i.low_open ? "" : " from " + rounded(i.low, 4)) + (i.high_open ? "" : " to " + rounded(i.high, 4)) +
            (x.unit.empty() ? "" : " " + x.unit);
  }
  result.conclusions.push_back(text + ".");
}

void conclude_on_parameters(const FitResult& result, std::vector<std::string>& sentences) {
  for (const ParameterResult& p : result.parameters) {
    if (p.verdict != "identified") sentences.push_back(p.words);
  }
}

void conclude_on_designs(const FitResult& result, std::vector<std::string>& sentences) {
  if (result.designs.empty()) return;
  const DesignResult& best = result.designs.front();
  if (!(best.width_after < best.width_now)) return;
  sentences.push_back("Next, " + best.what + " would be most informative: the interval of " + best.parameter +
                      " would shrink to " + rounded(100.0 * best.width_after / best.width_now, 2) + " % of its width.");
}

void fill_parameters(const Problem& problem, const Optimum& optimum, const Covariance& covariance,
                     const Profiles* profiled, FitResult& result) {
  const std::vector<double> values = problem.to_values(optimum.scaled), slopes = problem.value_slopes(optimum.scaled);
  const bool judged = covariance.failure.empty();
  const Verdicts verdicts = judged ? judge(problem, covariance, profiled) : Verdicts{};
  result.parameters.clear();
  for (std::size_t p = 0; p < values.size(); ++p) {
    ParameterResult out;
    out.parameter = problem.parameters()[p];
    out.value = values[p];
    if (covariance.failure.empty()) {
      out.sd = known(covariance.sd[p] * slopes[p]);
      if (out.sd) out.by_curvature = covariance.interval[p];
    }
    if (profiled && p < profiled->of.size() && !profiled->of[p].points.empty())
      out.by_profile = profiled->of[p].interval;
    out.verdict = name_of(judged ? verdicts.of[p].verdict : Verdict::weak);
    out.words = judged ? verdicts.of[p].words : out.parameter.name + ": its uncertainty could not be computed";
    result.parameters.push_back(std::move(out));
  }
  result.correlation.clear();
  const std::size_t n = values.size();
  for (std::size_t p = 0; covariance.failure.empty() && p < n; ++p)
    result.correlation.emplace_back(covariance.correlation.begin() + static_cast<std::ptrdiff_t>(p * n),
                                    covariance.correlation.begin() + static_cast<std::ptrdiff_t>((p + 1) * n));
  for (const std::string& sentence : verdicts.conclusions) result.conclusions.push_back(sentence);
}

void fill_profiles(const Problem& problem, const Profiles& profiled, const Covariance& covariance, double best,
                   FitResult& result) {
  result.profiles.clear();
  for (const Profile& p : profiled.of) {
    ProfileResult out;
    out.parameter = problem.parameters()[p.parameter].name;
    for (const ProfilePoint& point : p.points) {
      out.values.push_back(point.value);
      out.rise.push_back(2.0 * (point.cost - best) / covariance.cost_unit);
    }
    out.threshold = 2.0 * (p.threshold - best) / covariance.cost_unit;
    if (p.flat) out.words = "Flat from " + rounded(p.flat_low) + " to " + rounded(p.flat_high) + ".";
    if (p.interval.low_open) out.words += " Open below.";
    if (p.interval.high_open) out.words += " Open above.";
    result.profiles.push_back(std::move(out));
  }
}

/// How specimens differ, where enough were fitted to tell.
void fill_further(const LawSearch& search, const FitCurves& curves, const Covariance& covariance, FitResult& result) {
  const FurtherSpecimen further(search.problem(), covariance);
  if (!further.known()) return;
  const std::vector<Interval> intervals = further.parameters();
  for (std::size_t p = 0; p < intervals.size(); ++p) result.parameters[p].further = intervals[p];
  std::vector<Curve> all = curves.curves;
  std::vector<std::size_t> indices(all.size());
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  for (Curve& c : all) c.weight = 1.0;
  const std::vector<double> newtons(all.size(), 1.0);
  Problem problem(search.problem().parameters(), std::move(all), std::move(indices), newtons, search.problem().model());
  problem.difference_step = search.problem().difference_step;
  const std::vector<Band> bands = further.bands(problem);
  for (std::size_t c = 0; c < bands.size(); ++c)
    result.curves[c].further_low = bands[c].low, result.curves[c].further_high = bands[c].high;
  const double apart = rms_at(search.problem(), search.optimum().scaled), own = further.left_newtons();
  result.conclusions.push_back("Of the " + newtons_or_stress(apart, result) + " rms between law and fitted curves " +
                               newtons_or_stress(own, result) +
                               " are misfit and noise, which fits to single curves leave too; the rest is how the "
                               "specimens differ.");
}

/// Profiles by runs of the model, or by a cubic in its place where that holds; the cubic is dropped where it does not.
Profiles profiles_of(const LawSearch& search, const Covariance& covariance, const FitRun& options,
                     std::unique_ptr<LocalProblem>& local) {
  ProfileOptions how;
  how.stop = options.stop;
  // a specimen of one tissue costs less than what would stand in for it
  local =
      search.ladder().taken().kind == RungKind::specimen ? nullptr : LocalProblem::about(search.problem(), covariance);
  if (local) {
    Profiles found = profiles(local->problem(), search.optimum(), covariance, how);
    if (stopped(options) || local->holds(found, search.optimum().cost)) return found;
    local.reset();
  }
  if (search.dear()) how.secant = true, how.tolerance = search.descent().tolerance;
  return profiles(search.problem(), search.optimum(), covariance, how);
}

void fill_bootstrap(const Problem& problem, const Optimum& optimum, const Covariance& covariance, const FitSpec& spec,
                    const FitRun& options, FitResult& result) {
  BootstrapOptions how;
  how.replicates = spec.proof.bootstrap;
  how.seed = spec.search.seed;
  how.stop = options.stop;
  const Bootstrap drawn = bootstrap(problem, optimum.scaled, covariance, how);
  result.bootstrap.clear();
  for (const std::vector<double>& z : drawn.scaled) result.bootstrap.push_back(problem.to_values(z));
  if (drawn.scaled.size() < 10) return;  // percentiles of fewer say nothing
  for (std::size_t p = 0; p < result.parameters.size(); ++p) result.parameters[p].by_bootstrap = drawn.interval[p];
  std::set<std::string> told;
  for (const std::string& note : drawn.notes) {
    if (told.insert(note).second) result.conclusions.push_back(note);
  }
}

}  // namespace

void fill_curves(const LawSearch& search, const FitSpec& spec, const FitCurves& curves, FitResult& result) {
  const std::vector<Prediction> predictions = search.predictions();
  const Validation all = errors_in_common_unit(curves.curves, predictions);
  result.unit = common_unit(curves.curves);
  result.tests = test_results(curves.curves, predictions);
  result.accounts = curves.accounts;
  result.curves.clear();
  result.groups.clear();
  for (std::size_t c = 0; c < curves.curves.size(); ++c)
    result.curves.push_back({curves.curves[c], predictions[c].force, all.curves[c].rms, {}, {}});
  double squares = 0.0;
  std::size_t repeated = 0;
  for (const GroupError& g : all.groups) {
    const auto spread = g.spread.curves >= 2 ? std::optional(g.spread.deviation) : std::nullopt;
    if (!std::isnan(g.rms_fit)) result.groups.push_back({g.name, false, g.rms_fit, spread});
    if (!std::isnan(g.rms_heldout)) result.groups.push_back({g.name, true, g.rms_heldout, spread});
    if (spread) squares += *spread * *spread, ++repeated;
  }
  result.rms_fit = all.rms_fit;
  result.rms_heldout = known(all.rms_heldout);
  if (repeated > 0) result.spread = std::sqrt(squares / static_cast<double>(repeated));
  result.conclusions.insert(result.conclusions.end(), curves.skipped.begin(), curves.skipped.end());
  conclude_on_curves(all, result, result.conclusions);
  conclude_on_tests(result, result.conclusions);
  conclude_on_values(result, result.conclusions);
  if (spec.proof.displacement) {
    const std::string text = limited_errors(curves, predictions, *spec.proof.displacement);
    if (!text.empty()) result.conclusions.push_back(text);
  }
}

void fill_search(const LawSearch& search, const FitSpec& spec, FitResult& result) {
  const Problem& problem = search.problem();
  result.law = search.law().name;
  result.starts.clear();
  result.basins.clear();
  for (const Basin& b : search.found().basins) result.basins.push_back({b.cost, b.found, problem.to_values(b.scaled)});
  for (const StartRecord& s : search.found().starts) {
    StartResult start{s.optimum.cost, -1};
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t b = 0; std::isfinite(s.optimum.cost) && b < search.found().basins.size(); ++b) {
      const double apart = std::abs(search.found().basins[b].cost - s.optimum.cost);
      if (apart < nearest) nearest = apart, start.basin = static_cast<int>(b);
    }
    result.starts.push_back(start);
  }
  result.starts_planned = spec.search.starts;
  result.forward = search.forward_words();
  result.forward_error = search.forward_error();
  conclude_on_search(search, result.conclusions);
}

namespace {

/// What a fit to each test alone predicts of the others: where there are several kinds, and runs cost little.
void fill_tests_alone(const LawSearch& search, const FitCurves& curves, const FitRun& options, FitResult& result) {
  constexpr int kStarts = 6;
  const bool cheap = search.ladder().taken().kind == RungKind::specimen;
  if (!cheap || result.tests.size() < 2 || of_one_kind(curves.curves) || stopped(options)) return;
  fill_alone(result.tests, curves.curves, search.problem(), search.optimum().scaled, kStarts, search.descent());
}

}  // namespace

void fill_proof(LawSearch& search, const FitSpec& spec, const FitCurves& curves, const FitRun& options,
                FitResult& result) {
  constexpr int kRounds = 3;
  const auto told = [&](const char* stage, std::size_t done, std::size_t planned) {
    if (!options.progress) return;
    options.progress({search.law().name, stage, done, planned, rms_at(search.problem(), search.optimum().scaled),
                      common_unit(curves.curves), search.found().basins.front().found, search.forward_runs()});
  };
  Covariance covariance;
  std::optional<Profiles> profiled;
  std::unique_ptr<LocalProblem> local;
  for (int round = 0; round < kRounds; ++round) {
    covariance = fit::covariance(search.problem(), search.optimum().scaled);
    profiled.reset();
    if (!spec.proof.profiles || !covariance.failure.empty() || stopped(options)) break;
    told("profiles", 0, 1);
    profiled = profiles_of(search, covariance, options, local);
    told("profiles", 1, 1);
    if (profiled->better.empty() || round + 1 == kRounds) break;
    search.improve(profiled->better);
  }
  if (!stopped(options)) search.compare_specimen();
  result.conclusions.clear();
  fill_curves(search, spec, curves, result);
  fill_search(search, spec, result);
  fill_parameters(search.problem(), search.optimum(), covariance, profiled ? &*profiled : nullptr, result);
  fill_tests_alone(search, curves, options, result);
  if (profiled) fill_profiles(search.problem(), *profiled, covariance, search.optimum().cost, result);
  if (!covariance.failure.empty()) {
    result.conclusions.push_back("The uncertainty of the parameters could not be computed: " + covariance.failure);
  } else {
    fill_further(search, curves, covariance, result);
    if (!stopped(options)) fill_further_batch(search, covariance, result);
    conclude_on_parameters(result, result.conclusions);
    result.conclusions.push_back(covariance.noise.why);
    if (local) result.conclusions.push_back(local->words());
    if (spec.proof.bootstrap > 0 && !stopped(options)) {
      told("bootstrap", 0, 1);
      fill_bootstrap(local ? local->problem() : search.problem(), search.optimum(), covariance, spec, options, result);
      told("bootstrap", 1, 1);
    }
  }
  if (spec.proof.next && !stopped(options)) {
    try {
      result.designs = next_experiments(search, spec, covariance);
      conclude_on_designs(result, result.conclusions);
    } catch (const std::exception& error) {  // a plan that cannot be simulated takes nothing from the fit
      result.conclusions.push_back(std::string("The next tests could not be simulated: ") + error.what());
    }
  }
  result.conclusions.push_back(derivative_words(search));
  result.conclusions.push_back(result.forward);
}

}  // namespace glisson::fit
