#include "fit/forward/ladder.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <boost/random/uniform_01.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <numeric>
#include <set>
#include <stdexcept>

#include "fit/forward/candidates.h"
#include "fit/forward/heat_model.h"
#include "fit/forward/indentation_model.h"
#include "fit/forward/offset_model.h"
#include "fit/model/curve_kinds.h"

namespace glisson::fit {
namespace {

/// Runs that are shorter than this are not broken off [s].
constexpr double kShortest = 0.02;
constexpr double kEver = std::numeric_limits<double>::infinity();
constexpr const char* kSpecimen = "specimen";  // its name, for messages and for a fit that goes on

/// One curve of each group; of those without a group each.
std::vector<std::size_t> one_of_each_group(std::span<const Curve> curves) {
  std::vector<std::size_t> chosen;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (curves[i].group.empty() || seen.insert(curves[i].group).second) chosen.push_back(i);
  }
  return chosen;
}

/// The start, then points of a Sobol sequence within the bounds, on the scale of each parameter.
std::vector<std::vector<double>> places_of(std::span<const Parameter> parameters, int count) {
  boost::random::sobol engine(std::max<std::size_t>(1, parameters.size()));
  std::vector<std::vector<double>> places(1);
  for (const Parameter& p : parameters) places[0].push_back(p.start);
  for (int k = 1; k <= count; ++k) {
    std::vector<double> place;
    for (const Parameter& p : parameters) {
      const double z = boost::random::uniform_01<double>()(engine);
      place.push_back(p.scale == Scale::linear ? p.low + z * (p.high - p.low) : p.low * std::pow(p.high / p.low, z));
    }
    places.push_back(std::move(place));
  }
  return places;
}

double peak(const std::vector<double>& force) {
  double most = 0.0;
  for (const double f : force) most = std::max(most, std::abs(f));
  return most;
}

double rms(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// Error that is allowed on a curve where the scene gives `force`: of the noise, or of 0.5 % of the measured peak where that
/// is not known; in proportion where the force is larger than what was measured.
double allowance(const Curve& curve, const std::vector<double>& force, double tolerance) {
  const double measured = peak(curve.force), simulated = peak(force);
  const double noise = curve.noise > 0.0 ? curve.noise : 0.005 * (measured > 0.0 ? measured : simulated);
  return tolerance * noise * (measured > 0.0 ? std::max(1.0, simulated / measured) : 1.0);
}

using Forces = std::vector<std::vector<double>>;  ///< of each curve that is compared

/// Those of some runs; empty with a failure where one of them has none.
Forces forces_of(std::vector<Prediction> runs, std::string& failure) {
  Forces forces;
  for (Prediction& p : runs) {
    if (p.force.empty()) {
      failure = p.failure;
      return {};
    }
    forces.push_back(std::move(p.force));
  }
  return forces;
}

/// At one place, up to the first that does not run.
Forces run(const Model& model, const std::vector<std::size_t>& curves, std::span<const double> values,
           std::string& failure) {
  std::vector<Prediction> runs;
  for (std::size_t c = 0; c < curves.size() && (c == 0 || !runs.back().force.empty()); ++c)
    runs.push_back(model.predict(curves[c], values));
  return forces_of(std::move(runs), failure);
}

/// The same with the curves side by side, where nobody looks at the clock.
Forces run_side_by_side(const Model& model, const std::vector<std::size_t>& curves, std::span<const double> values,
                        std::string& failure) {
  std::vector<Prediction> runs(curves.size());
  tbb::parallel_for(std::size_t{0}, runs.size(), [&](std::size_t c) { runs[c] = model.predict(curves[c], values); });
  return forces_of(std::move(runs), failure);
}

/// Makes all models from one description.
struct Maker {
  const ForwardProblem& problem;
  std::vector<std::string> keys, inner;

  explicit Maker(const ForwardProblem& p) : problem(p) {
    for (const Parameter& x : p.parameters) keys.push_back(x.name);
    inner = inner_keys(keys);
  }
  SceneModelOptions options(Adjust adjust, double longest) const {
    return {.tool = problem.spec.tool,
            .force = problem.spec.force,
            .approach = problem.spec.approach,
            .load = problem.load,
            .adjust = std::move(adjust),
            .stop = problem.stop,
            .longest = longest,
            .contacts = contact_ranges(problem.parameters, problem.curves)};
  }
  std::shared_ptr<const Model> with_offsets(std::shared_ptr<const MotionModel> model) const {
    if (inner.size() == keys.size()) return model;
    return std::make_shared<OffsetModel>(std::move(model), keys);
  }
  std::shared_ptr<const SceneModel> scene(Adjust adjust, double longest = kEver, bool halves = false) const {
    SceneModelOptions o = options(std::move(adjust), longest);
    o.halves_step = halves;
    return std::make_shared<SceneModel>(problem.scene, inner, problem.curves, std::move(o));
  }
  /// Empty where a key is none of the tissue's.
  TissueAt tissue_at(std::span<const std::string> of_tissue) const {
    const SceneText& s = problem.scene;
    const auto tissue =
        std::make_shared<scene::ParametricVariant>(s.text, s.name, s.base, s.overrides, s.variant, of_tissue);
    if (!tissue->only_tissue()) return {};
    return [tissue](std::span<const double> values) { return tissue->tissue_with(values); };
  }
  std::shared_ptr<const Model> specimen(const Specimen& size) const {
    const TissueAt tissue = tissue_at(inner);
    return tissue ? with_offsets(std::make_shared<SpecimenModel>(problem.curves, size, tissue)) : nullptr;
  }
  std::shared_ptr<const Model> barrel(const lab::BarrelGrid& grid) const {
    std::vector<std::string> of_tissue;
    std::copy_if(inner.begin(), inner.end(), std::back_inserter(of_tissue),
                 [](const std::string& key) { return !is_plate_key(key); });
    const TissueAt tissue = tissue_at(of_tissue);
    if (!tissue)
      throw std::invalid_argument(
          "[specimen] with faces = \"bonded\" or \"friction\" allows parameters of [tissue], `specimen.…` and "
          "`curve.…` alone");
    return with_offsets(std::make_shared<BarrelModel>(problem.curves, *problem.plates, tissue, inner, grid));
  }
  std::shared_ptr<const Model> layer(IndentationOptions options) const {
    const TissueAt tissue = tissue_at(inner);
    if (!tissue)
      throw std::invalid_argument("a layer under an indenter needs parameters of [tissue] and `curve.…` alone");
    std::vector<Parameter> parameters;
    for (const Parameter& p : problem.parameters) {
      if (!is_curve_key(p.name)) parameters.push_back(p);
      if (p.name.ends_with("contact_mm")) options.margin += std::max(0.0, -1e-3 * p.low);
    }
    return with_offsets(
        std::make_shared<IndentationModel>(problem.curves, *problem.layer, tissue, std::move(parameters), options));
  }
  /// @param steps  equal ones between two samples; 0: as the scene chooses
  std::shared_ptr<const HeatModel> heat(int steps = 0) const {
    if (inner.size() != keys.size())
      throw std::invalid_argument("parameters `curve.…` are of a press or an insertion, and not of test = \"heat\"");
    return std::make_shared<HeatModel>(problem.scene, keys, problem.curves,
                                       HeatModelOptions{.load = problem.load, .steps = steps, .stop = problem.stop});
  }
  std::vector<double> inner_values(std::span<const double> all) const {
    std::vector<double> values;
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (!is_curve_key(keys[i])) values.push_back(all[i]);
    }
    return values;
  }
  /// Three quarters of the smallest step that tissue 100 times as heavy ends with at any of the places, for ρ × 1.
  double explicit_step(std::size_t curve, const std::vector<std::vector<double>>& places) const {
    const auto trial = scene(heavier_tissue(100.0, 0.0));
    std::vector<double> steps(places.size(), kEver);
    tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
      try {
        steps[i] = trial->last_step(curve, inner_values(places[i]));
      } catch (const std::exception&) {  // a place where nothing runs says nothing
      }
    });
    const double found = *std::min_element(steps.begin(), steps.end()), least = std::isfinite(found) ? found : 0.0;
    return 0.75 * least / std::sqrt(100.0);
  }
};

