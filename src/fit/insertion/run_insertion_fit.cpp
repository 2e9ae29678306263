#include "fit/insertion/run_insertion_fit.h"

#include <chrono>
#include <cmath>

#include "fit/data/units.h"
#include "fit/forward/scene_model.h"
#include "fit/insertion/baseline.h"
#include "fit/insertion/membrane_search.h"
#include "glisson/fit.h"
#include "scene/build/parametric_variant.h"

namespace glisson::fit {
namespace {

template <class... Parts>
std::string joined(const Parts&... parts) {
  std::string text;
  (text.append(parts), ...);
  return text;
}
std::string newtons(double force) { return brief(force, 3) + " N"; }
std::string millimetres(double x) { return brief(1e3 * x) + " mm"; }

ParameterResult found(std::string name, std::string unit, double value, double high, std::string words) {
  ParameterResult p;
  p.parameter = {std::move(name), std::move(unit), 0.0, high, Scale::linear, 0.0};
  p.value = value;
  p.verdict = "read off";
  p.words = std::move(words);
  return p;
}

/// What a fit of membranes means: values, curve, sentences, and the text for a scene.
class Account {
 public:
  Account(const MembraneFit& fit, const MeasuredInsertion& measured, const InsertionSpec& spec)
      : fit_(fit), measured_(measured), spec_(spec) {}

  void parameters(std::vector<ParameterResult>& list) const;
  CurveResult curve(double speed) const;
  std::vector<std::string> sentences(std::size_t free) const;
  std::string toml(const std::vector<std::string>& sentences) const;

 private:
  bool broke(std::size_t drop) const { return drop <= fit_.run.inner.size(); }
  double place(std::size_t drop) const { return drop == 0 ? fit_.run.puncture : fit_.run.inner[drop - 1]; }
  std::string drop_words(std::size_t drop) const;
  std::string force_words(std::size_t drop) const;
  std::string before_puncture() const;

