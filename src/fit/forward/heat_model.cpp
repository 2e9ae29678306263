#include "fit/forward/heat_model.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "base/nearest.h"
#include "fit/data/units.h"
#include "glisson/scene/heat_run.h"
#include "scene/build/parametric_variant.h"

namespace glisson::fit {

/// What a run gives of the columns that are asked for.
struct HeatColumns {
  std::vector<double> times;
  std::vector<std::vector<double>> values;  ///< of each column
};

namespace {

/// Keeps the named columns of a run.
class ColumnRecorder final : public HeatObserver {
 public:
  explicit ColumnRecorder(const std::vector<std::string>& names) : names_(names) {}
  void on_start(const Variant&, const BuiltHeat& built) override {
    columns.values.assign(names_.size(), {});
    for (const std::string& name : names_) {
      const auto at = [&](const std::vector<std::string>& list) {
        return static_cast<std::size_t>(std::find(list.begin(), list.end(), name) - list.begin());
      };
      const std::size_t sensor = at(built.temperature_columns());
      const bool of_sensor = sensor < built.temperature_columns().size();
      places_.emplace_back(of_sensor, of_sensor ? sensor : at(built.heat_columns()));
    }
  }
  void on_sample(const HeatSample& sample) override {
    columns.times.push_back(sample.heat.front());
    for (std::size_t c = 0; c < names_.size(); ++c) {
      const auto& [of_sensor, column] = places_[c];
      columns.values[c].push_back((of_sensor ? sample.temperatures : sample.heat)[column]);
    }
  }
  HeatColumns columns;

 private:
  const std::vector<std::string>& names_;
  std::vector<std::pair<bool, std::size_t>> places_;  ///< whether of temperature.csv, and the column there
};

/// Between the samples around a time by a line.
double value_at(const std::vector<double>& times, const std::vector<double>& values, double time) {
  const auto after = std::lower_bound(times.begin(), times.end(), time) - times.begin();
  const auto i = std::min(static_cast<std::size_t>(after), times.size() - 1);
  if (i == 0 || times[i] <= time) return values[i];
  const double part = (time - times[i - 1]) / (times[i] - times[i - 1]);
  return values[i - 1] + part * (values[i] - values[i - 1]);
}

constexpr double kSame = 1e-9;  ///< of a time: what differs by less is the same

}  // namespace

struct HeatModel::Recording {
  HeatColumns columns;
  std::string failure;  ///< why it went no further than its times, or why there was no run; empty: it went to its end
};

/// A variant of the scene with the curves that are read of it.
class HeatModel::Experiment {
 public:
  Experiment(const SceneText& scene, const std::string& variant, std::span<const std::string> keys)
      : variant_(variant), scene_(scene.text, scene.name, scene.base, scene.overrides, variant, keys) {}

  const std::string& variant() const { return variant_; }
  void add(const Curve& curve) {
    const HeatReading& reading = *curve.measurement.heat;
    for (const std::string& name : {reading.column, reading.over}) {
      if (!name.empty() && column_of(name) == names_.size()) names_.push_back(name);
    }
    until_ = std::max(until_, curve.time.back());
    last_ = until_ == curve.time.back() ? curve.name : last_;
  }
  std::size_t column_of(const std::string& name) const {
    return static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
  }

  /// The experiment with nothing but what its curves need. @throws SceneError, std::invalid_argument
  /// @param steps  as HeatModelOptions
  Variant at(std::span<const double> values, int steps = 0) const {
    Variant v = scene_.with(values);
    if (!v.heat || v.heat->ice)
      throw std::invalid_argument(v.heat ? "test = \"heat\" is of a scene of heat alone; remove [heat.ice] from it"
                                         : "test = \"heat\" needs a scene with [heat]");
    HeatSpec& heat = *v.heat;
    if (until_ > heat.duration * (1.0 + kSame))
      throw std::invalid_argument("\"" + last_ + "\" goes to " + brief(until_) + " s, and [heat] of the scene to " +
                                  brief(heat.duration) + " s; give a longer heat.duration_s, or crop.max_time_s");
    const double samples = std::ceil(until_ / heat.sample_every * (1.0 - kSame));
    heat.duration = std::min(heat.duration, std::max(1.0, samples) * heat.sample_every);
    heat.options.threads = 1;
    if (steps > 0) heat.options.step = heat.sample_every / steps;
    v.output.frames = 0;
    return v;
  }

