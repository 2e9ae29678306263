// command_run.cpp — glisson run: the variants of a scene, their files and one report.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "cli/batch.h"
#include "cli/commands.h"
#include "cli/heat_scene.h"
#include "cli/run_end.h"
#include "glisson/scene/advice.h"
#include "glisson/scene/heat_run.h"
#include "program/embedded.h"
#include "program/exit_code.h"
#include "program/interrupt.h"
#include "program/mesh_cache.h"
#include "program/scene_options.h"
#include "program/standard_streams.h"
#include "report/output_folder.h"
#include "report/report_page.h"
#include "report/scene_checks.h"

namespace glisson::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRunFooter =
    "Writes DIR/<variant>/{forces.csv, frames.pvd, frames/, view.jsonl, summary.json} and DIR/report.html.\n"
    "A scene of heat writes temperature.csv and heat.csv in place of forces.csv and view.jsonl, one with [heat.ice] "
    "both.\n"
    "ParaView opens frames.pvd, `glisson view DIR` all of it.\n"
    "A former run in DIR is replaced; a folder that holds anything else is refused.\n"
    "\n"
    "Examples:\n"
    "  glisson run scenes/paper/figure2.toml\n"
    "  glisson run scenes/paper/figure2.toml --set tissue.poisson_ratio=0.45 --out out/stiffer\n"
    "  glisson run scenes/organs/own_liver.toml --mesh liver.vtu\n"
    "  glisson run scenes/paper/figure3b.toml --variant eta_0 eta_1000 --threads 2";

struct RunOptions {
  SceneOptions scene;
  std::string out;
  int threads = 1;
  bool quiet = false;
};

std::vector<Job> jobs_of(const Scene& scene, const fs::path& folder, int threads) {
  std::vector<Job> jobs;
  for (const Variant& variant : scene.variants) {
    RecorderOptions recorder{.folder = folder / variant.name, .scene = scene.file.stem().string(), .threads = threads};
    recorder.surface_bytes /= scene.variants.size();
    recorder.checks = checks_of(scene, variant.name);
    jobs.push_back({.name = variant.name, .variant = variant, .recorder = std::move(recorder), .also = nullptr});
  }
  return jobs;
}

void write_report(const Scene& scene, const std::vector<const VariantRecorder*>& variants, const SceneExtras& extras,
                  const fs::path& file) {
  const std::string subtitle = scene.variants.size() == 1 ? "one variant" : fmt::format("{} variants", variants.size());
  const std::string title = scene.title.empty() ? scene.file.stem().string() : scene.title;
  nlohmann::json scenes = nlohmann::json::array({scene_json(scene, variants, extras)});
  write_whole(file, report_page(report_template(), report_json(title, subtitle, std::move(scenes))));
}

int run(const RunOptions& options) {
  const Scene scene = open_scene(options.scene);
  const fs::path folder = options.out.empty() ? fs::path("out") / scene.file.stem() : fs::path(options.out);
  if (!options.quiet && !options.scene.mesh.empty()) say("{}\n", scene.notes.back());
  for (const Variant& v : scene.variants) {
    if (const std::string note = is_heat_alone(v) ? "" : branches_note(v); !options.quiet && !note.empty())
      say("{}: {}\n", v.name, note);
  }
  MeshCache meshes(options.quiet);
  if (is_heat_scene(scene)) {
    for (const Variant& variant : scene.variants) BuiltHeat(variant, meshes.loader());  // a mistake is told first
    OutputFolder output(folder, tell_warning);
    output.prepare();
    write_whole(folder / "scene.toml", scene.source);
    catch_interrupts();
    return run_heat_scene(scene, folder, options.threads, options.quiet, meshes.loader());
  }
  const std::vector<Job> jobs = jobs_of(scene, folder, options.threads);
  require_runnable(jobs, meshes.loader());
  OutputFolder output(folder, tell_warning);
  output.prepare();
  write_whole(folder / "scene.toml", scene.source);
  catch_interrupts();
  const auto recorders = run_batch(jobs, {.threads = options.threads, .quiet = options.quiet}, meshes.loader());
  const auto started = started_of(recorders);
  if (!options.quiet) print_results(started);
  SceneExtras extras;
  extras.checks = scene_checks(scene, started);
  const int failed = print_checks(extras.checks, "", options.quiet);
  write_report(scene, started, extras, folder / "report.html");
  say("{}{}\n", options.quiet ? "" : "report: ", (folder / "report.html").string());
  const int end = end_of(started);
  return end == kDone && failed > 0 ? kFailed : end;
}

}  // namespace

void add_run(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("run", "run a scene: forces, frames and a report of every variant");
  const auto options = std::make_shared<RunOptions>();
  add_scene_options(*command, options->scene);
  command->add_option("--out", options->out, "folder of the results; default out/<scene name>")->type_name("DIR");
  add_threads_option(*command, options->threads);
  command->add_flag("--quiet", options->quiet, "print nothing but errors and the report's path");
  command->footer(kRunFooter);
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace glisson::app
