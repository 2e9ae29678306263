// run_heat.cpp — the time loop of a scene of heat and what it shows to its observer.
#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

#include "base/text.h"
#include "glisson/scene/heat_run.h"

namespace glisson {
namespace {

constexpr double kAbsoluteZero = -273.15;  // [°C]

class HeatRun {
 public:
  HeatRun(const Variant& variant, BuiltHeat& built, HeatObserver& observer, const std::atomic<bool>& stop)
      : variant_(variant), spec_(*variant.heat), built_(built), observer_(observer), stop_(stop) {}
  HeatRunSummary to_end();

 private:
  using Clock = std::chrono::steady_clock;
  double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }
  /// Steps to a time. @return whether it was reached
  bool advance(double time);
  void end_by(RunSummary::End end, std::string trouble);
  void show(bool last);
  void show_progress();
  bool frame_due() const;
  void summarise();

  const Variant& variant_;
  const HeatSpec& spec_;
  BuiltHeat& built_;
  HeatObserver& observer_;
  const std::atomic<bool>& stop_;
  HeatRunSummary summary_;
  int frames_ = 0;
  Clock::time_point begin_ = Clock::now();
  double progress_shown_ = 0.0;
};

void HeatRun::end_by(RunSummary::End end, std::string trouble) {
  summary_.end = end, summary_.trouble = std::move(trouble);
}

bool HeatRun::advance(double time) {
  HeatSimulation& s = built_.simulation;
  while (s.time() < time) {
    if (stop_.load(std::memory_order_relaxed)) {
      end_by(RunSummary::End::interrupted, {});
      return false;
    }
    const HeatStep step = s.step_towards(time);
    if (step.status != HeatStatus::ok) {
      end_by(RunSummary::End::stopped_not_converged, "a step of " + detail::number_text(step.step) +
                                                         " s did not converge, and none that is shorter; look for a "
                                                         "power or coefficient that is too large, or give "
                                                         "a smaller `heat.tolerance_K`");
      return false;
    }
    summary_.limited_share_most = std::max(summary_.limited_share_most, s.state().limited_share);
    const double coldest = *std::min_element(s.temperature().begin(), s.temperature().end());
    if (coldest < kAbsoluteZero) {
      end_by(RunSummary::End::stopped_too_cold,
             detail::number_text(coldest) +
                 " °C is below absolute zero: more heat is taken than tissue can give; take a smaller power, or a "
                 "temperature through a coefficient in its place");
      return false;
    }
    show_progress();
  }
  return true;
}

/// Frames are evenly spaced over the run; the sample nearest to each time is taken.
bool HeatRun::frame_due() const {
  const int frames = variant_.output.frames;
  if (frames_ >= frames || frames < 2) return false;
  if (frames_ == frames - 1) return built_.simulation.time() >= spec_.duration;
  const double due = spec_.duration * frames_ / (frames - 1);
  return built_.simulation.time() >= due - 0.5 * spec_.sample_every;
}

void HeatRun::show(bool last) {
  const HeatSample sample = built_.read();
  const double low = sample.heat[1], high = sample.heat[2];
  const bool first = built_.simulation.time() == 0.0;
  summary_.lowest_C = first ? low : std::min(summary_.lowest_C, low);
  summary_.highest_C = first ? high : std::max(summary_.highest_C, high);
  observer_.on_sample(sample);
  if (!frame_due() && !(last && variant_.output.frames > 0)) return;
  observer_.on_frame(built_.simulation);
  ++frames_;
  while (frame_due()) ++frames_;
}

void HeatRun::show_progress() {
  const double now = seconds();
  if (now - progress_shown_ < 0.1) return;
  progress_shown_ = now;
  observer_.on_progress(std::min(1.0, built_.simulation.time() / spec_.duration));
}

void HeatRun::summarise() {
  const HeatSimulation& s = built_.simulation;
  summary_.vertices = s.mesh().vertices.size(), summary_.tets = s.mesh().tets.size();
  summary_.steps = s.steps(), summary_.time_s = s.time(), summary_.wall_s = seconds();
  summary_.ledger = s.ledger(), summary_.work = s.work();
  std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a of the temperatures' bits
  for (const double t : s.temperature()) hash = (hash ^ std::bit_cast<std::uint64_t>(t)) * 1099511628211ULL;
  summary_.state_hash = hash;
}

HeatRunSummary HeatRun::to_end() {
  observer_.on_start(variant_, built_);
  show(false);
  const double every = std::min(spec_.sample_every, spec_.duration);
  const auto samples = static_cast<std::uint64_t>(std::ceil(spec_.duration / every * (1.0 - 1e-12)));
  bool reached = true;
  for (std::uint64_t k = 1; reached && k <= samples; ++k) {
    const double before = built_.simulation.time();
    const double time = k == samples ? spec_.duration : every * static_cast<double>(k);
    reached = advance(time);
    if (reached || built_.simulation.time() > before) show(!reached || k == samples);
  }
  summarise();
  observer_.on_end(summary_);
  return summary_;
}

}  // namespace

HeatRunSummary run_heat(const Variant& variant, const MeshLoader& load, HeatObserver& observer,
                        const std::atomic<bool>& stop) {
  BuiltHeat built(variant, load);
  return HeatRun(variant, built, observer, stop).to_end();
}

}  // namespace glisson
