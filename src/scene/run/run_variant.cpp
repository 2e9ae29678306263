// run_variant.cpp — the time loop of a variant and what it shows to its observer.
//
//   ┌─ stretch of steps, timed as one: nothing but step() and three comparisons a step ─┐
//   │ step step step … until a sample or a frame is due, or about 20 ms have passed     │
//   └──────────────┬────────────────────────────────────────────────────────────────────┘
//                  ▼ not timed: sample, frame, progress
//
// Long steps are read one by one: automatic ones end at frames and at the run's end, and samples lie on the line between two ends.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "glisson/scene/heat_run.h"
#include "glisson/scene/scene.h"
#include "scene/run/run_watch.h"
#include "scene/run/sample_between.h"

namespace glisson {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kSameSample = 1e-6;  // of the time between samples: a step that ends so near to one is at it

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

class Run {
 public:
  Run(const Variant& variant, BuiltVariant& built, RunObserver& observer, const std::atomic<bool>& stop);
  RunSummary to_end();

 private:
  bool finished() const;
  double fraction(double time, std::uint64_t steps) const;
  /// Whether the last step's forces are those nearest to when a sample is due: by this step, which says the same whatever the clock.
  bool sample_due() const { return next_sample_ < force_time_ + 0.5 * summary_.step_s; }
  /// Whether the coming step's may be; with a margin, as the step may change.
  bool sample_near() const { return next_sample_ < next_force_time() + simulation_.step_size(); }
  /// Time that the forces after the next step are of: its start, or its end for the schemes that solve for it.
  double next_force_time() const { return simulation_.time() + (forces_at_end_ ? simulation_.step_size() : 0.0); }
  bool frame_due() const;
  void stretch();
  bool ends_within_step();
  bool step();
  void set_step_end();
  bool probe_now() const;
  void read_probes();
  void read_sample();
  void take_sample();
  void take_samples_between();
  void see_peak();
  void see_meetings();
  void show_sample(const Sample& sample);
  void tell_lost_probes();
  void tell_events(double until = std::numeric_limits<double>::infinity());
  void see_drift();
  void end_by(const RunWatch::Verdict& verdict);
  void see_linear_share();
  void take_frame();
  void show_progress();
  void summarise();

  const Variant& variant_;
  Simulation& simulation_;
  BuiltVariant& built_;
  RunObserver& observer_;
  const std::atomic<bool>& stop_;
  RunWatch watch_;
  double duration_;
  std::uint64_t most_steps_;
  bool forces_at_end_;

