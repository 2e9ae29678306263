#include "cli/heat_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <set>

#include "cli/progress.h"
#include "cli/run_end.h"
#include "cli/side_by_side.h"
#include "glisson/scene/heat_run.h"
#include "program/embedded.h"
#include "program/exit_code.h"
#include "program/interrupt.h"
#include "program/standard_streams.h"
#include "report/heat_recorder.h"
#include "report/report_page.h"
#include "report/scene_checks.h"

namespace glisson::app {
namespace {

/// Hands every call to the recorder and to the progress.
class HeatFan : public HeatObserver {
 public:
  HeatFan(HeatRecorder& recorder, Progress& progress, std::size_t index)
      : recorder_(recorder), progress_(progress), index_(index) {}
  void on_start(const Variant& variant, const BuiltHeat& built) override {
    progress_.started(index_);
    recorder_.on_start(variant, built);
  }
  void on_sample(const HeatSample& sample) override { recorder_.on_sample(sample); }
  void on_frame(const HeatSimulation& simulation) override { recorder_.on_frame(simulation); }
  void on_progress(double fraction) override { progress_.advanced(index_, fraction); }
  void on_end(const HeatRunSummary& summary) override {
    recorder_.on_end(summary);
    progress_.ended(index_, std::string(word_of(summary.end)));
  }

