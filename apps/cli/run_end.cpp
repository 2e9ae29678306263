// run_end.cpp — see run_end.h.
#include "cli/run_end.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "program/exit_code.h"
#include "program/interrupt.h"
#include "program/standard_streams.h"
#include "report/summary_json.h"

namespace glisson::app {
namespace {

/// Names of the variants, with their scene where there are several.
std::vector<std::string> names_of(const std::vector<const VariantRecorder*>& variants) {
  const bool one_scene = std::all_of(variants.begin(), variants.end(),
                                     [&](const VariantRecorder* v) { return v->scene() == variants.front()->scene(); });
  std::vector<std::string> names;
  for (const VariantRecorder* v : variants) names.push_back((one_scene ? "" : v->scene() + "/") + v->variant().name);
  return names;
}

}  // namespace

std::vector<const VariantRecorder*> started_of(const std::vector<std::unique_ptr<VariantRecorder>>& recorders) {
  std::vector<const VariantRecorder*> started;
  for (const auto& recorder : recorders) {
    if (recorder->started()) started.push_back(recorder.get());
  }
  return started;
}

void print_results(const std::vector<const VariantRecorder*>& variants) {
  std::size_t width = 7;
  const std::vector<std::string> names = names_of(variants);
  for (const std::string& name : names) width = std::max(width, name.size());
  say("{:<{}}  {:>8}  {:>9}  {:>10}  {:>8}  {:>11}  {:>12}  {}\n", "variant", width, "tets", "steps", "step [s]",
      "wall [s]", "ns/tet/step", "peak [N]", "end");
  for (std::size_t i = 0; i < variants.size(); ++i) {
    const RunSummary& s = variants[i]->summary();
    say("{:<{}}  {:>8}  {:>9}  {:>10.3e}  {:>8.2f}  {:>11.1f}  {:>12.5g}  {}", names[i], width, s.tets, s.steps,
        s.step_s, s.wall_s, s.ns_per_tet_step, s.peak_force_N, word_of(s.end));
    if (s.inverted_tets_most > 0) {
      say(" (up to {} inverted tets, from {:.4g} s on)", s.inverted_tets_most, s.first_inversion_s);
    }
    if (s.unmet_contact_steps > 0) {
      say(" (tools close on tissue that cannot yield: contact was not met in {} steps, from {:.4g} s on)",
          s.unmet_contact_steps, s.first_unmet_contact_s);
    }
    if (s.energy_gain && s.energy_gain->any()) say(" (energy from nothing, from {:.4g} s on)", s.energy_gain->began);
    if (variants[i]->rejected() > 0) say(" ({} poses of tools rejected)", variants[i]->rejected());
    if (s.linear_share_mean) say(" ({:.0f} % of the tets linear in the mean)", 100.0 * *s.linear_share_mean);
    say("\n");
    for (const TipDistance& tip : variants[i]->tips()) {
      say("{:<{}}  {}: tip of {} ends {:.4g} mm from it, {:.4g} mm ahead and {:.4g} mm aside; least {:.4g} mm\n", "",
          width, tip.probe, tip.tip, 1e3 * tip.distance, 1e3 * tip.along, 1e3 * tip.across, 1e3 * tip.least);
    }
  }
}

int print_checks(const nlohmann::json& checks, const std::string& of, bool only_failed) {
  int failed = 0;
  for (const nlohmann::json& check : checks) {
    const bool pass = check["pass"];
    failed += !pass;
    if (pass && only_failed) continue;
    say("{}  {}{}{}\n      {} (expected: {})\n", pass ? "ok  " : "FAIL", of, of.empty() ? "" : ": ",
        check["what"].get<std::string>(), check["measured"].get<std::string>(), check["expected"].get<std::string>());
  }
  return failed;
}

int end_of(const std::vector<const VariantRecorder*>& variants) {
  bool trouble = false;
  for (const VariantRecorder* v : variants) {
    const std::string text = trouble_text(v->summary());
    trouble = trouble || !text.empty();
    std::fflush(stdout);
    if (!text.empty()) tell("glisson: {}: {}\n", v->variant().name, text);
    for (const std::string& warning : {energy_warning(v->summary()), meeting_warning(v->summary())}) {
      if (!warning.empty()) tell("glisson: {}: warning: {}\n", v->variant().name, warning);
    }
  }
  if (interrupted()) return kInterrupted;
  return trouble ? kNumericalEnd : kDone;
}

}  // namespace glisson::app
