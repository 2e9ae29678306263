// command_fit.cpp — glisson fit: measured curves in, a tissue out, with proof of how sure it is.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/commands.h"
#include "cli/fit_progress.h"
#include "cli/tissue_text.h"
#include "fit/data/units.h"
#include "fit/files/fit_json.h"
#include "fit/files/fit_state.h"
#include "fit/laws/law_candidates.h"
#include "fit/run_fit.h"
#include "program/embedded.h"
#include "program/exit_code.h"
#include "program/interrupt.h"
#include "program/mesh_cache.h"
#include "program/option_check.h"
#include "program/scene_options.h"
#include "program/standard_streams.h"
#include "report/json_text.h"
#include "report/law_data.h"
#include "report/output_file.h"
#include "report/output_folder.h"
#include "report/report_page.h"

namespace glisson::app {
namespace {

namespace fs = std::filesystem;
using fit::FitResult;

constexpr const char* kFitFooter =
    "Writes DIR/{tissue.toml, fit.json, report.html, fit.toml}. tissue.toml is a tissue for scenes:\n"
    "[tissue] file = \"DIR/tissue.toml\". Ctrl-C keeps the results so far; the same command resumes.\n"
    "docs/fit.md explains, docs/fit_file.md lists every key of FIT.toml.\n"
    "\n"
    "Examples:\n"
    "  glisson fit scenes/fit/phantom_mean.toml\n"
    "  glisson fit scenes/fit/phantom_ef10_100t.toml --data ~/phantom --laws constant,linear,ogden,yeoh\n"
    "  glisson fit scenes/fit/liver_velocity.toml --out out/liver\n"
    "  glisson fit scenes/fit/brain_cortex.toml --discover 3\n"
    "  glisson fit --list-laws";

struct FitCommand {
  std::string file, out, data;
  std::vector<std::string> laws;
  std::optional<int> starts, bootstrap;
  int discover = 0;
  int threads = 1;
  bool quiet = false, fresh = false, list_laws = false;
};

int list_laws() {
  for (const fit::LawName& law : fit::known_laws()) say("{:<18}{}\n", law.name, law.what);
  return kDone;
}

/// What an interrupted run of this very fit left in the folder.
fit::FitMemory memory_of(const FitCommand& command, const fs::path& state, const std::string& fingerprint) {
  if (command.fresh) return {};
  std::optional<fit::FitMemory> known = read_fit_state(state, fingerprint);
  if (!known) return {};
  std::size_t starts = 0;
  for (const auto& [law, memory] : *known) starts += memory.starts.size();
  if (!command.quiet && starts > 0) {
    say("resuming after {} starts of an interrupted run (--fresh starts again)\n", starts);
    std::fflush(stdout);
  }
  return std::move(*known);
}

std::string interval_text(const fit::ParameterResult& p) {
  const std::optional<fit::Interval> ci = p.ci95();
  if (!ci) return "unknown";
  const std::string low = ci->low_open ? "open" : fmt::format("{:.4g}", ci->low);
  const std::string high = ci->high_open ? "open" : fmt::format("{:.4g}", ci->high);
  return low + " to " + high;
}

void print_parameters(const FitResult& result) {
  std::size_t width = 9;
  for (const auto& p : result.parameters) width = std::max(width, p.parameter.name.size());
  say("{:<{}}  {:>12}  {:<6}  {:<24}  {}\n", "parameter", width, "value", "unit", "95 % interval", "verdict");
  for (const auto& p : result.parameters) {
    say("{:<{}}  {:>12.5g}  {:<6}  {:<24}  {}\n", p.parameter.name, width, p.value, p.parameter.unit, interval_text(p),
        p.verdict);
  }
}

/// The three best of each size.
void print_discovered(const FitResult& result) {
  if (result.discovered.empty()) return;
  constexpr int kShown = 3;
  std::size_t width = 3;
  for (const auto& d : result.discovered) width = std::max(width, d.name.size());
  say("{} laws of a library of terms; the best of each size by their cost:\n", result.discovered.size());
  say("{:>5}  {:>10}  {:>12}  {:>9}  {}\n", "terms", "parameters", "cost", "least R²", "law");
  int terms = 0, shown = 0;
  for (const auto& d : result.discovered) {
    shown = d.terms == terms ? shown + 1 : 1;
    terms = d.terms;
    if (shown > kShown && !d.taken) continue;
    say("{:>5}  {:>10}  {:>12.5g}  {:>9.3f}  {}{}\n", d.terms, d.parameters, d.cost, d.r2, d.name,
        d.taken ? "  <- compared below" : "");
  }
  say("\n");
}

void print_laws(const FitResult& result) {
  if (result.laws.empty()) return;
  std::size_t width = 3;
  for (const auto& l : result.laws) width = std::max(width, l.name.size());
  const std::string unit = result.unit.empty() ? "of peak" : result.unit;
  say("{:<{}}  {:>10}  {:>14}  {:>15}  {:>10}  {:>10}\n", "law", width, "parameters", "rms fit [" + unit + "]",
      "rms test [" + unit + "]", "AIC", "BIC");
  for (const auto& l : result.laws) {
    const std::string test = l.rms_heldout ? fmt::format("{:.4g}", *l.rms_heldout) : "-";
    say("{:<{}}  {:>10}  {:>14.4g}  {:>15}  {:>10.1f}  {:>10.1f}{}\n", l.name, width, l.parameters, l.rms_fit, test,
        l.aic, l.bic, l.best ? "  <- what the data support" : "");
  }
  say("\n");
}

/// Each kind of test: what the fit of all makes of it, and what a fit to one test alone would have said of the others.
void print_tests(const FitResult& result) {
  const bool kinds = std::any_of(result.tests.begin(), result.tests.end(),
                                 [](const fit::TestResult& t) { return !t.r2_of_alone.empty(); });
  if (!kinds) return;
  std::size_t width = 12;
  for (const fit::TestResult& t : result.tests) width = std::max(width, t.name.size() + 9);
  const auto line = [&](const std::string& name, const auto& cell) {
    std::string text = fmt::format("{:<{}}", name, width);
    for (const fit::TestResult& t : result.tests)
      text += fmt::format("  {:>{}}", cell(t), std::max<std::size_t>(9, t.name.size()));
    say("{}\n", text);
  };
  line("R² in", [](const fit::TestResult& t) { return t.name; });
  line("fit of all", [](const fit::TestResult& t) { return fmt::format("{:.3f}", t.r2); });
  for (std::size_t a = 0; a < result.tests.size(); ++a) {
    if (result.tests[a].held_out) continue;
    line(result.tests[a].name + " alone",
         [&](const fit::TestResult& t) { return fmt::format("{:.3f}", t.r2_of_alone[a]); });
  }
  line("rms of all", [](const fit::TestResult& t) { return fit::measured_text(t.rms, t.unit); });
  say("\n");
}

void print_result(const FitResult& result) {
  print_discovered(result);
  print_laws(result);
  print_tests(result);
  print_parameters(result);
  say("\n");
  for (const std::string& sentence : result.conclusions) say("- {}\n", sentence);
  say("\n{} forward runs of {:.3g} ms, {:.1f} s in all\n", result.forward_runs, 1e3 * result.forward_run_s,
      result.wall_s);
}

/// FitData: fit.json and the curves of the fitted law.
nlohmann::json page_data(const FitResult& result, const nlohmann::ordered_json& json, const fs::path& folder) {
  nlohmann::json data(json);
  const bool a_tissue = !result.tissue.empty() && !result.identifies_nothing() && result.result_file == "tissue.toml";
  data["law_curves"] =
      a_tissue ? stress_data(tissue_of_toml(result.tissue, result.result_file, folder)) : nlohmann::json::array();
  return data;
}

void write_results(const FitResult& result, const FitHeading& heading, const fs::path& folder) {
  const nlohmann::ordered_json json = fit_json(result, heading);
  write_whole(folder / "fit.json", json_text(json, 1) + "\n");
  if (!result.tissue.empty() && !result.identifies_nothing()) write_whole(folder / result.result_file, result.tissue);
  nlohmann::json page = report_json(heading.title, "a fit", nlohmann::json::array());
  page["fits"] = nlohmann::json::array({page_data(result, json, folder)});
  write_whole(folder / "report.html", report_page(report_template(), page));
}

fit::FitSpec spec_of(const FitCommand& command) {
  fit::FitSpec spec = fit::load_fit(command.file);
  if (command.starts) spec.search.starts = *command.starts;
  if (command.bootstrap) spec.proof.bootstrap = *command.bootstrap;
  return spec;
}

int run(const FitCommand& command) {
  if (command.list_laws) return list_laws();
  if (command.file.empty()) throw std::invalid_argument("glisson fit needs FIT.toml; see glisson fit --help");
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(command.threads));
  catch_interrupts();
  const fit::FitSpec spec = spec_of(command);
  const fs::path folder = command.out.empty() ? fs::path("out") / fs::path(command.file).stem() : fs::path(command.out);
  const fs::path state = folder / "fit.state.json";
  MeshCache meshes(command.quiet);
  fit::FitRun options;
  options.laws = command.laws;
  options.discover = command.discover;
  options.data_folder = command.data;
  options.load = meshes.loader();
  options.stop = &stop_flag();
  const std::string fingerprint = fit_fingerprint(spec, options);
  OutputFolder output(folder, tell_warning);
  options.memory = memory_of(command, state, fingerprint);
  FitProgressLine progress(command.quiet);
  bool prepared = false;
  const auto prepare = [&] {
    if (prepared) return;
    output.prepare();
    if (!options.memory.empty()) write_fit_state(state, fingerprint, options.memory);
    prepared = true;
  };
  options.progress = [&](const fit::FitProgress& p) { progress.show(p); };
  options.forecast = [&](const fit::FitForecast& f) { progress.show(f, command.threads); };
  options.remember = [&](const fit::FitMemory& memory) {
    prepare();
    write_fit_state(state, fingerprint, memory);
  };
  FitResult result;
  try {
    result = run_fit(spec, options);
  } catch (const std::runtime_error& error) {
    if (!interrupted()) throw;
    progress.clear();
    tell("glisson: {}\n", error.what());
    return kInterrupted;
  }
  progress.clear();
  prepare();
  write_whole(folder / "fit.toml", spec.source);
  write_results(result, {fs::path(command.file).stem().string(), spec.title, spec.description, spec.notes, spec.source},
                folder);
  if (result.complete) fs::remove(state);
  if (!command.quiet) print_result(result);
  say("{}{}\n", command.quiet ? "" : "report: ", (folder / "report.html").string());
  if (!result.complete) {
    std::fflush(stdout);
    const bool resumes = fs::exists(state);
    tell("glisson: interrupted; {}\n", resumes ? "the same command resumes"
                                               : "the results are those of the runs that were done; the same command "
                                                 "starts again");
    return kInterrupted;
  }
  if (result.identifies_nothing()) {
    std::fflush(stdout);
    tell(
        "glisson: nothing is identified: each parameter stands at a bound or is not identifiable, so that no {} is "
        "written; check the columns and their order, widen the bounds, or fit fewer parameters\n",
        result.result_file);
    return kNumericalEnd;
  }
  return kDone;
}

}  // namespace

