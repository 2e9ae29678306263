#include "cli/check_steps.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cli/advice_lines.h"
#include "cli/progress.h"
#include "program/standard_streams.h"

namespace glisson::app {
namespace {

bool stiffens(const Tissue& t) {
  return !t.has_constant_moduli() || t.hyperelastic || t.fibres || t.kinematics == Kinematics::green;
}

/// What shortens an automatic step below that at rest; empty: nothing does.
std::string shortens_step(const Variant& v) {
  std::vector<std::string> causes;
  if (any_tissue(v, stiffens)) causes.push_back("tissue stiffens");
  if (!v.capsules.empty()) causes.push_back("the capsule is stretched");
  if (!v.instruments.empty()) causes.push_back("instruments press or cut");
  return fmt::format("{}", fmt::join(causes, " and "));
}

/// The implicit integrators compute in double, whatever the scene says.
bool in_single(const Variant& v, const Taste& taste) {
  return v.simulation.precision != Precision::double_precision && std::isfinite(taste.rest.stable_step_s);
}

}  // namespace

Cost cost_of(const Variant& v, const Taste& taste, const RunSummary& summary) {
  Cost cost;
  cost.steps = std::ceil(run_duration(v) / taste.rest.step_s);
  if (v.max_steps) cost.steps = std::min(cost.steps, static_cast<double>(*v.max_steps));
  cost.wall_s = cost.steps * summary.ns_per_tet_step * 1e-9 * static_cast<double>(summary.tets);
  return cost;
}

void print_time(const Variant& v, const MeshLoader& load, const Taste& taste, const Cost& cost,
                const RunSummary& summary, CheckClock& clock) {
  const bool explicit_steps = std::isfinite(taste.rest.stable_step_s), automatic = !v.simulation.step;
  const bool heavy = v.simulation.mass_scaling == MassScalingKind::variable;
  say("  step     {:.4g} s{}, {}\n", taste.rest.step_s, automatic ? " (auto)" : " (given)",
      heavy            ? "kept by mass for tets that need a shorter step, shorter while that mass has an effect"
      : explicit_steps ? fmt::format("stable below {:.4g} s at rest", taste.rest.stable_step_s)
                       : "stable at any step");
  print_advice(advise_on_step(v, taste.rest, load, clock), Advice::About::step);
  const std::string shorter = automatic && explicit_steps && !heavy ? shortens_step(v) : std::string{};
  const std::string more =
      heavy ? " at the step asked for, more where that mass has an effect (the shipped scenes: up to 2.1 times as many)"
      : shorter.empty()
          ? shorter
          : fmt::format(" at the step at rest, more as {} (the shipped scenes: up to 3.8 times)", shorter);
  if (summary.steps == 0) {
    say("  run      {:.6g} s simulated, {:.0f} steps{}; the first took longer than {:.1f} s, and was not waited for\n",
        std::min(run_duration(v), cost.steps * taste.rest.step_s), cost.steps, more, summary.wall_s);
    return;
  }
  say("  run      {:.6g} s simulated, {:.0f} steps{}, about {} ({:.0f} ns per tet and step, {})\n",
      std::min(run_duration(v), cost.steps * taste.rest.step_s), cost.steps, more,
      duration_text(cost.wall_s) + (more.empty() ? "" : " or more"), summary.ns_per_tet_step,
      in_single(v, taste) ? "single precision" : "double precision");
}

}  // namespace glisson::app
