// command_converge.cpp — glisson converge: what the mesh adds to a scene's force, from the same scene on finer meshes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/batch.h"
#include "cli/commands.h"
#include "cli/convergence_report.h"
#include "cli/progress.h"
#include "cli/run_end.h"
#include "glisson/scene/convergence_order.h"
#include "glisson/scene/convergence_variant.h"
#include "program/embedded.h"
#include "program/exit_code.h"
#include "program/interrupt.h"
#include "program/json_option.h"
#include "program/mesh_cache.h"
#include "program/option_check.h"
#include "program/scene_options.h"
#include "program/standard_streams.h"
#include "report/output_folder.h"
#include "report/report_page.h"

namespace glisson::app {
namespace {

namespace fs = std::filesystem;

constexpr double kMostTets = 3e7;  // some 20 GB

constexpr const char* kConvergeFooter =
    "Runs each variant on its own mesh and on meshes twice as fine, and so on; extrapolates to the limit of fine "
    "meshes, with\n"
    "an order that is observed and possible and an interval in which it is expected, and says how far off the mesh as "
    "given is.\n"
    "A mesh with half the cell size takes about 16 times as long with explicit steps. Where there is inertia, the mesh "
    "as given\n"
    "runs once more with a quarter of the mass, to say what inertia adds.\n"
    "Writes DIR/<variant>_1, _2 … as `glisson run` does, and DIR/report.html. Ctrl-C keeps the meshes that are done.\n"
    "\n"
    "Examples:\n"
    "  glisson converge scenes/paper/figure2.toml --variant linear --levels 2\n"
    "  glisson converge scene.toml --set motion.integrator=quasi_static --json converge.json\n"
    "  glisson converge scene.toml --column tip_displacement_z_m --at end";

struct ConvergeOptions {
  SceneOptions scene;
  std::string out, json, column = "force_N", at = "peak";
  int levels = 3, threads = 1;
  bool quiet = false;
};

/// The variants of one level, their meshes and what reads them.
struct Level {
  std::vector<Job> jobs;
  std::vector<MeshLoader> loaders;
  std::vector<LevelMesh> meshes;
};

Level make_level(const Scene& scene, int times, const MeshLoader& load, const fs::path& folder) {
  Level level;
  for (const Variant& given : scene.variants) {
    RefinedVariant fine = refined_variant(given, times, load);
    fine.variant.name = fmt::format("{}_{}", given.name, times + 1);
    fine.variant.output.frames = std::min(fine.variant.output.frames, 2);
    const TetMesh mesh = build_mesh(fine.variant, fine.load);
    level.meshes.push_back({mesh.tets.size(), cell_size(mesh), tool_area(fine.variant, mesh), fine.split});
    fine.variant.label = fmt::format("{}, cells of {:.3g} mm", given.label.empty() ? given.name : given.label,
                                     1e3 * level.meshes.back().cell);
    RecorderOptions recorder{.folder = folder / fine.variant.name, .scene = scene.file.stem().string(), .threads = 1};
    recorder.surface_bytes /= 4 * scene.variants.size();
    level.jobs.push_back(
        {.name = fine.variant.name, .variant = fine.variant, .recorder = std::move(recorder), .also = nullptr});
    level.loaders.push_back(std::move(fine.load));
  }
  return level;
}

/// The value of a run that is compared; none where the column has no number at any time.
std::optional<double> value_of(const VariantRecorder& run, const ConvergeOptions& options) {
  std::optional<double> value;
  for (const double x : run.column(options.column)) {
    if (!std::isfinite(x)) continue;
    if (!value || options.at == "end" || std::abs(x) > std::abs(*value)) value = x;
  }
  return value;
}

/// Refuses, before anything runs, a study whose finest mesh would not fit into a usual machine.
void require_size(const Scene& scene, const MeshLoader& load, int levels) {
  for (const Variant& variant : scene.variants) {
    const double tets = static_cast<double>(build_mesh(variant, load).tets.size());
    const double finest = tets * std::pow(8.0, levels - 1);
    if (finest <= kMostTets) continue;
    throw std::invalid_argument(fmt::format(
        "--levels {}: the finest mesh of {}, variant {}, would have {:.3g} tets; at most {:.3g}. Take fewer levels, or "
        "start from a coarser mesh, for example --set mesh.cells=[4,4,4]",
        levels, scene.file.string(), variant.name, finest, kMostTets));
  }
}

/// Refuses, before anything runs, a column that is not there or cannot be told from 0.
void require_column(const Scene& scene, const MeshLoader& load, const ConvergeOptions& options) {
  for (const Variant& variant : scene.variants) {
    const BuiltVariant built = build_variant(variant, load);
    std::vector<std::string> columns = ForceTable(variant, built).columns();
    columns.insert(columns.end(), built.probes.columns().begin(), built.probes.columns().end());
    if (std::find(columns.begin(), columns.end(), options.column) == columns.end()) {
      throw std::invalid_argument(fmt::format("--column {}: {}, variant {}, has no such column; it has {}",
                                              options.column, scene.file.string(), variant.name,
                                              fmt::join(columns, ", ")));
    }
    if (options.column != "force_N" || !built.instruments.empty()) continue;
    throw std::invalid_argument(
        fmt::format("{}: variant {} has no tool or instrument whose force could be compared; name another column with "
                    "--column, for example of a [[probe]]; there are {}",
                    scene.file.string(), variant.name, fmt::join(columns, ", ")));
  }
}

class Study {
 public:
  Study(const ConvergeOptions& options, Scene scene, const MeshLoader& load)
      : options_(options), scene_(std::move(scene)), load_(load),
        folder_(options.out.empty() ? fs::path("out") / (scene_.file.stem().string() + "_converge")
                                    : fs::path(options.out)) {
    for (const Variant& v : scene_.variants) {
      studies_.push_back({.variant = v.name, .column = options.column});
      studies_.back().largest_order = largest_order(v, build_mesh(v, load));
    }
  }

