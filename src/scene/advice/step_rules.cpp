// step_rules.cpp — what keeps steps short, what would make them longer, and what they pass over.
#include <algorithm>
#include <cmath>

#include "glisson/material/linear_law.h"
#include "scene/advice/rules.h"

namespace glisson::advice {
namespace {

/// How many times as long the stable step at rest is with mass added to the tets below a step.
double growth_with_mass(const StepCase& c, double step) {
  Variant scaled = c.variant;
  scaled.simulation.step.reset();
  scaled.simulation.mass_scaling_step = step;
  return build_variant(scaled, c.load).simulation.stable_step() / c.rest.stable_step_s;
}

/// The same with stages of the viscous force.
double growth_with_stages(const StepCase& c, int count) {
  Variant staged = c.variant;
  staged.simulation.step.reset();
  staged.simulation.drag_stages = count;
  return build_variant(staged, c.load).simulation.stable_step() / c.rest.stable_step_s;
}

/// Whether the viscous force can be taken in stages: some tissue has one, none at large strain.
bool can_drag_in_stages(const Variant& v) {
  const auto drags_at_large_strain = [](const Tissue& t) { return t.viscosity > 0.0 && !t.has_small_strain(); };
  return capabilities(v.simulation.integrator).supports_drag_stages && v.simulation.drag_stages == 1 && is_viscous(v) &&
         !any_tissue(v, drags_at_large_strain);
}

/// How far a time is from the nearest end of a step, in steps.
double off_steps(double time, double step) { return std::abs(time / step - std::round(time / step)); }

}  // namespace

double two_digits_down(double x) {
  const double last = std::pow(10.0, std::floor(std::log10(x)) - 1.0);
  return last * std::floor(x / last * (1.0 + 1e-12));  // 0.0005 is 50 of 0.00001, whatever their quotient rounds to
}

Texts mass(const StepCase& c) {
  const MassScaling& added = c.rest.scaling;
  if (added.tets.empty()) return {};
  return {fill("{} g ({} % of the body's own) added to {} tets",
               {digits(4, 1e3 * added.added), digits(2, 100.0 * added.share), std::to_string(added.tets.size())})};
}

Texts limits(const StepCase& c) {
  const std::vector<LimitingTet>& bounds = c.rest.limits;
  if (bounds.empty()) return {};
  const LimitingTet &first = bounds.front(), &others = bounds.back();
  if (others.step < kWorthSaying * first.step) return {};
  if (!c.time.has_time()) {
    c.time.leave_out("what mass would give few tets of " + c.variant.name);
    return {};
  }
  c.time.begin("the step of " + c.variant.name + " with mass added to few tets");
  const double step = two_digits_down(others.step), growth = growth_with_mass(c, step);
  if (growth < kWorthSaying) return {};  // bounds of single tets differ more than the step of the body does
  const auto few = std::ranges::count_if(bounds, [&](const LimitingTet& t) { return t.step < 0.95 * others.step; });
  return {
      fill("{} of the tets, first tet {} with altitude {} mm, keep the step short;\n"
           "mass_scaling_step_s = {} adds mass only to these and makes it {} times as long at rest",
           {std::to_string(few), std::to_string(first.tet), digits(3, 1e3 * first.altitude), digits(2, step),
            digits(2, growth)})};
}

Texts stages(const StepCase& c) {
  constexpr double kCost = 0.5;  // of a stage, in steps
  if (!std::isfinite(c.rest.stable_step_s) || !can_drag_in_stages(c.variant)) return {};
  int best = 1;
  double pace = 1.0, growth = 1.0;
  c.time.begin("the step of " + c.variant.name + " with stages of the viscous force");
  double took = 0.0;
  for (int n = 2; n <= most_drag_stages(c.variant); ++n) {
    if (!c.time.has_time(took)) {
      c.time.leave_out("stages of the viscous force in " + c.variant.name);
      return {};
    }
    const double begin = c.time.elapsed();
    const double longer = growth_with_stages(c, n);
    took = c.time.elapsed() - begin;
    if (longer / (1.0 + kCost * (n - 1)) <= pace) break;  // it rises up to the limit by stiffness, and falls from there
    best = n, pace = longer / (1.0 + kCost * (n - 1)), growth = longer;
  }
  if (pace < kWorthSaying) return {};
  return {fill(
      "viscosity keeps the step short; drag_stages = {} makes it {} times as long at rest, for {} times the time a "
      "step",
      {std::to_string(best), digits(2, growth), digits(2, 1.0 + kCost * (best - 1))})};
}

Texts adaptive(const StepCase& c) {
  if (c.variant.simulation.precision != Precision::adaptive) return {};
  std::vector<std::string> own;
  const auto look = [&](const Tissue& tissue) {
    if (!has_linear_law(tissue)) own.push_back("\"" + tissue.name + "\"");
  };
  look(c.variant.tissue);
  for (const RegionSpec& region : c.variant.regions) look(region.tissue);
  if (own.empty()) return {};
  return {
      fill("no linear law stands in for {}: it is linear, or has fibres, averaged volumes, pioletti's viscosity, "
           "branches\nin large strain or times that follow the deformation",
           {listed(own)})};
}

Texts corners(const StepCase& c) {
  constexpr double kOff = 1e-3;  // of a step
  constexpr int kMostParts = 1000;
  const SimulationOptions& o = c.variant.simulation;
  const std::vector<double>& times = c.rest.corners;
  if (!o.step || !capabilities(o.integrator).any_step_is_stable) return {};
  const double step = *o.step;
  const auto misses_by = [](double h) { return [h](double corner) { return off_steps(corner, h) > kOff; }; };
  const auto missed = std::ranges::count_if(times, misses_by(step));
  if (missed == 0) return {};
  const double first = *std::ranges::find_if(times, misses_by(step));
  std::string other;
  for (int parts = 1; parts <= kMostParts && other.empty(); ++parts) {
    const double h = times.front() / (parts + std::floor(times.front() / step));
    if (std::ranges::none_of(times, misses_by(h))) other = ", and so does step_s = " + digits(12, h);
  }
  return {
      fill("step_s = {} passes over {} corner{} of motions, loads and the run's end, the first at {} s: a peak there\n"
           "is cut off. step_s = \"auto\" ends steps at all of them{}",
           {digits(4, step), std::to_string(missed), missed == 1 ? "" : "s", digits(6, first), other})};
}

}  // namespace glisson::advice
