// heat_sources.h — vessels, patterns of power and radio frequency of a scene of heat, as what its HeatSimulation takes.
#pragma once

#include <vector>

#include "glisson/heat/heat_simulation.h"
#include "glisson/scene/heat_spec.h"

namespace glisson::scene {

/// Whether a boundary is blood that flows through a region, so that the region is no tissue.
bool is_vessel(const HeatBoundarySpec& x);
/// The coefficient of a wall in air or of a vessel; none where neither is given.
TimeFunction<double> wall_coefficient_of(const HeatBoundarySpec& x);

/// Heat per volume of each tet for a total of 1 W, evenly or by a pattern. @param region  none: the whole body
/// @throws std::invalid_argument where the pattern lies so far outside that nothing of it is left
std::vector<double> pattern_of(const HeatPowerSpec& x, const TetMesh& mesh, std::optional<int> region,
                               const std::vector<int>& hollow);

/// @throws std::invalid_argument
RadioFrequency radio_of(const HeatRadioSpec& x, const TetMesh& mesh);

/// A table where its values are given, else a constant; none where neither is.
TimeFunction<double> course(const std::vector<double>& times, const std::vector<double>& values,
                            const std::optional<double>& constant, int cycles);

}  // namespace glisson::scene