 private:
  HeatRecorder& recorder_;
  Progress& progress_;
  std::size_t index_;
};

using Recorders = std::vector<std::unique_ptr<HeatRecorder>>;

Recorders run_all(const Scene& scene, const std::filesystem::path& folder, int threads, bool quiet,
                  const MeshLoader& load) {
  Recorders recorders;
  std::vector<std::string> names;
  const int at_a_time = std::min(threads, static_cast<int>(scene.variants.size()));
  for (const Variant& variant : scene.variants) {
    RecorderOptions options{.folder = folder / variant.name, .scene = scene.file.stem().string(), .threads = threads};
    options.checks = checks_of(scene, variant.name);
    recorders.push_back(std::make_unique<HeatRecorder>(variant, std::move(options), stop_flag()));
    names.push_back(variant.name);
  }
  std::vector<std::size_t> order(recorders.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  Progress progress(std::move(names), at_a_time, Progress::style_for(quiet));
  run_side_by_side(order, at_a_time, [&](std::size_t i) {
    Variant variant = scene.variants[i];
    if (at_a_time > 1) variant.heat->options.threads = 1;  // the same bytes
    HeatFan observer(*recorders[i], progress, i);
    run_heat(variant, load, observer, stop_flag());
  });
  progress.clear();
  for (const auto& recorder : recorders) {
    if (!recorder->error().empty()) throw OutputError(recorder->error());
  }
  std::erase_if(recorders, [](const auto& recorder) { return !recorder->started(); });
  return recorders;
}

void print_runs(const Recorders& runs) {
  std::size_t width = 7;
  for (const auto& run : runs) width = std::max(width, run->variant().name.size());
  say("{:<{}}  {:>8}  {:>6}  {:>8}  {:>9}  {:>9}  {:>10}  {:>10}  {}\n", "variant", width, "tets", "steps", "wall [s]",
      "low [°C]", "high [°C]", "ice [cm³]", "dead [cm³]", "end");
  for (const auto& run : runs) {
    const HeatRunSummary& s = run->summary();
    say("{:<{}}  {:>8}  {:>6}  {:>8.2f}  {:>8.2f}  {:>8.2f}  {:>9.4g}  {:>9.4g}  {}\n", run->variant().name, width,
        s.tets, s.steps, s.wall_s, s.lowest_C, s.highest_C, 1e6 * run->column("frozen_m3").back(),
        1e6 * run->column("dead_m3").back(), word_of(s.end));
  }
}

int end_of_runs(const Recorders& runs) {
  bool trouble = false;
  std::fflush(stdout);
  for (const auto& run : runs) {
    const std::string text = heat_trouble_text(run->summary()), warning = boiling_warning(run->summary());
    trouble = trouble || !text.empty();
    if (!text.empty()) tell("glisson: {}: {}\n", run->variant().name, text);
    if (!warning.empty()) tell("glisson: {}: warning: {}\n", run->variant().name, warning);
  }
  if (interrupted()) return kInterrupted;
  return trouble ? kNumericalEnd : kDone;
}

/// `4 probes`, nothing for none.
std::string counted(std::size_t count, const char* what) {
  return count == 0 ? "" : fmt::format(", {} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace

bool is_heat_scene(const Scene& scene) { return is_heat_alone(scene.variants.front()); }

int run_heat_scene(const Scene& scene, const std::filesystem::path& folder, int threads, bool quiet,
                   const MeshLoader& load) {
  const Recorders runs = run_all(scene, folder, threads, quiet, load);
  if (!quiet) print_runs(runs);
  const bool one = scene.variants.size() == 1;
  SceneExtras extras;
  nlohmann::json variants = nlohmann::json::array(), charts = nlohmann::json::array();
  for (const ChartSpec& chart : scene.charts) charts.push_back(chart_json(chart));
  for (const auto& run : runs) {
    for (const nlohmann::json& check : run->checks(one ? "" : run->variant().label)) extras.checks.push_back(check);
    for (const nlohmann::json& chart : run->charts(one)) charts.push_back(chart);
    variants.push_back(run->json());
  }
  const int failed = print_checks(extras.checks, "", quiet);
  const std::string title = scene.title.empty() ? scene.file.stem().string() : scene.title;
  const nlohmann::json page = scene_json(scene, std::move(variants), std::move(charts), extras);
  write_whole(
      folder / "report.html",
      report_page(report_template(), report_json(title, "heat; for research and teaching, not for clinical decisions",
                                                 nlohmann::json::array({page}))));
  say("{}{}\n", quiet ? "" : "report: ", (folder / "report.html").string());
  const int end = end_of_runs(runs);
  return end == kDone && failed > 0 ? kFailed : end;
}

int check_heat_scene(const Scene& scene, const MeshLoader& load) {
  for (const Variant& variant : scene.variants) {
    const BuiltHeat built(variant, load);
    const TetMesh& mesh = built.simulation.mesh();
    const HeatSpec& heat = *variant.heat;
    say("\n{}\n", variant.label == variant.name ? variant.name : variant.name + " — " + variant.label);
    say("  mesh     {} vertices, {} tets, {:.4g} cm³\n", mesh.vertices.size(), mesh.tets.size(), 1e6 * volume(mesh));
    for (const HeatTissueSpec& x : heat.tissues) {
      const ThermalTissue& t = x.tissue;
      say("  tissue   {}: k {:.4g}, ice {:.4g} W/(m K); c {:.4g}, ice {:.4g} J/(kg K); {:.4g} kJ/kg from {:.4g} to "
          "{:.4g} °C; "
          "blood {:.4g} 1/s{}\n",
          x.region.empty() ? "of the body" : "\"" + x.region + "\"", t.conductivity, t.frozen_conductivity,
          t.specific_heat, t.frozen_specific_heat, 1e-3 * t.latent_heat, t.freezing_begins, t.freezing_ends,
          t.perfusion,
          t.death ? fmt::format("; dies below {:.4g} °C after {:.4g} s", t.death->cold, t.death->cold_time) : "");
    }
    const std::size_t sensors = built.temperature_columns().size() - 1;
    say("  heat     {:.4g} °C at the start{}{}{}{}\n", heat.options.temperature,
        counted(heat.boundaries.size(), "boundary condition"), counted(heat.probes.size(), "probe"),
        counted(heat.powers.size(), "power"), counted(sensors, "sensor"));
    say("  time     {:.4g} s, a line every {:.4g} s\n", heat.duration, heat.sample_every);
    if (heat.boundaries.empty() && heat.probes.empty() && heat.powers.empty())
      say("  note     nothing heats or cools the body but its blood\n");
  }
  say("\n{} variant{}. The scene can be run.\n", scene.variants.size(), scene.variants.size() == 1 ? "" : "s");
  return kDone;
}

}  // namespace glisson::app