double seconds(std::chrono::steady_clock::time_point from) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
}

using Trial = std::function<std::shared_ptr<const Model>()>;

/// What the scene itself gives at each place; empty where it does not run.
struct Comparison {
  const ForwardProblem& problem;
  const Ladder& ladder;
  std::vector<Forces> truth;

  /// Runs a model at a place; at the start short runs are made again, by a model that has not made them yet, and the
  /// shortest is the cost.
  Forces timed_run(Rung& rung, const Trial& trial, std::shared_ptr<const Model>& model, std::size_t place) const {
    if (place != 0) return run_side_by_side(*model, ladder.compared, ladder.places[place], rung.failure);
    Forces forces;
    for (int i = 0; i < 5; ++i) {
      model = trial();
      const auto begin = std::chrono::steady_clock::now();
      forces = run(*model, ladder.compared, ladder.places[place], rung.failure);
      const double cost = seconds(begin);
      rung.cost = i == 0 ? cost : std::min(rung.cost, cost);
      if (cost > 0.02) break;
    }
    return forces;
  }
  /// Runs a model at all places and notes cost and error; only at the start where one that serves costs less already. A
  /// place where the scene fails says nothing. @param trial  makes the rung's model, perhaps with an end to its patience
  void measure(Rung& rung, const Trial& trial, double best_cost) const {
    std::shared_ptr<const Model> model;
    for (std::size_t place = 0; place < truth.size() && rung.failure.empty(); ++place) {
      if (truth[place].empty()) continue;
      const Forces forces = timed_run(rung, trial, model, place);
      for (std::size_t c = 0; c < forces.size(); ++c) {
        const double error = rms(forces[c], truth[place][c]);
        const Curve& curve = problem.curves[ladder.compared[c]];
        if (place == 0) rung.error = std::max(rung.error, error);
        rung.share = std::max(rung.share, error / allowance(curve, truth[place][c], problem.spec.tolerance));
      }
      if (rung.share > 1.0 || rung.cost >= best_cost) return;
    }
  }
};

