// simulation_parts.h — the inside of a simulation, for what the library itself builds upon it.
#pragma once

#include "dynamics/schemes/scheme.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

struct SimulationParts {
  static Scheme& scheme(Simulation& simulation);
  /// Whether the integrator's stable step falls with viscosity.
  static bool viscosity_counts(const Simulation& simulation);
};

}  // namespace glisson
