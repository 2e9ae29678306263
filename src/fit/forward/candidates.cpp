#include "fit/forward/candidates.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace glisson::fit {
namespace {

bool supports_every_integrator(const Variant& v) { return v.instruments.empty() && v.capsules.empty() && !v.container; }

Adjust own_step(Integrator integrator) {
  return [=](Variant& v, double) {
    v.simulation.integrator = integrator;
    v.simulation.step.reset();
    v.simulation.precision = Precision::single_precision;
  };
}

ForwardCandidate own_stepping(Integrator integrator) {
  return {.name = std::string(word_of(integrator)), .adjust = own_step(integrator)};
}

ForwardCandidate equal_steps(Integrator integrator, int steps) {
  return {.name = std::string(word_of(integrator)) + ", " + std::to_string(steps) + " steps",
          .adjust = equal_stepping(integrator, steps),
          .integrator = integrator,
          .steps = steps};
}

}  // namespace

Adjust equal_stepping(Integrator integrator, int steps) {
  return [=](Variant& v, double duration) {
    v.simulation.integrator = integrator;
    v.simulation.step = duration / steps;
  };
}

Adjust heavier_tissue(double factor, double step) {
  return [=](Variant& v, double) {
    v.tissue.density *= factor;
    for (RegionSpec& r : v.regions) r.tissue.density *= factor;
    v.simulation.damping_rate /= std::sqrt(factor);
    v.simulation.step.reset();
    if (step > 0.0) v.simulation.step = step;
    v.simulation.precision = Precision::single_precision;
    v.simulation.exact_steps = false;
  };
}

Adjust reference_run(const ForwardSpec& spec) {
  return [asked = spec.integrator](Variant& v, double duration) {
    const Integrator integrator = asked.value_or(v.simulation.integrator);
    const bool long_steps = capabilities(integrator).any_step_is_stable;
    const bool own = !asked && (v.simulation.step || v.simulation.implicit.largest_step);
    if (long_steps && !own) equal_stepping(integrator, any_tissue(v, has_past) ? 2000 : 400)(v, duration);
    if (!long_steps && asked) own_step(integrator)(v, duration);
  };
}

std::vector<ForwardCandidate> forward_candidates(const Variant& v, const ForwardSpec& spec) {
  std::vector<ForwardCandidate> list;
  const bool viscous = is_viscous(v), past = any_tissue(v, has_past);
  if (supports_every_integrator(v)) {
    if (!past) {
      for (const int steps : {10, 40}) list.push_back(equal_steps(Integrator::quasi_static, steps));
    }
    for (const int steps : {25, 100, 400}) list.push_back(equal_steps(Integrator::implicit, steps));
  }
  if (viscous && supports_every_integrator(v)) list.push_back(own_stepping(Integrator::semi_implicit));
  const Integrator own = spec.integrator.value_or(v.simulation.integrator);
  const bool explicit_like = capabilities(own).supports(viscous);
  if (!explicit_like) list.push_back(own_stepping(Integrator::central_difference));
  if (explicit_like && !viscous) {
    for (const double factor : {100.0, 30.0, 10.0, 1.0}) {
      const std::string how = factor > 1.0 ? detail::number_text(factor) + " times as heavy" : "steps of one size";
      list.push_back({.name = std::string(word_of(own)) + ", " + how, .adjust = {}, .factor = factor});
    }
  }
  return list;
}

}  // namespace glisson::fit
