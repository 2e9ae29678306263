// problem_json.h — an experiment as other programs can read it: meshes, moduli, what is held and moved, and the reference.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/comparison.h"

namespace glisson::app {

/// All in SI units. Vertices keep their numbers from mesh to mesh, so that the reference's displacements are those of the finest that is
/// compared. Displacements of tools are given at `times_s`, of which every `times_per_station`-th is a station; at time 0 they are 0.
nlohmann::ordered_json problem_json(const Comparison& comparison, const std::string& scene);

}  // namespace glisson::app
