// check_steps.h — what `glisson check` says of a variant's steps: their length, what limits it, what would make it longer, and the cost.
#pragma once

#include "cli/taste.h"
#include "glisson/scene/scene.h"

namespace glisson::app {

/// Steps of a whole run, and its time by the clock.
struct Cost {
  double steps = 0.0, wall_s = 0.0;
};

/// Of a whole run, by the pace of its taste.
Cost cost_of(const Variant& v, const Taste& taste, const RunSummary& summary);

/// Prints the step, what limits it or would make it longer, and the cost.
void print_time(const Variant& v, const MeshLoader& load, const Taste& taste, const Cost& cost,
                const RunSummary& summary, CheckClock& clock);

}  // namespace glisson::app
