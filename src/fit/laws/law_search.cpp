#include "fit/laws/law_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "fit/data/units.h"
#include "fit/forward/offset_model.h"
#include "fit/model/curve_kinds.h"
#include "scene/parse/document.h"

namespace glisson::fit {
namespace {

/// Curves with a parameter of their own share no run with others.
std::vector<char> with_own_parameters(const std::vector<Curve>& curves, const LawSpec& law) {
  std::vector<char> own(curves.size(), 0);
  for (std::size_t c = 0; c < curves.size(); ++c) {
    for (const ParameterSpec& p : law.parameters) {
      if (is_curve_key(p.key) && p.key.find("." + curves[c].name + ".") != std::string::npos) own[c] = 1;
    }
  }
  return own;
}

/// A descent need not go where its derivatives no longer lead: with them wrong by a part e, a cost is found to e² or so. Of a
/// dear model 1e-6 of the cost are enough: with n samples a parameter is then off by some √n thousandths of its deviation.
double tolerance_of(const DerivativeCheck& check, bool dear) {
  return std::clamp(0.01 * check.error * check.error, dear ? 1e-6 : 1e-10, 1e-4);
}

/// Differences of a dear model that agree to so much are narrow enough.
constexpr double kAgree = 1e-3;

/// Two digits, or whole.
std::string rounded(double x) { return x >= 100.0 ? scene::show(std::round(x)) : brief(x, 2); }

/// How many times as fast as the scene the model taken is.
double speedup_of(const Ladder& ladder) { return ladder.rungs.front().cost / std::max(ladder.taken().cost, 1e-12); }

/// What an interrupted run knows is of as many parameters as the law has.
void require_fitting(const LawMemory& memory, std::size_t parameters, const std::string& law) {
  for (const StartRecord& s : memory.starts) {
    if (s.from.size() == parameters && s.optimum.scaled.size() == parameters) continue;
    throw std::invalid_argument("a start that an interrupted run made of the law " + law + " has " +
                                std::to_string(s.optimum.scaled.size()) + " parameters, and the law has " +
                                std::to_string(parameters) + "; start again with --fresh");
  }
}

/// What a model that was asked for is.
std::string asked_for(const Rung& taken, const std::optional<SpecimenSpec>& specimen) {
  switch (taken.kind) {
    case RungKind::layer:
      return "a layer under an indenter.";
    case RungKind::barrel:
      return "a cylinder that bulges between its plates.";
    case RungKind::specimen:
      return specimen && specimen->shape == SpecimenShape::point ? "a material point." : "a homogeneous specimen.";
    case RungKind::scene:
    case RungKind::changed_scene:
    case RungKind::heat:
      break;
  }
  return taken.name + ", as asked for.";
}

}  // namespace

SceneText scene_of(const FitSpec& spec, const LawSpec& law) {
  SceneText scene;
  if (spec.specimen) {
    scene = {specimen_scene(*spec.specimen), spec.file.string() + ": specimen", spec.file.parent_path(), {}, ""};
  } else {
    scene = scene_text(spec.scene);
    scene.variant = spec.variant;
  }
  scene.overrides = spec.set;
  scene.overrides.insert(scene.overrides.end(), law.set.begin(), law.set.end());
  return scene;
}

double rms_at(const Problem& problem, std::span<const double> scaled) {
  const Residuals r = problem.residuals(scaled, false);
  if (r.values.empty()) return std::numeric_limits<double>::infinity();
  double squares = 0.0;
  std::size_t count = 0;
  const std::string unit = common_unit(problem.curves());
  for (std::size_t c = 0; c < problem.curves().size(); ++c) {
    const Curve& curve = problem.curves()[c];
    if (!(curve.weight > 0.0)) continue;
    const double newtons = problem.spread()[c] / curve.weight * size_in(unit, curve);
    for (std::size_t i = 0; i < curve.size(); ++i) {
      const double f = newtons * r.values[problem.offset(c) + i];
      squares += f * f;
    }
    count += curve.size();
  }
  return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0.0;
}

LawSearch::LawSearch(const FitSpec& spec, LawSpec law, const FitCurves& curves, const FitRun& options)
    : spec_(spec), law_(std::move(law)), curves_(curves), options_(options) {
  forward_.scene = scene_of(spec, law_);
  forward_.spec = spec.forward;
  if (spec.specimen) forward_.plates = plates_of(*spec.specimen), forward_.layer = layer_of(*spec.specimen);
  // A specimen deforms alike all over by what the word means; whether a body of tets does so, too, is looked at in the end.
  if (spec.specimen && forward_.spec.kind == ForwardKind::automatic) forward_.spec.kind = ForwardKind::uniaxial;
  if (spec.specimen && forward_.spec.kind == ForwardKind::uniaxial) forward_.specimen = specimen_of(*spec.specimen);
  for (const ParameterSpec& p : law_.parameters) {
    forward_.parameters.push_back(parameter_of(p));
    forward_.parameters.back().name = p.key;
  }
  forward_.curves = curves.curves;
  forward_.load = options.load;
  forward_.stop = options.stop;
  const auto known = options.memory.find(law_.name);
  const bool goes_on = known != options.memory.end() && !known->second.starts.empty();
  if (goes_on) forward_.taken = known->second.forward;
  ladder_ = choose_forward(forward_);
  speedup_ = goes_on ? known->second.speedup : speedup_of(ladder_);
  take_model(ladder_.chosen);
}

void LawSearch::take_model(std::size_t rung) {
  ladder_.chosen = rung;
  if (model_) {
    former_runs_ += model_->runs();
    former_seconds_ += model_->seconds();
  }
  model_ = std::make_shared<CachedModel>(ladder_.model(), curves_.curves, with_own_parameters(curves_.curves, law_));
  const std::vector<std::size_t> fitted = curves_.indices(false);
  std::vector<Parameter> parameters;
  for (const ParameterSpec& p : law_.parameters) parameters.push_back(parameter_of(p));
  std::vector<Curve> chosen = curves_.chosen(fitted);
  std::vector<double> spread = spreads_of(chosen, spec_.search.weighing);
  problem_ = std::make_unique<Problem>(std::move(parameters), std::move(chosen), fitted, std::move(spread), *model_,
                                       spec_.search.loss);
}

bool LawSearch::dear() const { return ladder_.taken().runs_scene(); }

RunsAtOnce LawSearch::runs_at_once() const {
  const std::vector<Curve>& fitted = problem_->curves();
  std::vector<Parameter> keys = forward_.parameters;
  SteadyPresses steady;
  const bool heat = are_of_heat(fitted);
  if (dear() && !heat) steady = steady_presses(fitted, contact_ranges(keys, fitted));
  const auto press = [&](std::size_t c) { return steady.of.empty() ? std::nullopt : steady.of[c]; };
  const auto same = [&](std::size_t a, std::size_t b) {
    if (heat) return fitted[a].measurement.heat->variant == fitted[b].measurement.heat->variant;
    if (press(a) || press(b)) return press(a) == press(b);
    return fitted[a].time == fitted[b].time && fitted[a].displacement == fitted[b].displacement;
  };
  RunsAtOnce runs;
  bool all_steady = true;
  for (std::size_t c = 0; c < fitted.size(); ++c) {
    std::size_t first = 0;
    while (!same(first, c)) ++first;
    if (first == c) ++runs.motions;
    all_steady = all_steady && press(c);
  }
  for (const Parameter& p : keys) {
    const bool read = dear() && is_curve_key(p.name) && (all_steady || p.name.ends_with("force_offset_N"));
    if (!read) ++runs.parameters;
  }
  return runs;
}

DescentOptions LawSearch::descent() const {
  DescentOptions options;
  options.most_iterations = spec_.search.most_iterations;
  options.tolerance = tolerance_of(derivatives_, dear());
  options.stop = options_.stop;
  options.secant = dear();
  return options;
}

void LawSearch::search(LawMemory& memory, const std::function<void(const MultiStart&)>& told) {
  require_fitting(memory, law_.parameters.size(), law_.name);
  memory.forward = ladder_.taken().name;
  memory.speedup = speedup_;
  MultiStartOptions options;
  options.starts = spec_.search.starts;
  options.found_again = spec_.search.found_again;
  options.screen = spec_.search.screen;
  options.seed = spec_.search.seed;
  std::vector<double> own;
  for (const Parameter& p : problem_->parameters()) own.push_back(p.start);
  derivatives_ = check_derivatives(*problem_, problem_->to_scaled(own), dear() ? kAgree : 0.0);
  options.descent = descent();
  found_ = find_optimum(*problem_, options, memory.starts, [&](const MultiStart& so_far) {
    memory.starts = so_far.starts;
    if (told) told(so_far);
  });
  if (found_.basins.empty()) return;
  const Basin& best = found_.basins.front();
  optimum_ = {best.scaled, best.cost, true, 0, ""};
  if (!found_.complete) return;
  if (!(derivatives_.step > 0.0))  // runs beside the first start failed
    derivatives_ = check_derivatives(*problem_, optimum_.scaled, dear() ? kAgree : 0.0);
  try {
    look_again_at_forward();
  } catch (const std::exception& error) {  // what was found stays
    second_look_ = std::string("At the optimum the forward models could not be compared: ") + error.what();
  }
}

/// How far a body of tets between the plates is from the homogeneous state that was fitted.
void LawSearch::compare_specimen() {
  if (!spec_.specimen || spec_.forward.kind != ForwardKind::automatic || optimum_.scaled.empty()) return;
  if (forward_.layer) return compare_grids();
  const bool presses = std::all_of(curves_.curves.begin(), curves_.curves.end(),
                                   [](const Curve& c) { return c.measurement.is_press(); });
  if (!presses) return;
  if (forward_.plates) return compare_grids();
  ForwardProblem there = problem_at_optimum(forward_.curves);
  there.spec.kind = ForwardKind::automatic;
  there.specimen.reset();
  try {
    const Ladder ladder = choose_forward(there);
    const auto own = std::find_if(ladder.rungs.begin(), ladder.rungs.end(),
                                  [](const Rung& r) { return r.kind == RungKind::specimen && r.failure.empty(); });
    if (own == ladder.rungs.end()) return;
    specimen_error_ = own->error;
    second_look_ =
        "A body of tets between the plates gives the same force to " + rounded(own->error) + " N at the optimum.";
  } catch (const std::exception& error) {
    second_look_ = std::string("A body of tets between the plates could not be compared: ") + error.what();
  }
}

/// How far a cylinder that bulges, or a layer, is from one of more elements.
void LawSearch::compare_grids() {
  try {
    specimen_error_ = grid_error(ladder_, forward_, values());
    const std::string unit = common_unit(forward_.curves);  // of a creep that of its displacements
    second_look_ = std::string("A finer grid gives the same ") + (unit == "m" ? "displacement" : "force") + " to " +
                   rounded(*specimen_error_) + (unit.empty() ? "" : " " + unit) + " at the optimum.";
  } catch (const std::exception& error) {
    second_look_ = std::string("A finer grid could not be compared: ") + error.what();
  }
}

/// Where the optimum lies the model must be as good as where it was chosen; else one that is finishes the descent.
void LawSearch::look_again_at_forward() {
  if (ladder_.chosen == 0 || (options_.stop && options_.stop->load())) return;
  share_at_optimum_ = check_forward(ladder_, forward_, values());
  if (*share_at_optimum_ < 1.0) return;
  second_look_ =
      "At the optimum " + ladder_.taken().name + " was " + rounded(*share_at_optimum_) + " times the error allowed; ";
  const std::vector<double> start = optimum_.scaled;
  ladder_ = choose_forward(problem_at_optimum(forward_.curves));
  speedup_ = speedup_of(ladder_);
  second_look_ += ladder_.taken().name + " finished the descent.";
  share_at_optimum_.reset();
  take_model(ladder_.chosen);
  derivatives_ = check_derivatives(*problem_, start, dear() ? kAgree : 0.0);
  optimum_ = descend(*problem_, start, descent());
}

/// The forward problem with the optimum for its start and no other places.
ForwardProblem LawSearch::problem_at_optimum(std::vector<Curve> curves) const {
  ForwardProblem there = forward_;
  there.curves = std::move(curves);
  there.spec.points = 0;
  there.taken.clear();
  const std::vector<double> at = values();
  for (std::size_t p = 0; p < at.size(); ++p) there.parameters[p].start = at[p];
  return there;
}

void LawSearch::improve(std::span<const double> scaled) {
  Optimum better = descend(*problem_, scaled, descent());
  if (!(better.cost < optimum_.cost)) return;
  optimum_ = std::move(better);
  StartRecord record{{scaled.begin(), scaled.end()}, optimum_};
  found_.starts.push_back(std::move(record));
  found_.basins = basins_of(*problem_, found_.starts);
}

std::shared_ptr<const Model> LawSearch::model_of(std::vector<Curve> curves) const {
  ForwardProblem other = problem_at_optimum(std::move(curves));
  if (std::shared_ptr<const Model> same = model_for(ladder_, forward_, other)) return same;
  if (ladder_.taken().kind == RungKind::scene) other.spec.kind = ForwardKind::scene;
  return choose_forward(other).model();
}

const Optimum& LawSearch::optimum() const {
  if (!optimum_.scaled.empty()) return optimum_;
  const std::string why = found_.starts.empty() ? "no start was finished" : found_.starts.front().optimum.message;
  throw std::runtime_error(law_.name + ": no start ended in an optimum (" + why +
                           "); give bounds within which the scene runs, or a `start` that does");
}

std::vector<Prediction> LawSearch::predictions() const {
  std::vector<Prediction> all;
  const std::vector<double> at = values();
  for (std::size_t c = 0; c < curves_.curves.size(); ++c) all.push_back(model_->predict(c, at));
  return all;
}

std::string LawSearch::forward_words() const {
  const Rung& taken = ladder_.taken();
  std::string words;
  if (forward_.spec.kind != ForwardKind::automatic) {
    words = "Forward model: " + asked_for(taken, spec_.specimen);
  } else if (ladder_.chosen == 0) {
    words = "Forward model: the scene itself; no cheaper model stayed within the noise of the curves.";
  } else {
    words = "Forward model: " + taken.name + ", " + rounded(speedup_) +
            " times as fast as the scene itself, and at most " + rounded(taken.share) +
            " of the error that the noise of the curves allows";
    if (share_at_optimum_ && second_look_.empty()) words += " (" + rounded(*share_at_optimum_) + " at the optimum)";
    words += ".";
  }
  return second_look_.empty() ? words : words + " " + second_look_;
}

std::optional<double> LawSearch::forward_error() const {
  if (specimen_error_) return specimen_error_;
  if (ladder_.chosen == 0) return {};
  return ladder_.taken().error;
}

}  // namespace glisson::fit