  Sample sample_, before_;  ///< before_: of the end of the long step before the last
  RunSummary summary_;
  double force_time_ = 0.0;  ///< that the forces of the last step made are of [s]
  std::uint64_t samples_due_ = 0;
  std::optional<double> probed_;  ///< time of the state that the probes were last read at [s]
  std::vector<char> lost_told_;   ///< per probe
  std::vector<char> met_;         ///< per instrument: whether it had a force at a sample
  std::size_t vertices_at_start_;
  double next_sample_ = 0.0;  ///< [s]
  int frames_taken_ = 0;
  std::vector<std::size_t> events_told_;                ///< per instrument
  std::vector<std::vector<InstrumentColumn>> columns_;  ///< per instrument
  bool ended_ = false, sampled_ = true, framed_ = false, forces_current_ = false;
  double stepping_s_ = 0.0, linear_sum_ = 0.0;
  std::uint64_t stretch_steps_ = 1;
  Clock::time_point begin_ = Clock::now(), last_progress_ = begin_;
};

Run::Run(const Variant& variant, BuiltVariant& built, RunObserver& observer, const std::atomic<bool>& stop)
    : variant_(variant), simulation_(built.simulation), built_(built), observer_(observer), stop_(stop),
      watch_(variant, built), duration_(run_duration(variant)),
      most_steps_(variant.max_steps.value_or(std::uint64_t(-1))),
      forces_at_end_(capabilities(variant.simulation.integrator).forces_at_step_end) {
  sample_.supports.resize(built.supports.size());
  sample_.instruments.resize(built.instruments.size());
  events_told_.resize(built.instruments.size(), 0);
  met_.resize(built.instruments.size(), 0);
  vertices_at_start_ = built.simulation.mesh().vertices.size();
  lost_told_.resize(built.probes.size(), 0);
  for (const auto& x : built.instruments) columns_.push_back(x->columns());
}

/// The last step is the one that ends nearest to the duration.
bool Run::finished() const {
  const bool at_end = simulation_.steps() > 0 && duration_ - simulation_.time() <= 0.5 * simulation_.step_size();
  return ended_ || at_end || simulation_.steps() >= most_steps_;
}

/// How much of the run is behind it at a time and a number of steps, in [0, 1].
double Run::fraction(double time, std::uint64_t steps) const {
  return std::min(1.0, std::max(time / duration_, static_cast<double>(steps) / static_cast<double>(most_steps_)));
}

/// Frames are evenly spaced over the run; the one nearest to each time is taken.
bool Run::frame_due() const {
  if (frames_taken_ >= variant_.output.frames || variant_.output.frames < 2) return false;
  const double now = fraction(simulation_.time() + 0.5 * simulation_.step_size(), simulation_.steps());
  return now >= static_cast<double>(frames_taken_) / (variant_.output.frames - 1);
}

/// Whether a sample takes the forces of the coming step, which belong to the state before it. The last step's may be taken too.
bool Run::probe_now() const {
  if (built_.probes.empty() || forces_at_end_) return false;
  const double left = duration_ - simulation_.time();
  return sample_near() || left <= 2.0 * simulation_.step_size() || simulation_.steps() + 1 >= most_steps_;
}

void Run::read_probes() {
  sample_.probes = built_.probes.read(simulation_);
  probed_ = simulation_.time();
}

/// Automatic long steps end at the next frame and at the end.
void Run::set_step_end() {
  const bool more = frames_taken_ < variant_.output.frames && variant_.output.frames > 1;
  const double share = more ? static_cast<double>(frames_taken_) / (variant_.output.frames - 1) : 1.0;
  simulation_.set_step_end(duration_ * share);
}

/// One step; false where it was not made.
bool Run::step() {
  if (forces_at_end_) set_step_end();
  const double start = simulation_.time();
  const StepResult result = simulation_.step();
  if (!result.inverted_tets.empty()) {
    if (summary_.first_inversion_s < 0.0) summary_.first_inversion_s = start;
    summary_.inverted_tets_most = std::max(summary_.inverted_tets_most, result.inverted_tets.size());
  }
  if (!result.contact_met && summary_.unmet_contact_steps++ == 0) summary_.first_unmet_contact_s = start;
  const bool made = result.made();
  if (!made && result.status != StepStatus::interrupted) summary_.trouble = result.message;
  summary_.end = end_of(result.status, variant_.on_inversion);
  ended_ = summary_.end != RunSummary::End::finished;
  forces_current_ = made;
  if (!made) return false;
  force_time_ = simulation_.force_time();
  if (variant_.simulation.precision == Precision::adaptive) see_linear_share();
  summary_.step_s = simulation_.step_size();  // of this step: it may have become smaller within it
  sampled_ = framed_ = false;
  return true;
}

void Run::see_linear_share() {
  linear_sum_ += simulation_.linear_share();
  summary_.linear_share_mean = linear_sum_ / static_cast<double>(simulation_.steps());
}

/// Asked within a long step: shows that it is under way. @return whether the run is to end
bool Run::ends_within_step() {
  if (stop_.load(std::memory_order_relaxed)) return true;
  show_progress();
  return false;
}

/// Steps until something is due. Only this is timed.
void Run::stretch() {
  const Clock::time_point begin = Clock::now();
  const std::uint64_t first = simulation_.steps(), last = first + stretch_steps_;
  bool due = false;
  while (!due && !finished() && simulation_.steps() < last) {
    if (stop_.load(std::memory_order_relaxed)) {
      summary_.end = RunSummary::End::interrupted;
      ended_ = true;
      break;
    }
    if (probe_now()) read_probes();
    if (!step()) break;
    due = forces_at_end_ || sample_due() || frame_due();
  }
  stepping_s_ += seconds_since(begin);
  const auto steps = static_cast<double>(simulation_.steps());
  if (steps > 0)
    stretch_steps_ = static_cast<std::uint64_t>(std::clamp(0.02 * steps / std::max(stepping_s_, 1e-9), 1.0, 4096.0));
}

/// Forces, depths and energies of the instant that the forces are of.
void Run::read_sample() {
  sample_.time = force_time_;
  for (std::size_t i = 0; i < built_.supports.size(); ++i) sample_.supports[i] = simulation_.force(built_.supports[i]);
  for (std::size_t i = 0; i < built_.instruments.size(); ++i) {
    const Instrument& x = *built_.instruments[i];
    sample_.instruments[i] = {x.force_depth(), x.force(), {}};
    for (const InstrumentColumn& column : columns_[i]) sample_.instruments[i].values.push_back(column.read(x));
  }
  if (built_.container) sample_.container = built_.container->sensor_loads();
  sample_.energies = simulation_.energies();
  if (variant_.output.stored_energy) sample_.stored_energy = simulation_.stored_energy();
  if (!built_.probes.empty() && probed_ != force_time_) read_probes();
  sample_.probe_time = probed_.value_or(force_time_);
}

void Run::see_peak() {
  for (std::size_t i = 0; i < built_.instruments.size(); ++i) {
    const Instrument& x = *built_.instruments[i];
    summary_.peak_force_N = std::max(summary_.peak_force_N, std::abs(dot(x.force(), x.direction())));
    if (x.force() != Vec3d{}) met_[i] = 1;
  }
}

/// Instruments that never had a force or an event: of a run to its end, which a count of steps did not cut off. One that cuts without
/// resistance has neither, but new vertices.
void Run::see_meetings() {
  if (summary_.end != RunSummary::End::finished || variant_.max_steps) return;
  for (std::size_t i = 0; i < variant_.instruments.size(); ++i) {
    const std::size_t own = variant_.tools.size() + i;
    const Instrument& x = *built_.instruments[own];
    const bool cut = x.changes_body() && simulation_.mesh().vertices.size() != vertices_at_start_;
    if (met_[own] == 0 && x.events().empty() && !cut) summary_.never_met.push_back(x.name());
  }
}

void Run::show_sample(const Sample& sample) {
  tell_lost_probes();
  observer_.on_sample(sample);
  end_by(watch_.see(sample));
}

/// All samples that are due by the end of a long step, on the line from the end of the one before.
void Run::take_samples_between() {
  read_sample();
  see_peak();
  const double rate = variant_.output.sample_rate, enough = force_time_ + kSameSample / rate;
  for (; next_sample_ <= enough; next_sample_ = static_cast<double>(++samples_due_) / rate) {
    sampled_ = next_sample_ >= force_time_ - kSameSample / rate;
    if (sampled_ || !(before_.time < force_time_)) {
      tell_events();
      show_sample(sample_);
      continue;
    }
    tell_events(next_sample_);
    show_sample(scene::sample_between(before_, sample_, next_sample_));
  }
  before_ = sample_;
}

void Run::take_sample() {
  read_sample();
  see_peak();
  tell_events();
  show_sample(sample_);
  sampled_ = true;
  const double passed = (force_time_ + 0.5 * summary_.step_s) * variant_.output.sample_rate;
  samples_due_ = std::max(samples_due_ + 1, static_cast<std::uint64_t>(std::min(std::ceil(passed), 9e15)));
  next_sample_ = static_cast<double>(samples_due_) / variant_.output.sample_rate;
}

void Run::tell_events(double until) {
  for (std::size_t i = 0; i < built_.instruments.size(); ++i) {
    const std::vector<InstrumentEvent>& events = built_.instruments[i]->events();
    for (std::size_t& told = events_told_[i]; told < events.size() && events[told].time <= until; ++told)
      observer_.on_event({built_.instruments[i]->name(), events[told]});
  }
}

/// A probe whose last tet is gone reads nan from here on.
void Run::tell_lost_probes() {
  for (std::size_t i = 0; i < built_.probes.size(); ++i) {
    if (lost_told_[i] != 0 || !built_.probes.lost(i)) continue;
    lost_told_[i] = 1;
    observer_.on_event({built_.probes.name(i), {sample_.probe_time, 0.0, "probe lost"}});
  }
}

void Run::see_drift() {
  const std::optional<double> stored = simulation_.stored_energy();
  if (!stored) return;
  const Energies energies = simulation_.energies();
  watch_.see_stored(simulation_.force_time(), energies, *stored);
  summary_.energy_drift_most_J = std::max(summary_.energy_drift_most_J, std::abs(energies.elastic - *stored));
}

/// Ends the run where its numbers cannot be believed. What ended it before stays the reason.
void Run::end_by(const RunWatch::Verdict& verdict) {
  if (verdict.end == RunSummary::End::finished || summary_.end != RunSummary::End::finished) return;
  summary_.end = verdict.end;
  summary_.trouble = verdict.why;
  ended_ = true;
}

void Run::take_frame() {
  observer_.on_frame(simulation_);
  if (variant_.simulation.track_energies) see_drift();
  framed_ = true;
  ++frames_taken_;
  while (frame_due()) ++frames_taken_;
}

void Run::show_progress() {
  if (seconds_since(last_progress_) < 0.1) return;
  last_progress_ = Clock::now();
  observer_.on_progress(fraction(simulation_.time(), simulation_.steps()));
}

void Run::summarise() {
  summary_.vertices = simulation_.mesh().vertices.size();
  summary_.tets = simulation_.mesh().tets.size();
  summary_.steps = simulation_.steps();
  summary_.time_s = simulation_.time();
  summary_.stable_step_s = simulation_.stable_step();
  if (summary_.steps == 0) summary_.step_s = simulation_.step_size();
  summary_.wall_s = seconds_since(begin_);
  const double tet_steps = static_cast<double>(summary_.tets) * static_cast<double>(summary_.steps);
  summary_.ns_per_tet_step = tet_steps > 0.0 ? 1e9 * stepping_s_ / tet_steps : 0.0;
  summary_.energies = simulation_.energies();
  summary_.stored_energy_J = simulation_.stored_energy();
  if (variant_.simulation.track_energies) see_drift();
  summary_.mass_added_kg = simulation_.mass_scaling().added + simulation_.mass_scaling().largest;
  summary_.unloaded = built_.unloaded;
  summary_.state_hash = simulation_.state_hash();
  summary_.instruction_set = simulation_.engine_info().instruction_set;
  if (variant_.simulation.track_energies) summary_.energy_gain = watch_.gain();
  end_by(watch_.see_end());
  see_meetings();
}

RunSummary Run::to_end() {
  observer_.on_start(variant_, simulation_);
  observer_.on_built(built_);
  begin_ = last_progress_ = Clock::now();
  simulation_.set_interrupt([this](const StepProgress&) { return ends_within_step(); });
  if (variant_.output.frames > 1) take_frame();
  if (forces_at_end_) read_sample(), before_ = sample_;
  while (!finished()) {
    const std::uint64_t before = simulation_.steps();
    stretch();
    const bool stepped = simulation_.steps() > before && forces_current_;
    if (stepped && forces_at_end_)
      take_samples_between();
    else if (stepped && sample_due())
      take_sample();
    if (stepped && frame_due()) take_frame();
    if (built_.heat && !built_.heat->trouble().empty()) end_by({built_.heat->end(), built_.heat->trouble()});
    show_progress();
  }
  if (!sampled_ && forces_current_) take_sample();
  if (!framed_ && simulation_.steps() > 0 && variant_.output.frames > 0) take_frame();
  simulation_.set_interrupt({});
  tell_events();
  summarise();
  observer_.on_end(summary_);
  return summary_;
}

}  // namespace

RunSummary::End end_of(StepStatus status, OnInversion on_inversion) {
  using End = RunSummary::End;
  switch (status) {
    case StepStatus::ok:
      return End::finished;
    case StepStatus::inverted:
      return on_inversion == OnInversion::stop ? End::stopped_inverted : End::finished;
    case StepStatus::step_too_large:
      return End::stopped_unstable;
    case StepStatus::not_finite:
      return End::stopped_not_finite;
    case StepStatus::not_converged:
      return End::stopped_not_converged;
    case StepStatus::not_held:
      return End::stopped_not_held;
    case StepStatus::interrupted:
      return End::interrupted;
  }
  return End::finished;
}

RunSummary run_variant(const Variant& variant, const MeshLoader& load, RunObserver& observer,
                       const std::atomic<bool>& stop) {
  BuiltVariant built = build_variant(variant, load);
  return Run(variant, built, observer, stop).to_end();
}

}  // namespace glisson