  Recording record(std::span<const double> values, const HeatModelOptions& options) const {
    ColumnRecorder recorder(names_);
    Recording recording;
    static const std::atomic<bool> never{false};
    try {
      const HeatRunSummary summary =
          run_heat(at(values, options.steps), options.load, recorder, options.stop != nullptr ? *options.stop : never);
      const bool whole = summary.end == RunSummary::End::finished;
      if (!whole) recording.failure = summary.trouble.empty() ? "the fit is being stopped" : summary.trouble;
    } catch (const std::exception& error) {
      recording.failure = error.what();
    }
    recording.columns = std::move(recorder.columns);
    return recording;
  }

  /// @throws std::invalid_argument where a column is none of the scene's, naming those that are
  void require_columns(std::span<const double> values, const MeshLoader& load) const {
    const BuiltHeat built(at(values), load);
    std::vector<std::string> all = built.temperature_columns();
    all.insert(all.end(), built.heat_columns().begin() + 1, built.heat_columns().end());
    for (const std::string& name : names_) {
      if (std::find(all.begin() + 1, all.end(), name) != all.end()) continue;
      throw std::invalid_argument("the scene has no column \"" + name + "\"; of temperature.csv and heat.csv it has: " +
                                  scene::listed(std::span<const std::string>(all).subspan(1)) +
                                  "; add a [[heat.sensor]], [[heat.front]] or [[heat.isotherm]] of that name to it");
    }
  }

 private:
  std::string variant_;
  scene::ParametricVariant scene_;
  std::vector<std::string> names_;  ///< of the columns
  double until_ = 0.0;              ///< last instant of all curves [s]
  std::string last_;                ///< the curve that has it
};

HeatModel::HeatModel(const SceneText& scene, std::span<const std::string> keys, std::vector<Curve> curves,
                     HeatModelOptions options)
    : curves_(std::move(curves)), options_(std::move(options)), recordings_(options_.recordings) {
  options_.load = kept_meshes(std::move(options_.load));
  std::vector<std::unique_ptr<Experiment>> made;
  for (const Curve& c : curves_) {
    if (!c.measurement.heat || c.size() == 0 || c.time.front() < 0.0)
      throw std::invalid_argument("\"" + c.name + "\" begins before the scene does, at " +
                                  brief(c.size() > 0 ? c.time.front() : 0.0) +
                                  " s; times are those of the scene: give crop.min_time_s = 0, or correct them");
    const std::string& variant = c.measurement.heat->variant.empty() ? scene.variant : c.measurement.heat->variant;
    auto known = std::find_if(made.begin(), made.end(), [&](const auto& e) { return e->variant() == variant; });
    if (known == made.end()) known = made.insert(known, std::make_unique<Experiment>(scene, variant, keys));
    (*known)->add(c);
    experiment_of_.push_back(static_cast<std::size_t>(known - made.begin()));
  }
  for (auto& e : made) experiments_.push_back(std::move(e));
}

HeatModel::~HeatModel() = default;

void HeatModel::require_columns(std::span<const double> values) const {
  for (const auto& e : experiments_) e->require_columns(values, options_.load);
}

Prediction HeatModel::predict(std::size_t index, std::span<const double> values) const {
  const std::size_t number = experiment_of_[index];
  const Experiment& experiment = *experiments_[number];
  const auto found =
      recordings_.get({number, {values.begin(), values.end()}}, [&] { return experiment.record(values, options_); });
  const HeatColumns& all = found.result->columns;
  const Curve& curve = curves_[index];
  Prediction p{.force = {}, .failure = found.result->failure, .reused = !found.made};
  const double reached = all.times.empty() ? -1.0 : all.times.back();
  if (reached < curve.time.back() * (1.0 - kSame)) {
    if (p.failure.empty()) p.failure = "the run ended before the curve does";
    return p;
  }
  p.failure.clear();
  const HeatReading& reading = *curve.measurement.heat;
  const std::vector<double>& column = all.values[experiment.column_of(reading.column)];
  for (const double time : curve.time) {
    double value = value_at(all.times, column, time);
    if (!reading.over.empty()) {
      const double over = value_at(all.times, all.values[experiment.column_of(reading.over)], time);
      value = over == 0.0 && value == 0.0 ? 0.0 : value / over;  // no part of nothing
    }
    p.force.push_back(value);
  }
  const bool finite = std::ranges::all_of(p.force, [](double x) { return std::isfinite(x); });
  if (!finite) p = {.force = {}, .failure = "\"" + curve.name + "\" is no finite number", .reused = p.reused};
  return p;
}

}  // namespace glisson::fit
