// command_reproduce.cpp — glisson reproduce: the paper's figures in one report.
#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <memory>

#include "cli/batch.h"
#include "cli/commands.h"
#include "cli/embedded.h"
#include "cli/exit_code.h"
#include "cli/interrupt.h"
#include "cli/mesh_cache.h"
#include "cli/program_path.h"
#include "cli/run_end.h"
#include "cli/scene_options.h"
#include "cli/standard_streams.h"
#include "paper/figures.h"
#include "report/output_folder.h"
#include "report/report_page.h"

namespace glisson::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kReproduceFooter =
    "Runs the scenes of scenes/paper/, which are built into the program, checks the results and writes\n"
    "DIR/<scene>/<variant>/ and one DIR/report.html. Takes a minute or two; with --quick some seconds: figure 3 ends\n"
    "after 0.1 s of motion.\n"
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

/// One scene of the paper with what is reported of it.
struct Figure {
  Scene scene;
  SceneExtras extras;
  std::vector<const VariantRecorder*> runs;
};

Figure figure(std::string_view text, const std::string& name, std::vector<Override> overrides = {}) {
  return {.scene = parse_scene(text, name, fs::current_path(), overrides), .extras = {}, .runs = {}};
}

std::vector<Figure> paper_figures(bool quick) {
  std::vector<Override> shallow;
  if (quick) shallow.push_back({"motion.duration_s", "0.1"});
  std::vector<Figure> figures;
  figures.push_back(figure(figure2_scene(), "figure2.toml"));
  figures.push_back(figure(figure3a_scene(), "figure3a.toml", shallow));
  figures.push_back(figure(figure3b_scene(), "figure3b.toml", shallow));
  figures.push_back(figure(speed_scene(), "speed.toml"));
  return figures;
}

std::string name_of(const Figure& figure) { return figure.scene.file.stem().string(); }

/// The variants of the figures; those of the speed scene are timed on their own and leave no curves.
std::vector<Job> jobs_of(const std::vector<Figure>& figures, const fs::path& folder, int threads) {
  std::vector<Job> jobs;
  for (const Figure& f : figures) {
    if (&f == &figures.back()) break;
    for (const Variant& variant : f.scene.variants) {
      RecorderOptions recorder{.folder = folder / name_of(f) / variant.name, .scene = name_of(f), .threads = threads};
      jobs.push_back(
          {.name = name_of(f) + "/" + variant.name, .variant = variant, .recorder = recorder, .also = nullptr});
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

void add_extras(std::vector<Figure>& figures) {
  figures[0].extras = figure2_extras(figures[0].scene, finished_of(figures[0]));
  figures[1].extras = figure3a_extras(finished_of(figures[1]));
  figures[2].extras = figure3b_extras(finished_of(figures[2]));
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
  say("  {} info {}/linear/frames/frame_0000.vtu\n", program, figure2);
}

int reproduce(const ReproduceOptions& options) {
  std::vector<Figure> figures = paper_figures(options.quick);
  const fs::path folder = options.out;
  prepare_output_folder(folder);
  for (const Figure& f : figures) {
    make_folder(folder / name_of(f));
    write_whole(folder / name_of(f) / "scene.toml", f.scene.source);
  }
  catch_interrupts();
  figures[3].extras = speed_extras(figures[3].scene);
  MeshCache meshes(true);
  const std::vector<Job> jobs = jobs_of(figures, folder, options.threads);
  const auto recorders = run_batch(jobs, {.threads = options.threads, .quiet = false}, meshes.loader());
  for (Figure& f : figures) {
    for (const auto& recorder : recorders) {
      if (recorder->started() && recorder->scene() == name_of(f)) f.runs.push_back(recorder.get());
    }
  }
  add_extras(figures);
  print_results(started_of(recorders));
  say("\n");
  int failed = 0;
  for (const Figure& f : figures) failed += print_checks(f.extras.checks, name_of(f), false);
  print_speed(figures[3]);
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
  command->add_flag("--quick", options->quick, "end figure 3 after 0.1 s of motion");
  command->footer(kReproduceFooter);
  command->callback([options, &action] { action = [options] { return reproduce(*options); }; });
}

}  // namespace glisson::app
