// integrators.h — every integrator: what tests run over that all of them have to pass.
#pragma once

#include <vector>

#include "glisson/simulation/integrator.h"

namespace glisson::test {

/// In the order of their words.
inline std::vector<Integrator> every_integrator() {
  std::vector<Integrator> all;
  for (const Word<Integrator>& w : kWords<Integrator>) {
    if (!is_alias(w)) all.push_back(w.value);
  }
  return all;
}

}  // namespace glisson::test
