#include "fit/forward/scene_model.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "base/input_file.h"
#include "base/nearest.h"

namespace glisson::fit {
namespace {

/// What of an experiment moves or measures: an instrument, or the container's floor or wall.
struct Part {
  enum class What { instrument, bottom, side } what = What::instrument;
  std::size_t index = 0;  ///< among the tools, then the instruments
};

std::vector<std::string> part_names(const Variant& variant) {
  std::vector<std::string> names;
  for (const ToolSpec& x : variant.tools) names.push_back(x.name);
  for (const InstrumentSpec& x : variant.instruments) names.push_back(x.name);
  return names;
}

/// The tool or instrument of that name; the only one where none is given.
Part moving_part(const Variant& variant, const std::string& name) {
  const std::vector<std::string> names = part_names(variant);
  if (names.empty())
    throw std::invalid_argument("the scene has no [[tool]] and no [[instrument]]; one has to follow the curve");
  if (name.empty() && names.size() > 1)
    throw std::invalid_argument("several tools could follow the curve; name one with [forward] tool: " +
                                scene::listed(names));
  const auto it = name.empty() ? names.begin() : std::find(names.begin(), names.end(), name);
  if (it == names.end())
    throw std::invalid_argument("no tool or instrument \"" + name + "\"; the scene has: " + scene::listed(names));
  return {Part::What::instrument, static_cast<std::size_t>(it - names.begin())};
}

Part measured_part(const Variant& variant, const SceneModelOptions& options) {
  const bool vessel = options.force == "bottom" || options.force == "side";
  if (!vessel) return moving_part(variant, options.force.empty() ? options.tool : options.force);
  if (!variant.container)
    throw std::invalid_argument("force = \"" + options.force + "\" is that of a [container], and the scene has none");
  return {options.force == "bottom" ? Part::What::bottom : Part::What::side, 0};
}

/// The force of the measured part at each sample; halts a run that is not wanted any more.
class ForceRecorder final : public RunObserver {
 public:
  ForceRecorder(const Part& part, const SceneModelOptions& options)
      : part_(part), stop_(options.stop), longest_(options.longest) {}
  void on_built(const BuiltVariant& built) override { built_ = &built; }
  void on_start(const Variant&, const Simulation&) override { times.clear(), forces.clear(); }
  void on_sample(const Sample& s) override {
    if (!times.empty() && !(s.time > times.back())) return;
    times.push_back(s.time);
    forces.push_back(force_of(s));
    const bool late = seconds() > longest_;
    if (late || (stop_ != nullptr && stop_->load(std::memory_order_relaxed))) halt = true;
  }
  bool late() const { return halt && seconds() > longest_; }
  std::vector<double> times, forces;
  std::atomic<bool> halt{false};

 private:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }
  double force_of(const Sample& s) const {
    if (part_.what == Part::What::bottom) return -s.container->bottom.z;
    if (part_.what == Part::What::side) return -s.container->side.z;
    const Instrument& x = *built_->instruments[part_.index];
    return -dot(x.sensor_force(), x.direction());
  }
  Part part_;
  const BuiltVariant* built_ = nullptr;
  const std::atomic<bool>* stop_;
  double longest_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// What a load cell shows of forces that ring: means over 1 % of the run before and after an instant, less near its ends, of
/// straight lines between the samples.
class ForceMeans {
 public:
  ForceMeans(const std::vector<double>& times, const std::vector<double>& forces)
      : times_(times), forces_(forces), sums_(times.size()) {
    for (std::size_t i = 1; i < times.size(); ++i)
      sums_[i] = sums_[i - 1] + 0.5 * (forces[i] + forces[i - 1]) * (times[i] - times[i - 1]);
  }
  double at(double time) const {
    const double first = times_.front(), last = times_.back();
    const double half = std::min({0.01 * (last - first), time - first, last - time});
    if (half > 1e-9 * (last - first)) return (sum(time + half) - sum(time - half)) / (2.0 * half);
    return time <= first ? forces_.front() : (time >= last ? forces_.back() : line(time, piece(time)));
  }

