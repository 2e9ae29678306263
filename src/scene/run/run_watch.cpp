#include "scene/run/run_watch.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace glisson {
namespace {

using detail::number_text;

bool finite(const Vec3d& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

RunWatch::Verdict not_finite(const std::string& what, double time) {
  if (what.empty()) return {};
  return {RunSummary::End::stopped_not_finite, what + " is not finite at " + number_text(time) +
                                                   " s: a load, motion or modulus is beyond what double precision "
                                                   "holds, or the steps were unstable. Ways out: look at "
                                                   "the last finite line of forces.csv, reduce loads and speeds, leave "
                                                   "out step_s, or take integrator = \"implicit\""};
}

}  // namespace

RunWatch::RunWatch(const Variant& variant, const BuiltVariant& built)
    : variant_(variant), built_(built),
      energies_(variant.simulation.track_energies ? negligible_energy(built.simulation) : 0.0) {}

/// What of a sample is not finite; empty: nothing. Columns of instruments and probes may have no value at a time.
std::string RunWatch::not_finite_in(const Sample& sample) const {
  if (!std::isfinite(sample.time)) return "the time";
  for (std::size_t i = 0; i < sample.supports.size(); ++i) {
    if (!finite(sample.supports[i].total())) return "the force of the support on \"" + variant_.fixed[i].set + "\"";
  }
  for (std::size_t i = 0; i < sample.instruments.size(); ++i) {
    const InstrumentSample& x = sample.instruments[i];
    if (!finite(x.force)) return "the force of \"" + built_.instruments[i]->name() + "\"";
    if (!std::isfinite(x.depth)) return "the depth of \"" + built_.instruments[i]->name() + "\"";
  }
  if (sample.container && !(finite(sample.container->bottom) && finite(sample.container->side))) {
    return "the force on the container";
  }
  // every energy is a term of the balance, or a part of one
  return std::isfinite(sample.energies.imbalance()) ? "" : "an energy";
}

RunWatch::Verdict RunWatch::see(const Sample& sample) {
  if (const std::string what = not_finite_in(sample); !what.empty()) return not_finite(what, sample.time);
  if (!variant_.simulation.track_energies) return {};
  energies_.see(sample.time, sample.energies, sample.stored_energy);
  if (!energies_.runs_away()) return {};
  return {RunSummary::End::stopped_energy,
          "the run ends, since the body has more than ten times the energy that was put into it"};
}

RunWatch::Verdict RunWatch::see_end() const {
  const Simulation& s = built_.simulation;
  const bool all = std::ranges::all_of(s.displacement(), finite) && std::ranges::all_of(s.velocity(), finite);
  return not_finite(all ? "" : "a displacement", s.time());
}

}  // namespace glisson
