// supports.h — the sets that [[fixed]] holds or moves, as constraints of a simulation.
//
// Sets may share vertices. A component is held once, by the first set that names it, and its force counts there; a set or a
// tool that asks something else of it contradicts that one.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dynamics/state/constraints.h"
#include "glisson/scene/variant.h"

namespace glisson::scene {

/// @throws Contradiction, or std::invalid_argument as Simulation::fix
ConstraintId add_support(const Variant& variant, std::size_t fixed, std::span<const std::uint32_t> set,
                         Simulation& simulation);

/// What contradicts what, and what to do. @param asked  `[[tool]] "plate"`, by whom the component was asked for
std::string contradiction_text(const Variant& variant, const Contradiction& found, const std::string& asked);

/// `[[fixed]] "rim", moved by breath.csv`.
std::string support_text(const FixedSpec& fixed);

}  // namespace glisson::scene