  int run() {
    require_size(scene_, load_, options_.levels);
    require_column(scene_, load_, options_);
    OutputFolder output(folder_, tell_warning);
    output.prepare();
    write_whole(folder_ / "scene.toml", scene_.source);
    catch_interrupts();
    for (int k = 0; k < options_.levels && !interrupted() && !ended_; ++k) run_level(k);
    if (!interrupted() && !ended_) run_lighter();
    for (ConvergenceStudy& s : studies_) s.conclude();
    if (!options_.quiet) print();
    write_report();
    write_json(options_.json, convergence_json(scene_.file.stem().string(), studies_, options_.at));
    const std::vector<const VariantRecorder*> started = started_of(recorders_);
    return end_of(started);
  }

 private:
  void run_level(int k) {
    const Level level = make_level(scene_, k, load_, folder_);
    if (!options_.quiet) {
      std::size_t tets = 0;
      for (const LevelMesh& mesh : level.meshes) tets += mesh.tets;
      const std::string cost =
          k == 0 ? std::string() : fmt::format("; with explicit steps about {}", duration_text(16.0 * wall_s_));
      say("mesh {} of {}: {} tets{}\n", k + 1, options_.levels, tets, cost);
    }
    const auto by_path = [&](const MeshFile& file) { return load_(file); };
    std::vector<std::unique_ptr<VariantRecorder>> made;
    if (std::none_of(level.meshes.begin(), level.meshes.end(), [](const LevelMesh& m) { return m.split; })) {
      made = run_batch(level.jobs, {.threads = options_.threads, .quiet = options_.quiet}, by_path);
    } else {  // each has a mesh of its own
      for (std::size_t i = 0; i < level.jobs.size() && !stop_flag(); ++i) {
        auto one = run_batch({level.jobs[i]}, {.threads = 1, .quiet = options_.quiet}, level.loaders[i]);
        made.push_back(std::move(one.front()));
      }
    }
    wall_s_ = 0.0;
    for (std::size_t i = 0; i < made.size(); ++i) {
      if (!made[i]->started()) continue;
      wall_s_ = std::max(wall_s_, made[i]->summary().wall_s);
      add_result(studies_[i], level.meshes[i], *made[i]);
      recorders_.push_back(std::move(made[i]));
    }
  }

