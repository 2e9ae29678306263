// run_watch.h — whether the numbers of a run can be believed: finite, and with no energy from nothing.
//
// It looks where a run has its numbers anyway, at samples, frames and the end; steps know nothing of it.
#pragma once

#include <string>

#include "glisson/scene/scene.h"
#include "glisson/simulation/energy_watch.h"

namespace glisson {

class RunWatch {
 public:
  /// Why a run ends; `finished`: it goes on.
  struct Verdict {
    RunSummary::End end = RunSummary::End::finished;
    std::string why{};
  };

  RunWatch(const Variant& variant, const BuiltVariant& built);

  Verdict see(const Sample& sample);
  /// The stored energy of a frame or the end, where the tissue has one.
  void see_stored(double time, const Energies& energies, double stored) { energies_.see(time, energies, stored); }
  /// The state at the end. Cost: a pass over the vertices.
  Verdict see_end() const;
  const EnergyGain& gain() const { return energies_.gain(); }

 private:
  std::string not_finite_in(const Sample& sample) const;

  const Variant& variant_;
  const BuiltVariant& built_;
  EnergyWatch energies_;
};

}  // namespace glisson
