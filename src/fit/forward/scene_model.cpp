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

/// The force of the measured part at the end of each step that has a sample, for long steps no line between them; halts a run that
/// is not wanted any more.
class ForceRecorder final : public RunObserver {
 public:
  ForceRecorder(const Part& part, const SceneModelOptions& options)
      : part_(part), stop_(options.stop), longest_(options.longest) {}
  void on_built(const BuiltVariant& built) override { built_ = &built; }
  void on_start(const Variant&, const Simulation&) override { times.clear(), forces.clear(); }
  void on_sample(const Sample&) override {
    const double time = built_->simulation.force_time();
    if (!times.empty() && !(time > times.back())) return;
    times.push_back(time);
    forces.push_back(force());
    const bool late = seconds() > longest_;
    if (late || (stop_ != nullptr && stop_->load(std::memory_order_relaxed))) halt = true;
  }
  bool late() const { return halt && seconds() > longest_; }
  std::vector<double> times, forces;
  std::atomic<bool> halt{false};

 private:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }
  double force() const {
    if (part_.what == Part::What::bottom) return -built_->container->sensor_loads().bottom.z;
    if (part_.what == Part::What::side) return -built_->container->sensor_loads().side.z;
    const Instrument& x = *built_->instruments[part_.index];
    return -dot(x.sensor_force(), x.direction());
  }
  Part part_;
  const BuiltVariant* built_ = nullptr;
  const std::atomic<bool>* stop_;
  double longest_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

bool rings(const Variant& v) { return !capabilities(v.simulation.integrator).any_step_is_stable; }

