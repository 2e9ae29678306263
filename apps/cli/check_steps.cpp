#include "cli/check_steps.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "cli/branches_note.h"
#include "cli/progress.h"
#include "glisson/material/linear_law.h"
#include "program/standard_streams.h"

namespace glisson::app {
namespace {

constexpr double kWorthSaying = 1.2;  // how many times as long a step would be without them

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

/// Two digits, not rounded up: a step a little above the others' bound would give all of them mass.
double two_digits_down(double x) {
  const double last = std::pow(10.0, std::floor(std::log10(x)) - 1.0);
  return last * std::floor(x / last * (1.0 + 1e-12));  // 0.0005 is 50 of 0.00001, whatever their quotient rounds to
}

/// How many times as long the stable step at rest is with mass added to the tets below a step.
double growth_with_mass(const Variant& v, const MeshLoader& load, double step, double before) {
  Variant scaled = v;
  scaled.simulation.step.reset();
  scaled.simulation.mass_scaling_step = step;
  return build_variant(scaled, load).simulation.stable_step() / before;
}

/// Which few tets keep an explicit step short, and what mass for them alone gives.
void print_limits(const Variant& v, const MeshLoader& load, const Taste& taste, CheckClock& clock) {
  const MassScaling& added = taste.scaling;
  if (!added.tets.empty()) {
    say("  mass     {:.4g} g ({:.2g} % of the body's own) added to {} tets\n", 1e3 * added.added, 100.0 * added.share,
        added.tets.size());
  }
  if (taste.limits.empty()) return;
  const LimitingTet &first = taste.limits.front(), &others = taste.limits.back();
  if (others.step < kWorthSaying * first.step) return;
  if (!clock.has_time()) return clock.leave_out("what mass would give few tets of " + v.name);
  clock.begin("the step of " + v.name + " with mass added to few tets");
  const double step = two_digits_down(others.step), growth = growth_with_mass(v, load, step, taste.stable_step_s);
  if (growth < kWorthSaying) return;  // bounds of single tets differ more than the step of the body does
  const auto few = std::count_if(taste.limits.begin(), taste.limits.end(),
                                 [&](const LimitingTet& t) { return t.step < 0.95 * others.step; });
  say("  limits   {} of the tets, first tet {} with altitude {:.3g} mm, keep the step short;\n           "
      "mass_scaling_step_s = {:.2g} adds mass only to these and makes it {:.2g} times as long at rest\n",
      few, first.tet, 1e3 * first.altitude, step, growth);
}

/// Whether the viscous force can be taken in stages: some tissue has one, none at large strain.
bool can_drag_in_stages(const Variant& v) {
  const auto drags_at_large_strain = [](const Tissue& t) { return t.viscosity > 0.0 && !t.has_small_strain(); };
  return capabilities(v.simulation.integrator).supports_drag_stages && v.simulation.drag_stages == 1 && is_viscous(v) &&
         !any_tissue(v, drags_at_large_strain);
}

/// Where viscosity keeps an explicit step short, the stages of the viscous force that make a simulated second cheapest.
void print_stages(const Variant& v, const MeshLoader& load, const Taste& taste, CheckClock& clock) {
  constexpr double kCost = 0.5;  // of a stage, in steps
  if (!can_drag_in_stages(v)) return;
  int best = 1;
  double pace = 1.0, growth = 1.0;
  clock.begin("the step of " + v.name + " with stages of the viscous force");
  double took = 0.0;
  for (int n = 2; n <= most_drag_stages(v); ++n) {
    if (!clock.has_time(took)) return clock.leave_out("stages of the viscous force in " + v.name);
    const double begin = clock.elapsed();
    Variant staged = v;
    staged.simulation.step.reset();
    staged.simulation.drag_stages = n;
    const double longer = build_variant(staged, load).simulation.stable_step() / taste.stable_step_s;
    took = clock.elapsed() - begin;
    if (longer / (1.0 + kCost * (n - 1)) <= pace) break;  // it rises up to the limit by stiffness, and falls from there
    best = n, pace = longer / (1.0 + kCost * (n - 1)), growth = longer;
  }
  if (pace < kWorthSaying) return;
  say("  stages   viscosity keeps the step short; drag_stages = {} makes it {:.2g} times as long at rest, for {:.2g} "
      "times the time a step\n",
      best, growth, 1.0 + kCost * (best - 1));
}

/// The largest speed of an instrument on its way [m/s]; 0 where that depends on forces, or it does not end.
double largest_speed(const InstrumentSpec& instrument) {
  constexpr int kLooks = 400;
  const std::shared_ptr<ToolDriver> driver = make_driver(instrument);
  const std::optional<double> end = driver->end();
  if (driver->yields() || !end || !(*end > 0.0)) return 0.0;
  const double h = *end / kLooks;
  Vec3d before = driver->start().position;
  double way = 0.0;
  for (int i = 0; i < kLooks; ++i) {
    const Vec3d now = driver->advance(i * h, h, {}).position;
    way = std::max(way, norm(now - before));
    before = now;
  }
  return way / h;
}

/// The same of a driven vertex set.
double press_speed(const ToolSpec& x) { return x.record || x.path || x.rotation || x.poses ? 0.0 : x.motion.velocity; }

/// That of whatever is driven [m/s]; 0 where that is not known.
double largest_speed(const Variant& v) {
  std::vector<double> speeds;
  for (const InstrumentSpec& x : v.instruments) speeds.push_back(largest_speed(x));
  for (const ToolSpec& x : v.tools) {
    speeds.push_back(press_speed(x));
  }
  if (std::ranges::any_of(speeds, [](double speed) { return !(speed > 0.0); })) return 0.0;
  return speeds.empty() ? 0.0 : std::ranges::max(speeds);
}

/// Where tools move by next to nothing in a step, that mass while tissue moves evenly makes steps longer.
void print_slow(const Variant& v, const Taste& taste) {
  constexpr double kWay = 5e-6, kLongest = 5e-4;  // of a tool in a step [m], of a step [s]
  constexpr double kWorthIt = 2.0;                // in steps at rest
  const SimulationOptions& o = v.simulation;
  const double fastest = largest_speed(v);
  if (!capabilities(o.integrator).supports_variable_mass || o.step || o.mass_scaling_step || !(fastest > 0.0)) return;
  const double step = two_digits_down(std::min(kLongest, kWay / fastest));
  if (step < kWorthIt * taste.step_s) return;
  const double times = step / taste.step_s;
  say("  slow     tools move by {:.2g} µm a step at most; mass_scaling = \"variable\" with mass_scaling_step_s = "
      "{:.2g} "
      "makes\n           steps {} times as long while the tissue moves evenly (docs/integrators.md)\n",
      1e6 * fastest * taste.step_s, step, times < 10.0 ? fmt::format("{:.2g}", times) : fmt::format("{:.0f}", times));
}

/// Speed of waves of pressure in a tissue at rest [m/s].
double wave_speed(const Tissue& t) { return std::sqrt((t.lame().lambda + 2.0 * t.lame().mu) / t.density); }

/// That a tool is faster than the waves that take tissue out of its way.
void print_fast(const Variant& v) {
  double fastest = wave_speed(v.tissue);
  for (const RegionSpec& region : v.regions) fastest = std::max(fastest, wave_speed(region.tissue));
  const auto look = [&](const std::string& name, double speed) {
    if (!(speed > fastest)) return;
    say("  fast     \"{}\" moves at up to {:.3g} mm/s, where waves in the tissue have {:.3g} mm/s: it hits tissue that "
        "has "
        "not begun\n           to move, and its force is that of the impact, and of the mesh. Is its speed in mm/s?\n",
        name, 1e3 * speed, 1e3 * fastest);
  };
  for (const ToolSpec& x : v.tools) look(x.name, press_speed(x));
  for (const InstrumentSpec& x : v.instruments) look(x.name, largest_speed(x));
}

/// The tissues for which adaptive precision can do nothing.
void print_precision(const Variant& v) {
  if (v.simulation.precision != Precision::adaptive) return;
  std::vector<std::string> own;
  const auto look = [&](const Tissue& tissue) {
    if (!has_linear_law(tissue)) own.push_back("\"" + tissue.name + "\"");
  };
  look(v.tissue);
  for (const RegionSpec& region : v.regions) look(region.tissue);
  if (own.empty()) return;
  say("  adaptive no linear law stands in for {}: it is linear, or has fibres, averaged volumes, pioletti's viscosity, "
      "branches\n           in large strain or times that follow the deformation\n",
      fmt::join(own, ", "));
}

/// How far a time is from the nearest end of a step, in steps.
double off_steps(double time, double step) { return std::abs(time / step - std::round(time / step)); }

/// Where given long steps pass over corners: how many, the first, and what ends steps there.
void print_corners(const Variant& v, const Taste& taste) {
  constexpr double kOff = 1e-3;  // of a step
  constexpr int kMostParts = 1000;
  if (!v.simulation.step || !capabilities(v.simulation.integrator).any_step_is_stable) return;
  const double step = *v.simulation.step;
  const auto misses = [](double h) { return [h](double corner) { return off_steps(corner, h) > kOff; }; };
  const auto missed = std::ranges::count_if(taste.corners, misses(step));
  if (missed == 0) return;
  const double first = *std::ranges::find_if(taste.corners, misses(step));
  std::string other;
  for (int parts = 1; parts <= kMostParts && other.empty(); ++parts) {
    const double h = taste.corners.front() / (parts + std::floor(taste.corners.front() / step));
    if (std::ranges::none_of(taste.corners, misses(h))) other = fmt::format(", and so does step_s = {:.12g}", h);
  }
  say("  corners  step_s = {:.4g} passes over {} corner{} of motions, loads and the run's end, the first at {:.6g} s: "
      "a "
      "peak there\n           is cut off. step_s = \"auto\" ends steps at all of them{}\n",
      step, missed, missed == 1 ? "" : "s", first, other);
}

/// The implicit integrators compute in double, whatever the scene says.
bool in_single(const Variant& v, const Taste& taste) {
  return v.simulation.precision != Precision::double_precision && std::isfinite(taste.stable_step_s);
}

}  // namespace

Cost cost_of(const Variant& v, const Taste& taste, const RunSummary& summary) {
  Cost cost;
  cost.steps = std::ceil(run_duration(v) / taste.step_s);
  if (v.max_steps) cost.steps = std::min(cost.steps, static_cast<double>(*v.max_steps));
  cost.wall_s = cost.steps * summary.ns_per_tet_step * 1e-9 * static_cast<double>(summary.tets);
  return cost;
}

void print_time(const Variant& v, const MeshLoader& load, const Taste& taste, const Cost& cost,
                const RunSummary& summary, CheckClock& clock) {
  const bool explicit_steps = std::isfinite(taste.stable_step_s), automatic = !v.simulation.step;
  const bool heavy = v.simulation.mass_scaling == MassScalingKind::variable;
  say("  step     {:.4g} s{}, {}\n", taste.step_s, automatic ? " (auto)" : " (given)",
      heavy            ? "kept by mass for tets that need a shorter step, shorter while that mass has an effect"
      : explicit_steps ? fmt::format("stable below {:.4g} s at rest", taste.stable_step_s)
                       : "stable at any step");
  if (const std::string note = branches_note(v); !note.empty()) say("  branches {}\n", note);
  print_corners(v, taste);
  print_limits(v, load, taste, clock);
  if (explicit_steps) print_stages(v, load, taste, clock), print_slow(v, taste);
  print_fast(v);
  print_precision(v);
  const std::string shorter = automatic && explicit_steps && !heavy ? shortens_step(v) : std::string{};
  const std::string more =
      heavy ? " at the step asked for, more where that mass has an effect (the shipped scenes: up to 2.1 times as many)"
      : shorter.empty()
          ? shorter
          : fmt::format(" at the step at rest, more as {} (the shipped scenes: up to 3.8 times)", shorter);
  if (summary.steps == 0) {
    say("  run      {:.6g} s simulated, {:.0f} steps{}; the first took longer than {:.1f} s, and was not waited for\n",
        std::min(run_duration(v), cost.steps * taste.step_s), cost.steps, more, summary.wall_s);
    return;
  }
  say("  run      {:.6g} s simulated, {:.0f} steps{}, about {} ({:.0f} ns per tet and step, {})\n",
      std::min(run_duration(v), cost.steps * taste.step_s), cost.steps, more,
      duration_text(cost.wall_s) + (more.empty() ? "" : " or more"), summary.ns_per_tet_step,
      in_single(v, taste) ? "single precision" : "double precision");
}

}  // namespace glisson::app
