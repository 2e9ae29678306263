// command_reproduce.cpp — glisson reproduce: the paper's figures in one report.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>

#include "cli/batch.h"
#include "cli/commands.h"
#include "cli/fit_progress.h"
#include "cli/program_path.h"
#include "cli/run_end.h"
#include "fit/run_fit.h"
#include "paper/figures.h"
#include "paper/needle_figures.h"
#include "program/embedded.h"
#include "program/exit_code.h"
#include "program/interrupt.h"
#include "program/mesh_cache.h"
#include "program/scene_options.h"
#include "program/standard_streams.h"
#include "report/output_folder.h"
#include "report/report_page.h"

namespace glisson::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kReproduceFooter =
    "Runs the scenes of the paper, which are built into the program, fits figures 5 and 6, checks the results and "
    "writes\n"
    "DIR/<scene>/<variant>/, DIR/figures_5_and_6/fit/ and one DIR/report.html. Takes some three minutes; with --quick "
    "some\n"
    "twenty seconds: figure 3 ends after 0.1 s of motion, figure 4 is at 10 mm/s on coarse cells, bovine liver is left "
    "out.\n"
    "\n"
    "Examples:\n"
    "  glisson reproduce\n"
    "  glisson reproduce --out out/paper --threads 4";

constexpr std::size_t kPageBytes = 25'000'000;  // of surfaces in the page

struct ReproduceOptions {
  std::string out = "out/reproduce";
  int threads = 1;
  bool quick = false;
};

using Extras = std::function<SceneExtras(const Scene&, const Finished&)>;

/// One scene with what is reported of it.
struct Figure {
  std::string name;  ///< its folder
  Scene scene;
  Extras extras_of;
  SceneExtras extras{};
  std::vector<const VariantRecorder*> runs{};
};

/// Reads a scene of the program and writes it into its folder, from which it can be run again.
/// @param only  the variants that are run; empty: all
Figure figure(const fs::path& out, const std::string& name, std::string_view path, Extras extras_of,
              std::vector<Override> overrides = {}, const std::vector<std::string>& only = {}) {
  const fs::path folder = out / name;
  make_folder(folder);
  const std::string_view text = scene_file(path);
  write_whole(folder / "scene.toml", text);
  Figure f{
      .name = name, .scene = parse_scene(text, name + ".toml", folder, overrides), .extras_of = std::move(extras_of)};
  if (!only.empty()) {
    std::erase_if(f.scene.variants, [&](const Variant& v) { return std::ranges::find(only, v.name) == only.end(); });
  }
  return f;
}

/// The fit of figures 5 and 6 in a folder of its own, with its scene and curves: `glisson fit` goes on from there.
struct PaperFit {
  fit::FitSpec spec;
  fit::FitResult result;
};

PaperFit fit_figures_5_and_6(const fs::path& folder, const ReproduceOptions& options) {
  make_folder(folder / "liver_velocity");
  for (const char* file : {"liver_velocity.toml", "liver_container.toml"}) {
    write_whole(folder / file, scene_file(std::string("fit/") + file));
  }
  for (const std::string_view path : scene_files_in("fit/liver_velocity/")) {
    write_whole(folder / fs::path(path).lexically_relative("fit"), scene_file(path));
  }
  PaperFit done{fit::load_fit(folder / "liver_velocity.toml"), {}};
  done.spec.search.starts = 2;  // intervals by curvature: docs/fit.md has what more starts, profiles and bootstrap add
  done.spec.proof = {.profiles = false, .bootstrap = 0, .next = false, .displacement = done.spec.proof.displacement};
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(options.threads));
  FitProgressLine progress(false);
  fit::FitRun run;
  run.stop = &stop_flag();
  run.progress = [&](const fit::FitProgress& p) { progress.show(p); };
  try {
    done.result = fit::run_fit(done.spec, run);
  } catch (const std::runtime_error&) {
    if (!interrupted()) throw;
  }
  progress.clear();
  return done;
}

/// The fitted values as keys of the fit's scene.
std::vector<Override> fitted(const PaperFit& fit) {
  std::vector<Override> overrides;
  for (std::size_t i = 0; i < fit.result.parameters.size(); ++i) {
    overrides.push_back({fit.spec.parameters.at(i).key, fmt::format("{}", fit.result.parameters[i].value)});
  }
  return overrides;
}

Extras of_runs(SceneExtras (*extras)(const Finished&)) {
  return [extras](const Scene&, const Finished& runs) { return extras(runs); };
}

Figure figures_5_and_6(const fs::path& out, const ReproduceOptions& options) {
  const std::string name = "figures_5_and_6";
  const auto fit = std::make_shared<const PaperFit>(fit_figures_5_and_6(out / name / "fit", options));
  Figure f = figure(
      out, name, "fit/liver_container.toml",
      [fit](const Scene&, const Finished& runs) { return figures_5_and_6_extras(fit->result, runs); }, fitted(*fit));
  f.scene.title = "Figures 5 and 6 — fitted at 2 mm/s, predicted at 2, 6 and 10 mm/s";
  f.scene.description += " " + fit->spec.description;
  f.scene.notes.insert(f.scene.notes.begin(), fit->spec.notes.begin(), fit->spec.notes.end());
  return f;
}