bool same_motion(const Curve& a, const Curve& b) {
  return a.time == b.time && a.displacement == b.displacement && a.past_time == b.past_time &&
         a.past_displacement == b.past_displacement && a.velocity == b.velocity && a.measurement == b.measurement;
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
    std::map<std::pair<std::filesystem::path, std::optional<double>>, TetMesh> meshes;
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
      options_(std::move(options)), recordings_(options_.recordings) {
  std::vector<Curve> all;
  for (std::size_t i = 0; i < this->curves(); ++i) {
    require_curves({&curve(i), 1});
    all.push_back(curve(i));
    same_motion_.push_back(i);
    for (std::size_t k = 0; k < i && same_motion_[i] == i; ++k) {
      if (same_motion(all[k], all[i])) same_motion_[i] = k;
    }
  }
  steady_ = steady_presses(all, options_.contacts);
  options_.load = kept_meshes(std::move(options_.load));
}

double SceneModel::approach_time(const Curve& c) const {
  if (!(options_.approach > 0.0)) return 0.0;
  double speed = c.velocity;
  for (std::size_t i = 1; i < c.size() && !(speed > 0.0); ++i)
    speed = (c.displacement[i] - c.displacement[0]) / (c.time[i] - c.time[0]);
  return speed > 0.0 ? options_.approach / speed : c.time.back();
}

SceneModel::Motion SceneModel::motion(std::size_t index, double contact) const {
  const Curve& c = curve(index);
  if (const SteadyPress* press = press_of(index, contact)) {
    Curve line;
    line.name = c.name, line.velocity = press->speed;
    line.time = {0.0, press->depth / press->speed};
    line.displacement = {0.0, press->depth};
    return {History(line), approach_time(line), press->duration + approach_time(line), press->points};
  }
  History history(c, contact);
  const double before = approach_time(c), duration = history.end() - history.begin() + before;
  return {std::move(history), before, duration, c.size()};
}

const SteadyPress* SceneModel::press_of(std::size_t index, double contact) const {
  const bool within = options_.contacts.empty() ? contact == 0.0 : options_.contacts[index].holds(contact);
  return within && steady_.of[index] ? &steady_.presses[*steady_.of[index]] : nullptr;
}

Variant SceneModel::variant(std::size_t index, std::span<const double> values, double contact) const {
  Variant v = scene_.with(values);
  const Motion m = motion(index, contact);
  const double duration = m.way.end() - m.way.begin() + m.approach_time;
  const Part part = moving_part(v, options_.tool);
  if (part.index < v.tools.size()) {
    ToolSpec& tool = v.tools[part.index];
    tool.record = record_of(m.way, unit(tool.motion.direction), 0.0, m.approach_time);
  } else {
    InstrumentSpec& x = v.instruments[part.index - v.tools.size()];
    x.motion.how = record_of(m.way, unit(x.motion.direction.value_or(x.direction)), options_.approach, m.approach_time);
  }
  v.duration = duration;
  v.max_steps.reset();
  const double samples = std::clamp(2.0 * static_cast<double>(m.points), 200.0, 2000.0);
  v.output = {.sample_rate = samples / m.duration, .frames = 0};
  v.simulation.track_energies = false;
  v.simulation.threads = 1;
  if (options_.adjust) options_.adjust(v, m.duration);
  if (rings(v)) {
    v.output.sample_rate = std::max(samples, 1000.0) / m.duration;
    v.duration = duration + 0.5 * kBeyond * (m.way.end() - m.way.begin());  // for means about the last instants
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
  if (summary.end != RunSummary::End::finished) throw std::runtime_error(std::string(meaning_of(summary.end)));
  return summary.step_s;
}

SceneModel::Recording SceneModel::record(std::size_t index, std::span<const double> values, double contact) const {
  try {
    Variant v = variant(index, values, contact);
    ForceRecorder recorder(measured_part(v, options_), options_);
    recorder.halt = options_.stop != nullptr && options_.stop->load();
    const RunSummary summary = run(v, recorder, recorder.halt);
    Recording recording;
    if (summary.end != RunSummary::End::finished || recorder.times.empty())
      recording.stopped = "the run stopped at " + std::to_string(summary.time_s) +
                          " s: " + std::string(recorder.late() ? "it takes too long" : meaning_of(summary.end)) +
                          (summary.trouble.empty() ? "" : ": " + summary.trouble);
    recording.unwanted = options_.stop != nullptr && options_.stop->load();
    if (!recorder.times.empty() && recorder.times.front() > 0.0 && !is_viscous(v)) {
      // schemes that tell forces at the end of a step alone
      recorder.times.insert(recorder.times.begin(), 0.0);
      recorder.forces.insert(recorder.forces.begin(), 0.0);
    }
    recording.forces = {std::move(recorder.times), std::move(recorder.forces), rings(v)};
    return recording;
  } catch (const std::exception& error) {
    Recording recording;
    recording.refused = error.what();
    return recording;
  }
}

std::vector<double> SceneModel::instants(std::size_t index, double contact) const {
  const Curve& c = curve(index);
  std::vector<double> list;
  if (const SteadyPress* press = press_of(index, contact)) {
    for (const double d : c.displacement) list.push_back((options_.approach + d - contact) / press->speed);
  } else {
    const double shift = approach_time(c) - History(c, contact).begin();
    for (const double t : c.time) list.push_back(t + shift);
  }
  return list;
}

/// A press is read as far as it goes, if need be; what a reading of it calls a run ends with the reading.
Prediction SceneModel::read(const Recording& recording, std::size_t index, double contact) const {
  const std::string name = "curve \"" + curve(index).name + "\": ";
  if (!recording.refused.empty()) return {{}, recording.refused};
  const std::vector<double> times = instants(index, contact);
  const bool press = press_of(index, contact) != nullptr;
  const bool enough =
      recording.stopped.empty() || (press && !recording.unwanted && recording.forces.holds(times.back()));
  if (!enough || recording.forces.empty()) return {{}, name + recording.stopped};
  const double whole = press ? (1.0 + 0.5 * kBeyond) * times.back() : recording.forces.span();
  Prediction result;
  for (const double t : times) {
    result.force.push_back(recording.forces.at(t, whole));
    if (!std::isfinite(result.force.back())) return {{}, name + "the force is not finite"};
  }
  return result;
}

Prediction SceneModel::predict_from(std::size_t index, std::span<const double> values, double contact) const {
  const bool press = press_of(index, contact) != nullptr;
  std::vector<double> what(values.begin(), values.end());
  if (!press) what.push_back(contact);
  const std::size_t motion = press ? *steady_.of[index] : steady_.presses.size() + same_motion_[index];
  const auto found = recordings_.get({motion, std::move(what)}, [&] { return record(index, values, contact); });
  Prediction result = read(*found.result, index, contact);
  result.reused = !found.made;
  return result;
}

}  // namespace glisson::fit