  const MembraneFit& fit_;
  const MeasuredInsertion& measured_;
  const InsertionSpec& spec_;
};

std::string Account::force_words(std::size_t drop) const {
  if (!broke(drop)) return "The tip did not break it.";
  return joined("The force before its drop is ", newtons(rise_end(fit_.run, place(drop)).force),
                "; measured: ", newtons(measured_.drops[drop].force), ".");
}

void Account::parameters(std::vector<ParameterResult>& list) const {
  const double deepest = 1e3 * fit_.run.depth.back(), most = 2.0 * measured_.drops.front().force;
  const auto cutting = [&](const std::string& from, double value) {
    list.push_back(found("cutting force from " + from, "N", value, most, "From the mean force of its piece."));
  };
  if (fit_.stations.front().cutting) cutting("the surface", fit_.profile.cutting);
  std::size_t drop = 0;
  for (const InnerMembrane& m : fit_.profile.membranes) {
    const std::string name = "membrane " + std::to_string(drop + 1);
    if (m.puncture > 0.0) {
      ++drop;
      list.push_back(found(name + ", depth", "mm", 1e3 * m.depth, deepest, "From the place of its drop."));
      list.push_back(found(name + ", force", "N", m.puncture, most, force_words(drop)));
    }
    if (m.cutting) cutting(m.puncture > 0.0 ? name : millimetres(m.depth), *m.cutting);
  }
}

CurveResult Account::curve(double speed) const {
  CurveResult c;
  c.curve.name = c.curve.group = measured_.name;
  c.curve.velocity = speed;
  c.curve.displacement = measured_.curve.position;
  c.curve.force = measured_.curve.force;
  for (const double x : measured_.curve.position) {
    c.curve.time.push_back((x - measured_.curve.position.front()) / speed);
    c.fitted.push_back(simulated_force(fit_.run, x));
  }
  c.rms = fit_.rms;
  return c;
}

std::string Account::drop_words(std::size_t drop) const {
  const Drop& d = measured_.drops[drop];
  const std::string text = joined("Drop ", std::to_string(drop + 1), ": measured at ", millimetres(d.position),
                                  " from ", newtons(d.force), " to ", newtons(d.least));
  if (!broke(drop)) return text + "; the simulated tip does not get there.";
  return joined(text, "; simulated at ", millimetres(place(drop)), " from ",
                newtons(rise_end(fit_.run, place(drop)).force), ".");
}

std::string Account::before_puncture() const {
  constexpr std::size_t kFewestPoints = 4;
  std::vector<double> x, y;
  double squares = 0.0;
  const double last = measured_.drops.front().position - spec_.margin;
  for (std::size_t i = 0; i < measured_.curve.position.size(); ++i) {
    const double at = measured_.curve.position[i], force = measured_.curve.force[i];
    if (at < fit_.run.contact || at > last) continue;
    x.push_back(at);
    y.push_back(force);
    squares += std::pow(simulated_force(fit_.run, at) - force, 2);
  }
  if (x.size() < kFewestPoints) return "Before the puncture there are too few points to compare.";
  const Baseline plain = baseline_of(x, y);
  const double body = std::sqrt(squares / static_cast<double>(x.size()));
  return joined("From contact to the puncture, on ", std::to_string(x.size()), " points: the body ", newtons(body),
                " rms, an exponential of three numbers ", newtons(plain.exponential), ", a parabola ",
                newtons(plain.parabola), ".");
}

std::vector<std::string> Account::sentences(std::size_t free) const {
  std::vector<std::string> list{
      joined(std::to_string(free), " free values; ", newtons(fit_.rms), " rms at ", std::to_string(fit_.grid.size()),
             " positions, every ", millimetres(spec_.grid), " from ", millimetres(fit_.grid.front()), " to ",
             millimetres(fit_.grid.back()), ", but not within ", millimetres(spec_.margin),
             " of a drop. Without membranes, at the scene's own cutting force: ", newtons(fit_.rms_before), "."),
      joined("Drops are falls by ", newtons(spec_.least_drop), " within ", millimetres(spec_.within),
             "; the first is the puncture of the surface.")};
  for (std::size_t d = 0; d < measured_.drops.size(); ++d) list.push_back(drop_words(d));
  for (std::size_t i = 0; i < fit_.stations.size(); ++i) {
    if (fit_.stations[i].cutting) continue;
    const bool last = i + 1 == fit_.stations.size();
    const double to = last ? measured_.curve.position.back() : fit_.stations[i + 1].position;
    list.push_back(joined("The cutting force from ", millimetres(fit_.stations[i].position), " to ", millimetres(to),
                          " is not identifiable: the tip springs through, or sticks at a membrane."));
  }
  list.push_back(before_puncture());
  return list;
}

std::string Account::toml(const std::vector<std::string>& sentences) const {
  std::string text = "# Inner membranes by `glisson fit`, for a needle's [[instrument]]:\n";
  for (const std::string& sentence : sentences) text += "#   " + sentence + "\n";
  text += "tip.cutting_N = " + brief(fit_.profile.cutting) + "\nmembranes = [\n";
  for (const InnerMembrane& m : fit_.profile.membranes) {
    text += "  { depth_mm = " + brief(1e3 * m.depth);
    if (m.puncture > 0.0) text += ", puncture_N = " + brief(m.puncture);
    if (m.cutting) text += ", cutting_N = " + brief(*m.cutting);
    text += " },\n";
  }
  return text + "]\n";
}

void fill_result(const MembraneFit& fit, const MeasuredInsertion& measured, const InsertionSpec& spec, double speed,
                 FitResult& result) {
  const Account account(fit, measured, spec);
  account.parameters(result.parameters);
  result.curves.push_back(account.curve(speed));
  result.accounts.push_back(std::to_string(measured.curve.position.size()) + " points, sorted by position");
  result.groups.push_back({measured.name, false, fit.rms, {}});
  result.conclusions = account.sentences(result.parameters.size());
  result.rms_fit = fit.rms;
  result.forward = "The scene itself, run with each set of membranes.";
  result.result_file = "membranes.toml";
  result.tissue = account.toml(result.conclusions);
  result.forward_runs = static_cast<std::uint64_t>(fit.runs);
}

Variant variant_of(const FitSpec& spec) {
  const SceneText text = scene_text(spec.scene);
  return scene::ParametricVariant(text.text, text.name, text.base, spec.set, spec.variant, {}).with({});
}

}  // namespace

FitResult run_insertion_fit(const FitSpec& spec, const FitRun& options) {
  const auto begin = std::chrono::steady_clock::now();
  const InsertionSpec& insertion = *spec.insertion;
  const DataSpec& data = spec.data.front();
  const std::filesystem::path folder = options.data_folder.empty() ? spec.file.parent_path() : options.data_folder;
  const MeasuredInsertion measured = read_insertion(folder / data.files.front(), data, insertion);
  const InsertionScene scene(variant_of(spec), insertion, options.load);
  const auto progress = [&](int run, double rms) {
    if (!options.progress) return;
    FitProgress p{"membranes", "runs", static_cast<std::size_t>(run), static_cast<std::size_t>(insertion.runs)};
    p.best_rms = rms;
    p.forward_runs = static_cast<std::uint64_t>(run);
    options.progress(p);
  };
  const std::atomic<bool> never{false};
  const MembraneFit fit = fit_membranes(measured, insertion, scene, options.stop ? *options.stop : never, progress);
  FitResult result;
  fill_result(fit, measured, insertion, scene.speed(), result);
  result.complete = options.stop == nullptr || !*options.stop;
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  result.forward_run_s = result.wall_s / fit.runs;
  return result;
}

}  // namespace glisson::fit