 private:
  std::size_t piece(double time) const {
    const auto it = std::upper_bound(times_.begin() + 1, times_.end() - 1, time);
    return static_cast<std::size_t>(it - times_.begin()) - 1;
  }
  double line(double time, std::size_t i) const {
    return forces_[i] + (forces_[i + 1] - forces_[i]) * (time - times_[i]) / (times_[i + 1] - times_[i]);
  }
  double sum(double time) const {
    const std::size_t i = piece(time);
    return sums_[i] + 0.5 * (forces_[i] + line(time, i)) * (time - times_[i]);
  }
  const std::vector<double>&times_, &forces_;
  std::vector<double> sums_;
};

bool rings(const Variant& v) { return !capabilities(v.simulation.integrator).any_step_is_stable; }

const char* end_words(RunSummary::End end) {
  using End = RunSummary::End;
  switch (end) {
    case End::finished:
      return "";
    case End::interrupted:
      return "interrupted";
    case End::stopped_inverted:
      return "a tetrahedron inverted";
    case End::stopped_unstable:
      return "the step has become too large; leave out step_s";
    case End::stopped_not_finite:
      return "a force is not finite";
    case End::stopped_not_converged:
      return "no equilibrium was found";
    case End::stopped_not_held:
      return "supports and tools leave a rigid motion free";
  }
  return "";
}

bool is_viscous(const Variant& v) {
  const auto viscous = [](const RegionSpec& r) { return r.tissue.viscosity > 0.0; };
  return v.tissue.viscosity > 0.0 || std::any_of(v.regions.begin(), v.regions.end(), viscous);
}

constexpr double kBeyond = 0.02;  ///< of the time of a record: how far it goes on

/// A way in time along a direction, after an approach at the speed with which it goes on.
RecordSpec record_of(const History& history, const Vec3d& direction, double approach, double approach_time) {
  RecordSpec record;
  if (approach > 0.0) {
    record.motion.times.push_back(0.0);
    record.motion.positions.push_back({});
  }
  for (std::size_t i = 0; i < history.times().size(); ++i) {
    record.motion.times.push_back(history.times()[i] - history.begin() + approach_time);
    record.motion.positions.push_back(direction * (history.displacements()[i] + approach));
  }
  // goes on for a while at the speed it ends with: a tool that stops within the last step makes the force jump there
  const std::vector<double>&times = history.times(), &way = history.displacements();
  const std::size_t n = times.size();
  const double more = kBeyond * (times[n - 1] - times[0]);
  const double speed = (way[n - 1] - way[n - 2]) / (times[n - 1] - times[n - 2]);
  record.motion.times.push_back(record.motion.times.back() + more);
  record.motion.positions.push_back(direction * (std::max(0.0, way[n - 1] + more * speed) + approach));
  return record;
}

}  // namespace

SceneText scene_text(const std::filesystem::path& file) {
  detail::InputFile input = detail::read_input(file, detail::kTomlInput);
  if (!input.problem.empty()) throw SceneError(input.problem);
  return {.text = std::move(input.bytes),
          .name = file.string(),
          .base = file.parent_path(),
          .overrides = {},
          .variant = {}};
}

MeshLoader kept_meshes(MeshLoader load) {
  if (!load) return load;
  struct Kept {
    std::mutex lock;
    std::map<std::pair<std::filesystem::path, double>, TetMesh> meshes;
  };
  return [load = std::move(load), kept = std::make_shared<Kept>()](const MeshFile& file) {
    const std::scoped_lock guard(kept->lock);
    const auto key = std::pair(file.path, file.scale);
    const auto it = kept->meshes.find(key);
    return it != kept->meshes.end() ? it->second : kept->meshes.emplace(key, load(file)).first->second;
  };
}

SceneModel::SceneModel(const SceneText& scene, std::span<const std::string> keys, std::vector<Curve> curves,
                       SceneModelOptions options)
    : MotionModel(std::move(curves)), scene_(scene.text, scene.name, scene.base, scene.overrides, scene.variant, keys),
      options_(std::move(options)) {
  for (std::size_t i = 0; i < this->curves(); ++i) require_curves({&curve(i), 1});
  options_.load = kept_meshes(std::move(options_.load));
}

double SceneModel::approach_time(const Curve& c) const {
  if (!(options_.approach > 0.0)) return 0.0;
  double speed = c.velocity;
  for (std::size_t i = 1; i < c.size() && !(speed > 0.0); ++i)
    speed = (c.displacement[i] - c.displacement[0]) / (c.time[i] - c.time[0]);
  return speed > 0.0 ? options_.approach / speed : c.time.back();
}

Variant SceneModel::variant(std::size_t index, std::span<const double> values, double contact) const {
  Variant v = scene_.with(values);
  const Curve& c = curve(index);
  const History history(c, contact);
  const double before = approach_time(c), duration = history.end() - history.begin() + before;
  const Part part = moving_part(v, options_.tool);
  if (part.index < v.tools.size()) {
    ToolSpec& tool = v.tools[part.index];
    tool.record = record_of(history, unit(tool.motion.direction), 0.0, before);
  } else {
    InstrumentSpec& x = v.instruments[part.index - v.tools.size()];
    x.motion.how = record_of(history, unit(x.motion.direction.value_or(x.direction)), options_.approach, before);
  }
  v.duration = duration;
  v.max_steps.reset();
  const double samples = std::clamp(2.0 * static_cast<double>(c.size()), 200.0, 2000.0);
  v.output = {.sample_rate = samples / duration, .frames = 0};
  v.simulation.track_energies = false;
  v.simulation.threads = 1;
  if (options_.adjust) options_.adjust(v, duration);
  if (rings(v)) {
    v.output.sample_rate = std::max(samples, 1000.0) / duration;
    v.duration = duration + 0.5 * kBeyond * (history.end() - history.begin());  // for means about the last instants
  }
  return v;
}

RunSummary SceneModel::run(Variant& v, RunObserver& observer, const std::atomic<bool>& stop) const {
  constexpr int kMostHalvings = 5;
  for (int i = 0;; ++i) {
    const bool may_halve = options_.halves_step && v.simulation.step && i < kMostHalvings;
    try {
      RunSummary summary = run_variant(v, options_.load, observer, stop);
      if (summary.end != RunSummary::End::stopped_unstable || !may_halve) return summary;
    } catch (const SceneError&) {  // above h* at rest already
      if (!may_halve) throw;
    }
    v.simulation.step = 0.5 * *v.simulation.step;
  }
}

double SceneModel::last_step(std::size_t index, std::span<const double> values) const {
  RunObserver nothing;
  Variant v = variant(index, values);
  const std::atomic<bool> never{false};
  const RunSummary summary = run(v, nothing, options_.stop ? *options_.stop : never);
  if (summary.end != RunSummary::End::finished) throw std::runtime_error(end_words(summary.end));
  return summary.step_s;
}

Prediction SceneModel::predict_from(std::size_t index, std::span<const double> values, double contact) const {
  Prediction result;
  try {
    Variant v = variant(index, values, contact);
    const Curve& c = curve(index);
    ForceRecorder recorder(measured_part(v, options_), options_);
    recorder.halt = options_.stop != nullptr && options_.stop->load();
    const RunSummary summary = run(v, recorder, recorder.halt);
    if (summary.end != RunSummary::End::finished || recorder.times.empty()) {
      result.failure = "curve \"" + c.name + "\": the run stopped at " + std::to_string(summary.time_s) +
                       " s: " + (recorder.late() ? "it takes too long" : end_words(summary.end)) +
                       (summary.trouble.empty() ? "" : ": " + summary.trouble);
      return result;
    }
    if (recorder.times.front() > 0.0 && !is_viscous(v)) {  // schemes that tell forces at the end of a step alone
      recorder.times.insert(recorder.times.begin(), 0.0);
      recorder.forces.insert(recorder.forces.begin(), 0.0);
    }
    const MonotoneCubic<double> cubic(recorder.times, recorder.forces);
    const ForceMeans means(recorder.times, recorder.forces);
    const bool ringing = rings(v) && recorder.times.size() > 2;
    const double shift = approach_time(c) - History(c, contact).begin();
    for (const double t : c.time) {
      result.force.push_back(ringing ? means.at(t + shift) : cubic.at(t + shift));
      if (!std::isfinite(result.force.back()))
        throw std::runtime_error("curve \"" + c.name + "\": the force is not finite");
    }
  } catch (const std::exception& error) {
    result.force.clear();
    result.failure = error.what();
  }
  return result;
}

}  // namespace glisson::fit