std::vector<Figure> paper_figures(const fs::path& out, const ReproduceOptions& options) {
  std::vector<Override> shallow, coarse;
  std::vector<std::string> needles{"slow", "middle", "fast"};
  if (options.quick) {
    shallow.push_back({"motion.duration_s", "0.1"});
    coarse = {{"mesh.radial_cells", "4"}, {"mesh.axial_cells", "6"}};
    needles = {"middle", "fast"};
  }
  std::vector<Figure> figures;
  figures.push_back(figure(out, "figure2", "paper/figure2.toml", figure2_extras));
  figures.push_back(figure(out, "figure3a", "paper/figure3a.toml", of_runs(figure3a_extras), shallow));
  figures.push_back(figure(out, "figure3b", "paper/figure3b.toml", of_runs(figure3b_extras), shallow));
  figures.push_back(figure(out, "figure4", "needle/liver_container.toml", of_runs(figure4_extras), coarse, needles));
  figures.back().scene.title = "Figure 4 — a needle in a container of liver";
  figures.push_back(figures_5_and_6(out, options));
  if (!options.quick) {
    make_folder(out / "bovine_liver");
    write_whole(out / "bovine_liver" / "bovine_liver_measured.csv", scene_file("needle/bovine_liver_measured.csv"));
    figures.push_back(figure(out, "bovine_liver", "needle/bovine_liver.toml", bovine_extras, {}, {"insertion"}));
    figures.back().scene.title = "Beside figures 5 and 6: a needle into bovine liver, measured";
  }
  return figures;
}

/// The variants of the figures.
std::vector<Job> jobs_of(const std::vector<Figure>& figures, const fs::path& folder, int threads) {
  std::vector<Job> jobs;
  for (const Figure& f : figures) {
    for (const Variant& variant : f.scene.variants) {
      RecorderOptions recorder{.folder = folder / f.name / variant.name, .scene = f.name, .threads = threads};
      recorder.checks = checks_of(f.scene, variant.name);
      jobs.push_back({.name = f.name + "/" + variant.name, .variant = variant, .recorder = recorder, .also = nullptr});
    }
  }
  for (Job& job : jobs) job.recorder.surface_bytes = kPageBytes / jobs.size();
  return jobs;
}

Finished finished_of(const Figure& figure) {
  Finished finished;
  for (const VariantRecorder* run : figure.runs) {
    if (run->summary().end == RunSummary::End::finished) finished[run->variant().name] = run;
  }
  return finished;
}

void print_speed(const Figure& speed) {
  for (const nlohmann::json& table : speed.extras.tables) {
    for (const nlohmann::json& row : table["rows"]) {
      say("      {:>8} ns per tet and iteration  {}\n", row[1].get<std::string>(), row[0].get<std::string>());
    }
  }
}

void write_report(const std::vector<Figure>& figures, const fs::path& file) {
  nlohmann::json scenes = nlohmann::json::array();
  for (const Figure& f : figures) scenes.push_back(scene_json(f.scene, f.runs, f.extras));
  const nlohmann::json report = report_json("Schwartz et al. 2002, reproduced",
                                            "The figures of the paper, computed by this program", std::move(scenes));
  write_whole(file, report_page(report_template(), report));
}

/// Commands that work as printed, from the folder this one was called in.
void print_next_steps(const fs::path& folder) {
  const std::string program = program_path();
  const std::string figure2 = (folder / "figure2").string();
  say("\nWhat to try next:\n");
  say("  {} run {}/scene.toml --set tissue.poisson_ratio=0.45 --out out/stiffer\n", program, figure2);
  say("  {} check {}\n", program, (folder / "figure3b" / "scene.toml").string());
  say("  {} fit {}\n", program, (folder / "figures_5_and_6" / "fit" / "liver_velocity.toml").string());
  say("  {} info {}/linear/frames/frame_0000.vtu\n", program, figure2);
}

/// Runs all variants and computes what is reported of each figure.
std::vector<std::unique_ptr<VariantRecorder>> run_figures(std::vector<Figure>& figures, const fs::path& folder,
                                                          int threads) {
  MeshCache meshes(true);
  auto recorders = run_batch(jobs_of(figures, folder, threads), {.threads = threads, .quiet = false}, meshes.loader());
  for (Figure& f : figures) {
    for (const auto& recorder : recorders) {
      if (recorder->started() && recorder->scene() == f.name) f.runs.push_back(recorder.get());
    }
    f.extras = f.extras_of(f.scene, finished_of(f));
  }
  return recorders;
}

int reproduce(const ReproduceOptions& options) {
  const fs::path folder = options.out;
  OutputFolder output(folder, tell_warning);
  output.prepare();
  catch_interrupts();
  Figure speed = figure(folder, "speed", "paper/speed.toml", {});
  speed.extras = speed_extras(speed.scene);  // before anything else runs: its variants are timed on their own
  std::vector<Figure> figures = paper_figures(folder, options);
  if (interrupted()) return kInterrupted;  // within the fit: nothing has run yet
  const auto recorders = run_figures(figures, folder, options.threads);
  figures.push_back(std::move(speed));
  print_results(started_of(recorders));
  say("\n");
  int failed = 0;
  for (const Figure& f : figures) failed += print_checks(f.extras.checks, f.name, false);
  print_speed(figures.back());
  write_report(figures, folder / "report.html");
  say("\nThe report: {}\n", fs::absolute(folder / "report.html").lexically_normal().string());
  if (!interrupted()) print_next_steps(folder);
  const int end = end_of(started_of(recorders));
  return end == kDone && failed > 0 ? kFailed : end;
}

}  // namespace

void add_reproduce(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("reproduce", "the paper's figures in one report");
  const auto options = std::make_shared<ReproduceOptions>();
  command->add_option("--out", options->out, "folder of the results")->type_name("DIR")->capture_default_str();
  add_threads_option(*command, options->threads);
  command->add_flag("--quick", options->quick, "end figure 3 after 0.1 s of motion, coarse needle, no bovine liver");
  command->footer(kReproduceFooter);
  command->callback([options, &action] { action = [options] { return reproduce(*options); }; });
}

}  // namespace glisson::app