/// The scene itself at all places, side by side; its cost is that at the start. A place where it fails is left empty.
/// @throws std::runtime_error where it does not run at the start
std::vector<Forces> true_forces(Ladder& ladder) {
  struct Truth {
    Prediction prediction;
    double cost = 0.0;
  };
  const std::size_t curves = ladder.compared.size();
  std::vector<Truth> runs(ladder.places.size() * curves);
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, runs.size(), 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          const auto begin = std::chrono::steady_clock::now();
          runs[i].prediction = ladder.rungs[0].model->predict(ladder.compared[i % curves], ladder.places[i / curves]);
          runs[i].cost = seconds(begin);
        }
      },
      tbb::simple_partitioner());
  std::vector<Forces> truth(ladder.places.size());
  for (std::size_t place = 0; place < truth.size(); ++place) {
    for (std::size_t c = 0; c < curves; ++c) {
      Truth& one = runs[place * curves + c];
      if (place == 0 && !one.prediction.reused) ladder.rungs[0].cost += one.cost;
      if (one.prediction.force.empty()) {
        if (place == 0)
          throw std::runtime_error("the scene does not run at the start of the parameters: " + one.prediction.failure);
        truth[place].clear();
        break;
      }
      truth[place].push_back(std::move(one.prediction.force));
    }
  }
  return truth;
}

/// What a model may cost to be taken [s]: less than the one that is; a smooth one some more than the scene itself.
double patience(const Ladder& ladder) { return (ladder.chosen == 0 ? 1.5 : 1.0) * ladder.taken().cost; }

/// Measures a model, and takes it where it serves and costs less than the one that is taken.
void try_out(const Comparison& comparison, Ladder& ladder, Rung rung, const Trial& trial) {
  const bool known = !comparison.problem.taken.empty();
  comparison.measure(rung, trial, known ? kEver : patience(ladder));
  ladder.rungs.push_back(std::move(rung));
  const Rung& last = ladder.rungs.back();
  if (last.serves() && (known || last.cost < patience(ladder))) ladder.chosen = ladder.rungs.size() - 1;
}

void fill_allowed(Ladder& ladder, const Comparison& comparison) {
  for (std::size_t c = 0; c < ladder.compared.size(); ++c)
    ladder.allowed.push_back(allowance(comparison.problem.curves[ladder.compared[c]], comparison.truth[0][c],
                                       comparison.problem.spec.tolerance));
}