void add_fit(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("fit", "fit a tissue to measured curves, with uncertainties");
  const auto options = std::make_shared<FitCommand>();
  command->add_option("fit", options->file, "description of the fit (TOML)")->type_name("FIT");
  command->add_option("--out", options->out, "folder of the results; default out/<name>")->type_name("DIR");
  command->add_option("--data", options->data, "folder of the curves' files; default: that of FIT")->type_name("DIR");
  command->add_option("--laws", options->laws, "fit each of these laws and report which the data support")
      ->delimiter(',')
      ->type_name("NAME,…");
  command
      ->add_option(
          "--discover", options->discover,
          "look for a law of at most N terms among all subsets of a library, and compare the best of each size")
      ->type_name("N")
      ->check(within(between(1, 4), Numbers::whole))
      ->excludes("--laws");
  command->add_flag("--list-laws", options->list_laws, "print the laws that --laws accepts");
  command->add_option("--starts", options->starts, "largest number of descents")
      ->type_name("N")
      ->check(within(between(1, 10000), Numbers::whole));
  command->add_option("--bootstrap", options->bootstrap, "fits to resampled curves; 0: none")
      ->type_name("N")
      ->check(within(between(0, 100000), Numbers::whole));
  command->add_flag("--fresh", options->fresh, "do not resume an interrupted run");
  add_threads_option(*command, options->threads);
  command->get_option("--threads")->description("threads; results do not depend on it");
  command->add_flag("--quiet", options->quiet, "print nothing but errors and the report's path");
  command->footer(kFitFooter);
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace glisson::app
