// make_scheme.h — which way of advancing a body the options ask for.
#pragma once

#include <memory>

#include "dynamics/schemes/scheme.h"

namespace glisson {

/// @throws std::invalid_argument as Simulation's constructor
std::unique_ptr<Scheme> make_scheme(Body body, const SimulationOptions& options);

}  // namespace glisson
