// command_bench.cpp — glisson bench: what a step costs on this machine, and how near its limits that is.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "bench/bench_text.h"
#include "bench/isa_option.h"
#include "bench/measure.h"
#include "cli/commands.h"
#include "cli/realtime_command.h"
#include "program/exit_code.h"
#include "program/json_option.h"
#include "program/mesh_cache.h"
#include "program/option_check.h"
#include "program/standard_streams.h"

namespace glisson::app {
namespace {

constexpr const char* kBenchFooter =
    "Measures the machine's multiply-add peak and memory bandwidth, then the step of bodies that are generated here,\n"
    "and compares the two. Takes about a minute, with --quick a few seconds; close other programs. Exit\n"
    "status 1 if a body ends in different states on different numbers of threads.\n"
    "\n"
    "Examples:\n"
    "  glisson bench --quick\n"
    "  glisson bench --mesh liver.vtu --mesh kidney.vtu --json bench.json\n"
    "  glisson bench --sizes 768,5000,20000 --isa avx2\n"
    "  glisson bench --sizes 96000 --models linear,full --threads 1,2,4\n"
    "  glisson bench --sizes 96000 --models all --threads 1";

struct BenchOptions {
  std::vector<int> threads;
  std::vector<std::size_t> sizes;
  std::vector<std::string> models{"linear", "law", "full"};
  std::vector<std::string> meshes;
  std::string isa, json;
  bool quick = false, energies = false;
};

/// 1, 2, 4, … and the number of cores.
std::vector<int> all_threads() {
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::vector<int> threads;
  for (int n = 1; n < cores; n *= 2) threads.push_back(n);
  threads.push_back(cores);
  return threads;
}

template <class T>
std::vector<T> sorted_once(std::vector<T> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

/// What is left open is filled in: all sizes, but with --quick not the million; all numbers of threads.
BenchOptions completed(BenchOptions options) {
  if (options.threads.empty()) options.threads = all_threads();
  if (options.sizes.empty()) {
    options.sizes = usual_sizes();
    if (options.quick) std::erase_if(options.sizes, [](std::size_t size) { return size > 500'000; });
  }
  options.threads = sorted_once(options.threads);
  options.sizes = sorted_once(options.sizes);
  return options;
}

std::vector<BenchBody> bodies_of(const BenchOptions& options) {
  std::vector<BenchBody> bodies;
  const auto there = [&](const std::string& name) {
    return std::any_of(bodies.begin(), bodies.end(), [&](const BenchBody& body) { return body.name == name; });
  };
  for (const std::size_t size : options.sizes) {
    BenchBody body = box_body(size);
    if (!there(body.name)) bodies.push_back(std::move(body));  // two sizes may be nearest to one box
  }
  for (const std::string& mesh : options.meshes) {
    const std::string name = std::filesystem::path(mesh).stem().string();
    bodies.push_back(file_body(there(name) ? mesh : name, MeshCache(false).load({.path = mesh})));
  }
  return bodies;
}

std::vector<BenchCase> cases_of(const BenchOptions& options) {
  std::vector<BenchCase> cases;
  for (const auto& [word, model, help] : kWords<Model>) {
    const auto& wanted = options.models;
    const bool all = std::find(wanted.begin(), wanted.end(), "all") != wanted.end();
    if (!all && std::find(wanted.begin(), wanted.end(), word) == wanted.end()) continue;
    for (const int threads : options.threads) cases.push_back({.model = model, .threads = threads});
  }
  return cases;
}

void measure_peaks(const BenchOptions& options, std::vector<cpu::MachinePeak>& peaks) {
  for (std::size_t i = 0; i < options.threads.size(); ++i) {
    const cpu::MachinePeak peak = cpu::measure_machine_peak(options.threads[i]);
    if (i < peaks.size()) {
      peaks[i] = best_of(peaks[i], peak);
    } else {
      peaks.push_back(peak);
    }
  }
}

/// Cases that are measured a second time with their energies kept: of 96 000 tets the full model, on the fewest threads.
std::vector<BenchCase> with_energies(const BenchBody& body, const std::vector<BenchCase>& cases, bool all) {
  std::vector<BenchCase> kept;
  for (BenchCase again : cases) {
    const bool usual = again.model == Model::full && body.mesh.tets.size() == 96'000 && kept.empty();
    again.accounting = true;
    if (all || usual) kept.push_back(again);
  }
  return kept;
}

void measure_body(const BenchBody& body, std::vector<BenchCase> cases, const MeasureOptions& how, bool energies,
                  BenchResult& result) {
  tell("bench: {}, {} tets\n", body.name, body.mesh.tets.size());
  const std::vector<BenchCase> kept = with_energies(body, cases, energies);
  cases.insert(cases.end(), kept.begin(), kept.end());
  for (BenchRow& row : measure(body, cases, how)) {
    (row.what.accounting ? result.accounting : result.rows).push_back(std::move(row));
  }
}

int bench(const BenchOptions& given) {
  take_isa(given.isa);
  const BenchOptions options = completed(given);
  const MeasureOptions how = options.quick ? MeasureOptions{5, 0.03} : MeasureOptions{};
  const std::vector<BenchCase> cases = cases_of(options);
  const std::vector<BenchBody> bodies = bodies_of(options);
  BenchResult result;
  getloadavg(&result.load_average, 1);
  for (const BenchBody& body : bodies) {
    measure_peaks(options, result.peaks);  // several times in a run: the best is nearest to what the machine can do
    measure_body(body, cases, how, options.energies, result);
  }
  measure_peaks(options, result.peaks);
  say("{}", bench_table(result, how));
  write_json(options.json, bench_json(result, how));
  const std::string mismatch = hash_mismatch(result.rows);
  if (mismatch.empty()) return kDone;
  tell("glisson: {}\n", mismatch);
  return kFailed;
}

void add_bench_options(CLI::App& command, BenchOptions& options) {
  command.add_option("--threads", options.threads, "numbers of threads; default 1, 2, 4 … up to all cores")
      ->type_name("LIST")
      ->delimiter(',')
      ->check(within(between(1, 1024), Numbers::whole));
  command
      .add_option("--sizes", options.sizes,
                  "boxes of about this many tets; default 768, 96000, 1000000. A size needs 1 kB per tet")
      ->type_name("LIST")
      ->delimiter(',')
      ->check(within(between(6, 5e7), Numbers::whole));
  std::vector<std::string> known;
  for (const auto& w : kWords<Model>) known.emplace_back(w.word);
  known.emplace_back("all");
  command
      .add_option("--models", options.models,
                  "linear; law: E follows the shape; full: law and viscosity; the large-deformation laws by name; all")
      ->type_name("LIST")
      ->delimiter(',')
      ->check(one_of(known))
      ->capture_default_str();
  command.add_option("--mesh", options.meshes, "measure these meshes too (.vtu, .vtk, .msh, .inp)")->type_name("FILE…");
  add_isa_option(command, options.isa, "kernels and peak");
  command.add_flag("--energies", options.energies,
                   "measure all a second time with energies kept, as scenes do unless told otherwise");
  command.add_flag("--quick", options.quick, "fewer and shorter repetitions, without the million tets");
  add_json_option(command, options.json);
}

/// `glisson bench --json x realtime SCENE` would silently leave x alone.
void require_no_options(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() > 0) throw CLI::ValidationError(option->get_name(), "give the options of realtime after it");
  }
}

}  // namespace

void add_bench(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("bench", "measure the speed of a step against the machine's limits");
  const auto options = std::make_shared<BenchOptions>();
  add_bench_options(*command, *options);
  const CLI::App* realtime = add_realtime(*command, action);
  command->footer(kBenchFooter);
  command->callback([options, command, realtime, &action] {
    if (realtime->parsed()) return require_no_options(*command);
    action = [options] { return bench(*options); };
  });
}

}  // namespace glisson::app
