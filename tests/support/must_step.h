// must_step.h — a step that has to be made, wherever a test stands: in a loop, or in a function that returns something.
#pragma once

#include <stdexcept>
#include <string>

#include "glisson/simulation/simulation.h"

namespace glisson::test {

/// @throws std::runtime_error with the reason where the step is not made
inline void must_step(Simulation& simulation) {
  const StepResult step = simulation.step();
  if (!step.made()) throw std::runtime_error("a step was not made: " + std::string(step.message));
}

}  // namespace glisson::test
