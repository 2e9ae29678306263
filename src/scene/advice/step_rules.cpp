// step_rules.cpp — what keeps steps short, what would make them longer, and what they pass over.
#include <algorithm>
#include <cmath>

#include "glisson/material/linear_law.h"
#include "scene/advice/rules.h"

namespace glisson::advice {
namespace {

constexpr double kAutomatic = 0.9;  ///< automatic step over the stable one

/// How many times as long the stable step at rest is with mass added to the tets below a step.
double growth_with_mass(const StepCase& c, double step) {
  Variant scaled = c.variant;
  scaled.start = Start::rest;
  scaled.simulation.step.reset();
  scaled.simulation.mass_scaling_step = step;
  return build_variant(scaled, c.load).simulation.stable_step() / c.rest.stable_step_s;
}

/// A treatment of the viscous force.
struct ViscousCure {
  std::string text;                 ///< its keys and what they give
  double growth = 1.0, cost = 1.0;  ///< of the step at rest, and of the time that a step takes
  double pace() const { return growth / cost; }
};

ViscousCure with_stages(const StepCase& c, int count) {
  constexpr double kCost = 0.5;  // of a stage, in steps
  Variant staged = c.variant;
  staged.start = Start::rest;
  staged.simulation.step.reset();
  staged.simulation.drag_stages = count;
  ViscousCure cure{"", build_variant(staged, c.load).simulation.stable_step() / c.rest.stable_step_s,
                   1.0 + kCost * (count - 1)};
  cure.text = fill("drag_stages = {} makes it {} times as long at rest, for {} times the time a step",
                   {std::to_string(count), digits(2, cure.growth), digits(2, cure.cost)});
  return cure;
}

/// In steps of four times its own, where they are stable. On the blocks of docs/integrators.md these keep forces within 1 %, and a
/// step takes as long as 9 explicit ones with 2592 tets, as 32 with 8748.
ViscousCure with_solves(const StepCase& c) {
  constexpr double kTimesOwn = 4.0, kLeastCost = 8.0, kCostOfATet = 0.0036;
  Variant solved = c.variant;
  solved.start = Start::rest;
  SimulationOptions& o = solved.simulation;
  o.step.reset();
  o.integrator = Integrator::semi_implicit;
  if (o.mass_scaling == MassScalingKind::variable) o.mass_scaling = {}, o.mass_scaling_step.reset();
  if (o.precision == Precision::adaptive) o.precision = {};
  const Simulation trial = build_variant(solved, c.load).simulation;
  const double step = two_digits_down(std::min(kTimesOwn * trial.step_size(), kAutomatic * trial.stable_step()));
  const double tets = static_cast<double>(c.rest.mesh.tets.size());
  ViscousCure cure{"", step / (kAutomatic * c.rest.stable_step_s), std::max(kLeastCost, kCostOfATet * tets)};
  cure.text = fill(
      "integrator = \"semi_implicit\" with step_s = {} makes it {} times as long, for some {} times the time a step;\n"
      "shorter steps, or \"auto\", where motions start or stop at once",
      {digits(2, step), digits(2, cure.growth), digits(1, cure.cost)});
  return cure;
}

/// Whether the viscous force is taken in one explicit stage, and limits the step.
bool drags_in_one_stage(const Variant& v) {
  return capabilities(v.simulation.integrator).supports_drag_stages && v.simulation.drag_stages == 1 && is_viscous(v);
}

/// Whether it can be taken in several: no tissue has one at large strain.
bool can_drag_in_stages(const Variant& v) {
  return !any_tissue(v, [](const Tissue& t) { return t.viscosity > 0.0 && !t.has_small_strain(); });
}

/// Instruments take several solves a step of `semi_implicit`: stages are ahead with them.
bool has_supports_alone(const Variant& v) { return v.instruments.empty() && v.capsules.empty() && !v.container; }

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

Texts viscous(const StepCase& c) {
  if (!std::isfinite(c.rest.stable_step_s) || !drags_in_one_stage(c.variant)) return {};
  c.time.begin("the step of " + c.variant.name + " with other treatments of the viscous force");
  ViscousCure best;
  double took = 0.0;
  bool has_time = true;
  const auto is_better = [&](const auto& try_cure) {
    has_time = has_time && c.time.has_time(took);
    if (!has_time) return false;
    const double begin = c.time.elapsed();
    const ViscousCure found = try_cure();
    took = c.time.elapsed() - begin;
    if (found.pace() <= best.pace()) return false;
    best = found;
    return true;
  };
  const int most = can_drag_in_stages(c.variant) ? most_drag_stages(c.variant) : 1;
  for (int n = 2; n <= most; ++n) {
    if (!is_better([&] { return with_stages(c, n); })) break;  // it rises up to the limit by stiffness, then falls
  }
  if (has_supports_alone(c.variant)) is_better([&] { return with_solves(c); });
  if (!has_time) {
    c.time.leave_out("other treatments of the viscous force in " + c.variant.name);
    return {};
  }
  if (best.pace() < kWorthSaying) return {};
  return {"viscosity keeps the step short; " + best.text};
}

Texts freezing(const StepCase& c) {
  const Variant& v = c.variant;
  if (!v.heat || !v.heat->ice || capabilities(v.simulation.integrator).any_step_is_stable) return {};
  const double factor = v.heat->ice->options.factor, step = kAutomatic * c.rest.stable_step_s / std::sqrt(factor);
  return {
      fill("ice that is {} times as stiff as its tissue leaves steps of {} s, {} of them for the {} s of heat;\n"
           "integrator = \"implicit\" or \"quasi_static\" has no such limit",
           {digits(3, factor), digits(2, step), digits(1, v.heat->duration / step), digits(3, v.heat->duration)})};
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
