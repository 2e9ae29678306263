#include "bench/largest_body.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "glisson/scene/convergence_variant.h"
#include "program/mesh_cache.h"

namespace glisson::app {
namespace {

constexpr double kMostMissed = 0.001;  // of the frames
constexpr double kLadder = 1.26;       // of the cells along an edge: twice the tets
constexpr double kClose = 1.04;        // of the same: near enough
constexpr double kLeast = 0.1, kMost = 10.0;

class Trials {
 public:
  Trials(const Variant& variant, int threads, const RealtimeOptions& options, const std::atomic<bool>& stop,
         const std::function<void(const BodyTrial&)>& tell)
      : variant_(variant), threads_(threads), options_(options), stop_(stop), tell_(tell) {}

  /// One motion of the body with its cells times `factor`; a mesh that was run before is not run again.
  const BodyTrial& once(double factor) {
    const Variant scaled = at(factor);
    const std::size_t tets = build_variant(scaled, meshes_.loader()).simulation.mesh().tets.size();
    const auto known = by_tets_.find(tets);
    if (known != by_tets_.end()) return known->second;
    const BodyTrial trial = run(scaled, std::min(options_.seconds, run_duration(scaled)));
    return by_tets_.emplace(tets, trial).first->second;
  }
  /// Motions one after the other until the time is over.
  BodyTrial throughout(double factor) { return run(at(factor), options_.seconds); }

 private:
  Variant at(double factor) const {
    Variant scaled = variant_;
    scaled.simulation.threads = threads_;
    if (!multiply_cells(scaled.mesh, factor)) {
      throw std::invalid_argument("--find: the mesh of \"" + variant_.name +
                                  "\" comes from a file, so that it cannot be made finer; take a scene with "
                                  "another mesh.kind");
    }
    return scaled;
  }

  BodyTrial run(const Variant& scaled, double seconds) {
    RealtimeResult all;
    BodyTrial trial;
    trial.threads = threads_;
    while (all.wall_s < seconds && !stop_ && all.end.end == RunSummary::End::finished) {
      BuiltVariant body = build_variant(scaled, meshes_.loader());
      trial.tets = body.simulation.mesh().tets.size();
      const RealtimeOptions pace{.seconds = std::min(seconds - all.wall_s, run_duration(scaled)),
                                 .frame_s = options_.frame_s};
      if (pace.seconds < options_.frame_s) break;
      const RealtimeResult one = run_realtime(body, scaled.on_inversion, pace, stop_);
      all.compute_s.insert(all.compute_s.end(), one.compute_s.begin(), one.compute_s.end());
      all.frame_steps.insert(all.frame_steps.end(), one.frame_steps.begin(), one.frame_steps.end());
      all.dropped += one.dropped, all.steps += one.steps, all.end = one.end;
      all.wall_s += one.wall_s, all.simulated_s += one.simulated_s;
    }
    trial.figures = figures_of(all, options_.frame_s), trial.dropped = all.dropped;
    const auto frames = static_cast<double>(all.compute_s.size() + all.dropped);
    const auto late = static_cast<double>(trial.figures.missed + all.dropped);
    trial.keeps = all.end.end == RunSummary::End::finished && frames > 0.0 && late <= kMostMissed * frames &&
                  trial.figures.p99_us <= 1e6 * options_.frame_s;
    tell_(trial);
    return trial;
  }

  const Variant& variant_;
  int threads_;
  RealtimeOptions options_;
  const std::atomic<bool>& stop_;
  const std::function<void(const BodyTrial&)>& tell_;
  MeshCache meshes_{false};
  std::map<std::size_t, BodyTrial> by_tets_;
};

}  // namespace

nlohmann::ordered_json trial_json(const BodyTrial& t) {
  const RealtimeFigures& f = t.figures;
  return {{"tets", t.tets},     {"threads", t.threads}, {"frames", f.frames},
          {"missed", f.missed}, {"dropped", t.dropped}, {"p50_us", f.p50_us},
          {"p99_us", f.p99_us}, {"max_us", f.max_us},   {"steps_per_frame", f.steps_per_frame},
          {"kept", t.keeps}};
}

std::optional<BodyTrial> largest_body(const Variant& variant, int threads, const RealtimeOptions& options,
                                      const std::atomic<bool>& stop,
                                      const std::function<void(const BodyTrial&)>& tell) {
  Trials trials(variant, threads, options, stop, tell);
  double keeps = 1.0, fails = 1.0;
  if (trials.once(1.0).keeps) {
    while (!stop && fails < kMost && trials.once(fails *= kLadder).keeps) keeps = fails;
  } else {
    while (!stop && keeps > kLeast && !trials.once(keeps /= kLadder).keeps) fails = keeps;
  }
  while (!stop && fails > kClose * keeps) {
    const double middle = std::sqrt(keeps * fails);
    (trials.once(middle).keeps ? keeps : fails) = middle;
  }
  std::size_t refused = 0;
  for (; !stop && keeps > kLeast; keeps /= kClose) {
    const BodyTrial once = trials.once(keeps);
    if (!once.keeps || once.tets == refused) continue;
    const BodyTrial trial = trials.throughout(keeps);
    if (trial.keeps) return trial;
    refused = trial.tets;
  }
  return std::nullopt;
}

}  // namespace glisson::app
