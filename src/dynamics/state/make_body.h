// make_body.h — which way of moving a body the options ask for.
#pragma once

#include <memory>
#include <span>

#include "element/body.h"
#include "engine/moving_body.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

/// @param body  must outlive the result
/// @param nodal_damping  γ_i per vertex [kg/s]
/// @param info  filled with what was chosen
std::unique_ptr<MovingBody> make_moving_body(const Body& body, std::span<const double> nodal_damping,
                                             const SimulationOptions& options, EngineInfo& info);

/// What there is to say of a body.
EngineInfo info_of(const MovingBody& moving, const Body& body);

}  // namespace glisson
