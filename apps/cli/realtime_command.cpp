// realtime_command.cpp — glisson bench realtime: whether a scene keeps pace with a clock, and by how much.
#include "cli/realtime_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "bench/bench_text.h"
#include "bench/isa_option.h"
#include "bench/largest_body.h"
#include "bench/realtime.h"
#include "program/exit_code.h"
#include "program/interrupt.h"
#include "program/json_option.h"
#include "program/mesh_cache.h"
#include "program/option_check.h"
#include "program/scene_options.h"
#include "program/standard_streams.h"
#include "report/summary_json.h"

namespace glisson::app {
namespace {

constexpr const char* kRealtimeFooter =
    "Steps the scene at wall-clock pace: one frame of simulated time per frame of the clock, then the tool's force.\n"
    "A frame whose computing takes longer than a frame is missed; overdue frames are dropped,\n"
    "and the simulated time falls behind by them. Writes nothing but FILE; energies are not computed.\n"
    "\n"
    "Examples:\n"
    "  glisson bench realtime scenes/paper/figure3b.toml --variant eta_0\n"
    "  glisson bench realtime scenes/needle/liver_container.toml --variant live --find\n"
    "  glisson bench realtime scenes/organs/liver.toml --seconds 30 --json realtime.json";

constexpr std::size_t kMostEventful = 20;  // lines of events

struct RealtimeArguments {
  SceneOptions scene;
  double seconds = 10.0, frame_ms = 1.0;
  int threads = 0;
  bool find = false;
  std::string isa, json;
};

/// The one variant that is run.
Variant choose_variant(const RealtimeArguments& options) {
  const Scene scene = open_scene(options.scene);
  if (options.scene.variants.size() > 1) throw std::invalid_argument("--variant: bench realtime runs one variant");
  Variant variant = scene.variants.front();
  variant.simulation.threads = options.threads;
  variant.simulation.track_energies = false;
  variant.simulation.exact_steps = false;  // a search for h* takes more than a frame
  if (scene.variants.size() > 1) {
    say("variant {}, the first of {}; --variant NAME takes another\n", variant.name, scene.variants.size());
  }
  return variant;
}

void print_figures(const Variant& variant, const BuiltVariant& body, const RealtimeResult& r, const RealtimeFigures& f,
                   double frame_s) {
  const EngineInfo& engine = body.simulation.engine_info();
  say("{}, {}: {} tets, h = {:.4g} s, {:.1f} steps a frame of {:g} ms, {} at most, threads {}\n", variant.scene_name,
      variant.name, body.simulation.mesh().tets.size(), body.simulation.step_size(), f.steps_per_frame, 1e3 * frame_s,
      f.most_steps, engine.threads);
  say("  frames   {} computed in {:.3f} s, {} missed ({:.2f} %), {} dropped\n", f.frames, r.wall_s, f.missed,
      f.frames > 0 ? 100.0 * static_cast<double>(f.missed) / static_cast<double>(f.frames) : 0.0, r.dropped);
  say("  compute  p50 {:.1f} µs, p99 {:.1f} µs, p99.9 {:.1f} µs, max {:.1f} µs\n", f.p50_us, f.p99_us, f.p999_us,
      f.max_us);
  for (std::size_t i = 0; i < std::min(r.eventful.size(), kMostEventful); ++i) {
    say("  event    {}: {:.1f} µs in that frame\n", r.eventful[i].events, 1e6 * r.eventful[i].compute_s);
  }
  say("  force    {:.4g} N at most on the tool\n", r.peak_force_N);
  say("  pace     {}: {:.3f} s simulated in {:.3f} s, real-time factor {:.3f}\n", r.dropped == 0 ? "kept" : "not kept",
      r.simulated_s, r.wall_s, f.realtime_factor);
}

nlohmann::ordered_json realtime_json(const Variant& variant, const BuiltVariant& body, const RealtimeResult& r,
                                     const RealtimeFigures& f, double frame_s) {
  const EngineInfo& engine = body.simulation.engine_info();
  nlohmann::ordered_json json = machine_json();
  json["scene"] = variant.scene_name;
  json["variant"] = variant.name;
  json["end"] = word_of(r.end.end);
  json["tets"] = body.simulation.mesh().tets.size();
  json["threads"] = engine.threads;
  json["h_s"] = body.simulation.step_size();
  json["frame_s"] = frame_s;
  json["frames"] = f.frames;
  json["missed"] = f.missed;
  json["missed_share"] = f.frames > 0 ? static_cast<double>(f.missed) / static_cast<double>(f.frames) : 0.0;
  json["dropped"] = r.dropped;
  json["steps"] = r.steps;
  json["steps_per_frame"] = f.steps_per_frame;
  json["most_steps"] = f.most_steps;
  json["p50_us"] = f.p50_us, json["p99_us"] = f.p99_us, json["p99_9_us"] = f.p999_us, json["max_us"] = f.max_us;
  json["wall_s"] = r.wall_s;
  json["simulated_s"] = r.simulated_s;
  json["realtime_factor"] = f.realtime_factor;
  json["peak_force_N"] = r.peak_force_N;
  json["frames_us"] = nlohmann::ordered_json::array();
  for (const double s : r.compute_s) json["frames_us"].push_back(std::round(1e7 * s) * 0.1);
  json["frames_steps"] = r.frame_steps;
  json["events"] = nlohmann::ordered_json::array();
  for (const RealtimeResult::Eventful& e : r.eventful) {
    json["events"].push_back({{"events", e.events}, {"frame", e.frame}, {"compute_us", 1e6 * e.compute_s}});
  }
  return json;
}

int exit_code_of(const RealtimeResult& result, const BuiltVariant& body) {
  if (result.end.end == RunSummary::End::finished) return kDone;
  if (result.end.end == RunSummary::End::interrupted) return kInterrupted;
  tell("glisson: {}\n", trouble_text(result.end, body.simulation));
  return kNumericalEnd;
}

int find(const RealtimeArguments& options, const Variant& variant) {
  const RealtimeOptions pace{.seconds = options.seconds, .frame_s = 1e-3 * options.frame_ms};
  std::vector<int> threads{options.threads};
  if (options.threads == 0) threads = {1, static_cast<int>(std::max(1U, std::thread::hardware_concurrency()))};
  if (threads.back() == 1) threads.resize(1);
  nlohmann::ordered_json json = machine_json();
  json["scene"] = variant.scene_name, json["variant"] = variant.name, json["frame_s"] = pace.frame_s;
  json["seconds"] = pace.seconds, json["trials"] = nlohmann::ordered_json::array();
  json["largest"] = nlohmann::ordered_json::array();
  say("{}, {}, frames of {:g} ms\n", variant.scene_name, variant.name, options.frame_ms);
  say("{:>8}  {:>7}  {:>11}  {:>8}  {:>8}  {:>8}  {:>8}  pace\n", "tets", "threads", "steps/frame", "p50 [µs]",
      "p99 [µs]", "max [µs]", "late");
  for (const int n : threads) {
    const auto tell_trial = [&](const BodyTrial& t) {
      const RealtimeFigures& f = t.figures;
      say("{:>8}  {:>7}  {:>11.1f}  {:>8.0f}  {:>8.0f}  {:>8.0f}  {:>8}  {}\n", t.tets, n, f.steps_per_frame, f.p50_us,
          f.p99_us, f.max_us, f.missed + t.dropped, t.keeps ? "kept" : "not kept");
      json["trials"].push_back(trial_json(t));
      keep_json(options.json, json);
    };
    const std::optional<BodyTrial> best = largest_body(variant, n, pace, stop_flag(), tell_trial);
    if (stop_flag()) return kInterrupted;
    if (best) {
      say("largest on {} {}: {} tets\n", n, n == 1 ? "thread" : "threads", best->tets);
      json["largest"].push_back(trial_json(*best));
    } else {
      say("on {} {} no body keeps the pace\n", n, n == 1 ? "thread" : "threads");
    }
  }
  write_json(options.json, json);
  return kDone;
}

int realtime(const RealtimeArguments& options) {
  take_isa(options.isa);
  const Variant variant = choose_variant(options);
  catch_interrupts();
  if (options.find) return find(options, variant);
  MeshCache meshes(false);
  BuiltVariant body = build_variant(variant, meshes.loader());
  const RealtimeOptions pace{.seconds = std::min(options.seconds, run_duration(variant)),
                             .frame_s = 1e-3 * options.frame_ms};
  const RealtimeResult result = run_realtime(body, variant.on_inversion, pace, stop_flag());
  const RealtimeFigures figures = figures_of(result, pace.frame_s);
  print_figures(variant, body, result, figures, pace.frame_s);
  write_json(options.json, realtime_json(variant, body, result, figures, pace.frame_s));
  return exit_code_of(result, body);
}

}  // namespace

CLI::App* add_realtime(CLI::App& bench, Action& action) {
  CLI::App* command = bench.add_subcommand("realtime", "run a scene at wall-clock pace and time its frames");
  const auto options = std::make_shared<RealtimeArguments>();
  add_scene_options(*command, options->scene);
  command->add_option("--seconds", options->seconds, "wall time, or until the scene's motion ends if that is sooner")
      ->type_name("S")
      ->check(within(between(0.01, 86400), Numbers::all))
      ->capture_default_str();
  command->add_option("--frame-ms", options->frame_ms, "length of a frame")
      ->type_name("MS")
      ->check(within(between(0.01, 1000), Numbers::all))
      ->capture_default_str();
  command->add_option("--threads", options->threads, "threads of the engine; 0: chosen by the size of the body")
      ->type_name("N")
      ->check(within(between(0, 1024), Numbers::whole, "0 chooses by the size of the body"))
      ->capture_default_str();
  command->add_flag("--find", options->find,
                    "look for the largest body, by the cells of the scene's mesh, that keeps the pace for --seconds");
  add_isa_option(*command, options->isa, "kernels");
  add_json_option(*command, options->json);
  command->footer(kRealtimeFooter);
  command->callback([options, &action] { action = [options] { return realtime(*options); }; });
  return command;
}

}  // namespace glisson::app