/// @throws std::invalid_argument where the model of an interrupted run is none of these
void require_taken(const Ladder& ladder, const ForwardProblem& problem) {
  if (problem.taken.empty() || ladder.taken().name == problem.taken) return;
  throw std::invalid_argument(
      "the forward model \"" + problem.taken +
      "\", which an interrupted run chose, does not apply to this fit; start again with --fresh");
}

/// The scene of heat with the steps that it chooses, and with equal ones: these make temperatures smooth functions of the parameters.
Ladder heat_ladder(const ForwardProblem& problem, const Maker& make) {
  constexpr int kMostSteps = 8;  // between two samples
  Ladder ladder;
  ladder.compared = one_of_each_group(problem.curves);
  ladder.places = places_of(problem.parameters, problem.spec.points);
  const std::shared_ptr<const HeatModel> scene = make.heat();
  scene->require_columns(ladder.places[0]);
  ladder.rungs.push_back({.kind = RungKind::heat, .name = "the scene", .failure = {}, .model = scene});
  if (problem.spec.kind == ForwardKind::scene) return ladder;
  const Comparison comparison{problem, ladder, true_forces(ladder)};
  fill_allowed(ladder, comparison);
  for (int steps = 1; steps <= kMostSteps && ladder.chosen == 0; steps *= 2) {
    const std::string name = std::to_string(steps) + (steps == 1 ? " step" : " equal steps") + " from sample to sample";
    if (!problem.taken.empty() && name != problem.taken) continue;
    try_out(comparison, ladder, {.kind = RungKind::heat, .name = name, .failure = {}, .model = make.heat(steps)},
            [&] { return make.heat(steps); });
  }
  require_taken(ladder, problem);
  return ladder;
}

}  // namespace

Ladder choose_forward(const ForwardProblem& problem) {
  const Maker make(problem);
  if (are_of_heat(problem.curves)) return heat_ladder(problem, make);
  Ladder ladder;
  if (problem.plates) {
    ladder.rungs.push_back(
        {.kind = RungKind::barrel, .name = "specimen that bulges", .failure = {}, .model = make.barrel({})});
    return ladder;
  }
  if (problem.layer) {
    ladder.rungs.push_back({.kind = RungKind::layer, .name = "layer", .failure = {}, .model = make.layer({})});
    return ladder;
  }
  const auto only_specimen = [&](const std::optional<Specimen>& size) {
    const auto specimen = size ? make.specimen(*size) : nullptr;
    if (!specimen)
      throw std::invalid_argument(
          "[forward] kind = \"uniaxial\" needs a block or cylinder of one tissue between smooth plates, and "
          "parameters of [tissue] alone; take kind = \"scene\" or \"auto\"");
    ladder.rungs.push_back({.kind = RungKind::specimen, .name = kSpecimen, .failure = {}, .model = specimen});
  };
  if (problem.specimen) {
    only_specimen(problem.specimen);
    return ladder;
  }
  ladder.compared = one_of_each_group(problem.curves);
  ladder.places = places_of(problem.parameters, problem.spec.points);
  const std::shared_ptr<const SceneModel> scene = make.scene(reference_run(problem.spec));
  const Variant variant = scene->variant(0, make.inner_values(ladder.places[0]));
  const std::optional<Specimen> size = homogeneous_specimen(variant, make.options({}, kEver));
  if (problem.spec.kind == ForwardKind::uniaxial) {
    only_specimen(size);
    return ladder;
  }
  ladder.rungs.push_back(
      {.kind = RungKind::scene, .name = "the scene", .failure = {}, .model = make.with_offsets(scene)});
  if (problem.spec.kind == ForwardKind::scene) return ladder;

  const Comparison comparison{problem, ladder, true_forces(ladder)};
  fill_allowed(ladder, comparison);
  const bool known = !problem.taken.empty();
  const auto wanted = [&](const std::string& name) { return !known || name == problem.taken; };
  if (auto specimen = size && wanted(kSpecimen) ? make.specimen(*size) : nullptr)
    try_out(comparison, ladder, {.kind = RungKind::specimen, .name = kSpecimen, .failure = {}, .model = specimen},
            [&] { return specimen; });
  double step = 0.0;
  bool heavier_serves = false;
  for (ForwardCandidate& c : forward_candidates(variant, problem.spec)) {
    const bool own_steps = c.factor > 0.0;
    if (!wanted(c.name) || (own_steps && heavier_serves)) continue;  // a lighter one takes shorter steps
    if (own_steps && step == 0.0) step = make.explicit_step(ladder.compared[0], ladder.places);
    if (own_steps) c.adjust = heavier_tissue(c.factor, step * std::sqrt(c.factor));
    const double longest = known ? kEver : std::max(kShortest, patience(ladder));
    try_out(comparison, ladder,
            {.kind = RungKind::changed_scene,
             .name = c.name,
             .failure = {},
             .model = make.with_offsets(make.scene(c.adjust, kEver, own_steps)),
             .integrator = c.integrator,
             .steps = c.steps},
            [&] { return make.with_offsets(make.scene(c.adjust, longest, own_steps)); });
    heavier_serves = heavier_serves || (own_steps && ladder.rungs.back().serves());
  }
  require_taken(ladder, problem);
  return ladder;
}