  /// Tries the mesh as given with less mass, where there is inertia: twice its cost.
  void run_lighter() {
    for (std::size_t i = 0; i < studies_.size() && !stop_flag(); ++i) {
      const std::optional<Variant> lighter = lighter_variant(scene_.variants[i]);
      if (!lighter) continue;
      Job job{.name = scene_.variants[i].name + "_lighter", .variant = *lighter, .recorder = {}, .also = nullptr};
      job.variant.name = job.name;
      job.variant.output.frames = 0;
      job.recorder.folder = folder_ / job.name;
      job.recorder.scene = scene_.file.stem().string();
      const auto run = run_batch({job}, {.threads = 1, .quiet = options_.quiet}, load_);
      if (!run.front()->started() || run.front()->summary().end != RunSummary::End::finished) continue;
      studies_[i].lighter = value_of(*run.front(), options_);
    }
  }

  /// A run that did not finish has another peak than one that did: it does not count, and no finer mesh is tried.
  void add_result(ConvergenceStudy& study, const LevelMesh& mesh, const VariantRecorder& run) {
    const std::optional<double> value = value_of(run, options_);
    const bool finished = run.summary().end == RunSummary::End::finished;
    if (finished && value) {
      study.levels.push_back({mesh, *value, run.summary().wall_s});
      return;
    }
    ended_ = true;
    study.trouble = fmt::format("The mesh of {} tets {}.", mesh.tets,
                                finished ? "has no value: its column is nan throughout" : "did not come to its end");
  }

  void print() const {
    for (const ConvergenceStudy& s : studies_) say("{}", convergence_table(s, options_.at));
  }

  void write_report() const {
    const std::vector<const VariantRecorder*> started = started_of(recorders_);
    if (started.empty()) return;
    Scene shown = scene_;
    shown.charts = {{.title = fmt::format("{} on each mesh", options_.column),
                     .x = {"time_s", "time [s]", 1.0},
                     .y = {options_.column, options_.column, 1.0},
                     .measured = {},
                     .variants = {},
                     .value = {}}};
    SceneExtras extras;
    for (const ConvergenceStudy& s : studies_) {
      if (s.levels.size() < 2) continue;
      extras.charts.push_back(convergence_chart(s));
      extras.tables.push_back(convergence_rows(s, options_.at));
    }
    const std::string title = scene_.title.empty() ? scene_.file.stem().string() : scene_.title;
    nlohmann::json scenes = nlohmann::json::array({scene_json(shown, started, extras)});
    write_whole(folder_ / "report.html",
                report_page(report_template(), report_json(title, "convergence with the mesh", std::move(scenes))));
    say("{}{}\n", options_.quiet ? "" : "report: ", (folder_ / "report.html").string());
  }

  const ConvergeOptions& options_;
  Scene scene_;
  MeshLoader load_;
  fs::path folder_;
  std::vector<ConvergenceStudy> studies_;  ///< per variant
  std::vector<std::unique_ptr<VariantRecorder>> recorders_;
  double wall_s_ = 0.0;  ///< of the last level
  bool ended_ = false;   ///< a run did not finish, or has no value
};

int converge(const ConvergeOptions& options) {
  MeshCache meshes(options.quiet);
  return Study(options, open_scene(options.scene), meshes.loader()).run();
}

}  // namespace

void add_converge(CLI::App& program, Action& action) {
  CLI::App* command =
      program.add_subcommand("converge", "run a scene on finer meshes: the extrapolated force, the error of the mesh");
  const auto options = std::make_shared<ConvergeOptions>();
  add_scene_options(*command, options->scene);
  command->add_option("--levels", options->levels, "meshes, the scene's own among them, each twice as fine")
      ->type_name("N")
      ->check(within(between(2, 5), Numbers::whole))
      ->capture_default_str();
  command->add_option("--column", options->column, "what is compared: a column of forces.csv or probes.csv")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--at", options->at, "peak: the value of largest size; end: the last")
      ->type_name("WHEN")
      ->check(one_of({"peak", "end"}))
      ->capture_default_str();
  command->add_option("--out", options->out, "folder of the results; default out/<scene name>_converge")
      ->type_name("DIR");
  add_json_option(*command, options->json);
  add_threads_option(*command, options->threads);
  command->add_flag("--quiet", options->quiet, "print nothing but errors and the report's path");
  command->footer(kConvergeFooter);
  command->callback([options, &action] { action = [options] { return converge(*options); }; });
}

}  // namespace glisson::app
