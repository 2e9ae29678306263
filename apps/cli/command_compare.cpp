// command_compare.cpp — glisson compare: one experiment, many models; error against time.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/comparison_report.h"
#include "cli/progress.h"
#include "compare/problem_json.h"
#include "program/exit_code.h"
#include "program/interrupt.h"
#include "program/json_option.h"
#include "program/mesh_cache.h"
#include "program/option_check.h"
#include "program/scene_options.h"
#include "program/standard_streams.h"
#include "report/json_text.h"
#include "report/output_file.h"
#include "report/output_folder.h"

namespace glisson::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCompareFooter =
    "Gives a scene's body, [[fixed]], [[tool]] and gravity to spring-mass networks, linked volumes, finite elements, "
    "position-based and\n"
    "projective dynamics and the engine's own models, on the scene's mesh and on finer ones, one thread each, and "
    "holds their forces\n"
    "and surfaces against the scene's own tissue on a finer mesh still. The scene's [compare] says how many meshes and "
    "times.\n"
    "Of a scene with variants each is compared, and a last table has the errors of all. The reference of viscous "
    "tissue "
    "is in motion.\n"
    "Explicit steps that would take more than an hour together are refused before anything runs; --allow-hours lifts "
    "that.\n"
    "Writes DIR/report.html and DIR/compare.json. Ctrl-C keeps the models that are done.\n"
    "\n"
    "Examples:\n"
    "  glisson compare scenes/compare/press.toml\n"
    "  glisson compare scenes/compare/twist.toml --set compare.meshes=1 --json twist.json\n"
    "  glisson compare --list";

struct CompareOptions {
  SceneOptions scene;
  std::string out, json, problem;
  double allow_hours = 1.0;
  bool list = false, quiet = false;
};

double total_seconds(const std::vector<ExpectedTime>& times) {
  double sum = 0.0;
  for (const ExpectedTime& one : times) sum += one.wall_s;
  return sum;
}

std::string model_text(const ExpectedTime& one) {
  return fmt::format("{} {:.2g} steps, {}", one.model, one.steps, duration_text(one.wall_s));
}

/// `--set 'compare.models=[…]'` without the models that take longest, as many of them as it needs; empty: none would do.
std::string quick_models(const Scene& scene, std::vector<ExpectedTime> times, double most_s) {
  std::ranges::sort(times, std::ranges::less{}, &ExpectedTime::wall_s);
  std::set<std::string, std::less<>> left_out;
  while (total_seconds(times) > most_s) {
    left_out.insert(times.back().model);
    times.pop_back();
  }
  if (left_out.contains("reference")) return {};
  std::vector<std::string> kept;
  for (const models::Rival* rival : chosen_models(scene)) {
    if (!left_out.contains(rival->name)) kept.push_back(fmt::format("\"{}\"", rival->name));
  }
  return kept.empty() ? std::string() : fmt::format("--set 'compare.models=[{}]'", fmt::join(kept, ","));
}

/// Says what the models' explicit steps will take. @throws std::invalid_argument where that is more than is allowed
void require_time(const Scene& scene, std::vector<ExpectedTime> times, const CompareOptions& options) {
  constexpr double kHour = 3600.0;
  if (times.empty()) return;
  std::ranges::sort(times, std::ranges::greater{}, &ExpectedTime::wall_s);
  const double total = total_seconds(times);
  if (!options.quiet) {
    tell("  explicit steps will take about {}, more where tissue stiffens; the longest: {}\n",
         duration_text(std::max(total, 0.1)), model_text(times.front()));
  }
  if (total <= options.allow_hours * kHour) return;
  std::vector<std::string> list;
  for (const ExpectedTime& one : times) list.push_back(model_text(one));
  const std::string quick = quick_models(scene, times, options.allow_hours * kHour);
  throw std::invalid_argument(
      fmt::format("{}: explicit steps would take about {} ({}), more than --allow-hours {:.6g}: the stable step of "
                  "stiff tissue and "
                  "small tets is short. {}lower tissue.youngs_modulus_Pa, coarsen the mesh or take a smaller "
                  "compare.meshes; or run "
                  "it all with --allow-hours {:.0f}",
                  scene.file.string(), duration_text(total), fmt::join(list, "; "), options.allow_hours,
                  quick.empty() ? "Shorten the motion, " : "Leave out the longest, " + quick + "; shorten the motion, ",
                  std::ceil(1.5 * total / kHour)));
}

int list_models() {
  for (const models::Rival& rival : models::rivals()) {
    say("{}\n  {} [{}]\n{}", rival.name, rival.what, rival.source,
        rival.cannot.empty() ? "" : fmt::format("  cannot: {}\n", rival.cannot));
  }
  return kDone;
}

int run_comparison(const CompareOptions& options) {
  if (options.list) return list_models();
  if (options.scene.scene.empty())
    throw std::invalid_argument("compare: give a scene, or --list for the models there are");
  const Scene scene = open_scene(options.scene);
  const fs::path folder =
      options.out.empty() ? fs::path("out") / (scene.file.stem().string() + "_compare") : fs::path(options.out);
  OutputFolder output(folder, tell_warning);
  catch_interrupts();
  MeshCache meshes(options.quiet);
  require_time(scene, expected_times(scene, meshes.loader(), stop_flag()), options);
  output.prepare();
  write_whole(folder / "scene.toml", scene.source);
  const auto progress = [&](const std::string& what) {
    if (!options.quiet) tell("  {}\n", what);
  };
  std::vector<Comparison> comparisons = compare(scene, meshes.loader(), stop_flag(), progress);
  std::erase_if(comparisons, [](const Comparison& c) { return c.reference.forces.size() != c.stations.size(); });
  if (!comparisons.empty()) {
    say("{}", comparison_table(comparisons));
    const nlohmann::ordered_json json = comparison_json(comparisons, scene.file.stem().string());
    write_whole(folder / "compare.json", json_text(json, 2) + "\n");
    write_json(options.json, json);
    if (!interrupted()) write_json(options.problem, problem_json(comparisons.front(), scene.file.stem().string()));
    write_whole(folder / "report.html", comparison_page(comparisons));
    say("{}{}\n", options.quiet ? "" : "report: ", (folder / "report.html").string());
  }
  return interrupted() ? kInterrupted : kDone;
}

}  // namespace

void add_compare(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("compare", "give a scene to many models: the errors and times of each");
  const auto options = std::make_shared<CompareOptions>();
  add_scene_options(*command, options->scene);
  command->get_option("scene")->required(false);
  command->add_option("--out", options->out, "folder of the results; default out/<scene name>_compare")
      ->type_name("DIR");
  add_json_option(*command, options->json);
  command
      ->add_option("--problem", options->problem,
                   "write the first variant's meshes, moduli, supports, paths and reference to this JSON file")
      ->type_name("FILE")
      ->check(file_place);
  command
      ->add_option("--allow-hours", options->allow_hours,
                   "refuse explicit steps that would take longer than this together")
      ->type_name("H")
      ->check(within(above(0), Numbers::all))
      ->capture_default_str();
  command->add_flag("--list", options->list, "print the models and what each cannot do");
  command->add_flag("--quiet", options->quiet, "print the table and the report's path alone");
  command->footer(kCompareFooter);
  command->callback([options, &action] { action = [options] { return run_comparison(*options); }; });
}

}  // namespace glisson::app