std::shared_ptr<const Model> model_for(const Ladder& ladder, const ForwardProblem& compared,
                                       const ForwardProblem& other) {
  const Rung& taken = ladder.taken();
  if (taken.steps == 0) return nullptr;
  double longest = 0.0;
  for (const std::size_t c : ladder.compared)
    longest = std::max(longest, compared.curves[c].time.back() - compared.curves[c].time.front());
  const auto adjust = [integrator = taken.integrator, steps = taken.steps, longest](Variant& v, double duration) {
    const double share = longest > 0.0 ? std::max(1.0, duration / longest) : 1.0;
    equal_stepping(integrator, static_cast<int>(std::ceil(steps * share - 1e-9)))(v, duration);
  };
  const Maker make(other);
  return make.with_offsets(make.scene(adjust));
}

double check_forward(const Ladder& ladder, const ForwardProblem& problem, std::span<const double> values) {
  if (ladder.chosen == 0) return 0.0;
  std::string failure;
  const Forces truth = run_side_by_side(*ladder.rungs[0].model, ladder.compared, values, failure);
  const Forces forces =
      failure.empty() ? run_side_by_side(*ladder.model(), ladder.compared, values, failure) : Forces{};
  if (!failure.empty()) throw std::runtime_error("the forward models cannot be compared: " + failure);
  double share = 0.0;
  for (std::size_t c = 0; c < forces.size(); ++c) {
    const Curve& curve = problem.curves[ladder.compared[c]];
    share = std::max(share, rms(forces[c], truth[c]) / allowance(curve, truth[c], problem.spec.tolerance));
  }
  return share;
}

double grid_error(const Ladder& ladder, const ForwardProblem& problem, std::span<const double> values) {
  std::vector<std::size_t> curves(problem.curves.size());
  std::iota(curves.begin(), curves.end(), std::size_t{0});
  const Maker make(problem);
  const auto finer = problem.layer ? make.layer({.fineness = 1.5, .table = false})
                                   : make.barrel({.radial = 6, .axial = 5, .grading = 0.7});
  std::string failure;
  const Forces own = run_side_by_side(*ladder.model(), curves, values, failure);
  const Forces other = failure.empty() ? run_side_by_side(*finer, curves, values, failure) : Forces{};
  if (!failure.empty()) throw std::runtime_error(failure);
  double error = 0.0;
  for (std::size_t c = 0; c < own.size(); ++c) error = std::max(error, rms(own[c], other[c]));
  return error;
}

std::string describe(const Ladder& ladder) {
  std::string text;
  for (std::size_t i = 0; i < ladder.rungs.size(); ++i) {
    const Rung& r = ladder.rungs[i];
    char line[256];
    if (!r.failure.empty())
      std::snprintf(line, sizeof line, "%-28s fails: %.180s", r.name.c_str(), r.failure.c_str());
    else if (i == 0 || ladder.rungs.size() == 1)
      std::snprintf(line, sizeof line, "%-28s %10.2e s", r.name.c_str(), r.cost);
    else
      std::snprintf(line, sizeof line, "%-28s %10.2e s   off by %.3g N at the start, at most %.3g of what is allowed",
                    r.name.c_str(), r.cost, r.error, r.share);
    text += std::string(line) + (i == ladder.chosen ? "   ◀ taken\n" : "\n");
  }
  return text;
}

}  // namespace glisson::fit
