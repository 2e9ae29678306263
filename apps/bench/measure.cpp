// measure.cpp — see measure.h.
#include "bench/measure.h"

#include <fmt/format.h>

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "bench/percentile.h"
#include "bench/process_memory.h"

namespace glisson::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kOneByOne = 500'000;      // tets from which cases are built one after the other
constexpr std::uint64_t kStepsFromState = 200;  // timed at a stretch: viscosity must not wipe the motion out
constexpr double kBurst = 0.002;                // [s]; shorter than what a scheduler hands out

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// How often threads of this program have lost a core to others.
std::uint64_t preemptions() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_nivcsw);
}

/// A body built for one case, and its times.
class Trial {
 public:
  Trial(const BenchBody& body, const BenchCase& what);
  /// Warms up, hashes the state after kHashSteps, and chooses how many steps a repetition has.
  void prepare(double repetition_s);
  void repeat();
  BenchRow row() const;

 private:
  void restore();
  void steps(std::uint64_t count);
  double stretch();
  [[noreturn]] void fail(const std::string& what) const;

  const BenchBody& body_;
  BenchCase case_;
  Simulation simulation_;
  std::uint64_t stretch_ = 1, stretches_ = 1;  // steps from a restored state, and how often
  std::uint64_t burst_ = 1;                    // steps of a burst
  std::uint64_t hash_ = 0, end_hash_ = 0, preempted_ = 0;
  std::vector<double> ns_, bursts_;  // per tet and step, one a repetition, one a burst
};

SimulationOptions simulation_options(const BenchCase& what) {
  SimulationOptions options;
  options.threads = what.threads;
  options.track_energies = what.accounting;
  return options;
}

Trial::Trial(const BenchBody& body, const BenchCase& what)
    : body_(body), case_(what), simulation_(body.mesh, {{0, model_tissue(what.model)}}, simulation_options(what)) {}

void Trial::fail(const std::string& what) const {
  throw std::runtime_error(
      fmt::format("{}, {}, threads {}: {}", body_.name, word_of(case_.model), case_.threads, what));
}

void Trial::steps(std::uint64_t count) {
  for (std::uint64_t i = 0; i < count; ++i) {
    if (simulation_.step().status != StepStatus::ok) fail("a step went wrong: a tet inverted, or not finite");
  }
}

/// The first step from a state that is set finds out how long it may be, which is no part of what a step costs.
void Trial::restore() {
  simulation_.set_state(body_.displacement, body_.velocity);
  steps(1);
}

void Trial::prepare(double repetition_s) {
  restore();
  steps(kHashSteps);  // warms up
  restore();
  const Clock::time_point begin = Clock::now();
  steps(kHashSteps);
  const double step_s = seconds_since(begin) / kHashSteps;
  hash_ = simulation_.state_hash();
  for (const Vec3d& u : simulation_.displacement()) {
    if (!std::isfinite(norm(u))) fail("the state is not finite");
  }
  const double wanted = std::max(2.0, repetition_s / step_s);
  stretch_ = std::min(static_cast<std::uint64_t>(wanted), kStepsFromState);
  burst_ = std::clamp<std::uint64_t>(static_cast<std::uint64_t>(kBurst / step_s), 1, stretch_);
  stretches_ = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(wanted) / stretch_);
}

/// Steps from a restored state, timed burst by burst. @return [s]
double Trial::stretch() {
  restore();
  double seconds = 0.0;
  for (std::uint64_t done = 0; done < stretch_;) {
    const std::uint64_t count = std::min(burst_, stretch_ - done);
    const Clock::time_point begin = Clock::now();
    steps(count);
    const double took = seconds_since(begin);
    seconds += took;
    done += count;
    if (count == burst_)
      bursts_.push_back(1e9 * took / (static_cast<double>(body_.mesh.tets.size()) * static_cast<double>(count)));
  }
  return seconds;
}

void Trial::repeat() {
  const std::uint64_t before = preemptions();
  double seconds = 0.0;
  for (std::uint64_t i = 0; i < stretches_; ++i) seconds += stretch();
  preempted_ += preemptions() - before;
  const double tet_steps = static_cast<double>(body_.mesh.tets.size()) * static_cast<double>(stretch_ * stretches_);
  const std::uint64_t hash = simulation_.state_hash();
  if (!ns_.empty() && hash != end_hash_) fail("the same steps from the same state have led to another state");
  end_hash_ = hash;
  ns_.push_back(1e9 * seconds / tet_steps);
}

BenchRow Trial::row() const {
  return {.mesh = body_.name,
          .what = case_,
          .tets = body_.mesh.tets.size(),
          .engine = simulation_.engine_info(),
          .ns_per_tet_step = percentile(ns_, 50.0),
          .ns_p10 = percentile(bursts_, 10.0),
          .spread = relative_spread(ns_),
          .preempted = preempted_,
          .step_s = simulation_.step_size(),
          .steps = stretch_ * stretches_ * ns_.size(),
          .state_hash = hash_,
          .peak_rss_mib = std::nullopt};
}

/// Cases whose bodies are in memory together.
std::vector<BenchRow> measure_together(const BenchBody& body, std::span<const BenchCase> cases,
                                       const MeasureOptions& options) {
  const bool counted = restart_peak_memory();
  std::vector<Trial> trials;
  for (const BenchCase& what : cases) trials.emplace_back(body, what).prepare(options.repetition_s);
  for (int round = 0; round < options.repetitions; ++round) {
    for (Trial& trial : trials) trial.repeat();
  }
  std::vector<BenchRow> rows;
  for (const Trial& trial : trials) rows.push_back(trial.row());
  if (counted) {
    for (BenchRow& row : rows) row.peak_rss_mib = peak_memory_mib();
  }
  return rows;
}

}  // namespace

std::vector<BenchRow> measure(const BenchBody& body, std::span<const BenchCase> cases, const MeasureOptions& options) {
  const std::size_t at_a_time = body.mesh.tets.size() >= kOneByOne ? 1 : cases.size();
  std::vector<BenchRow> rows;
  for (std::size_t i = 0; i < cases.size(); i += at_a_time) {
    const auto more = measure_together(body, cases.subspan(i, at_a_time), options);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  return rows;
}

}  // namespace glisson::app
