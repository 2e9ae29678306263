// expected_time.h — how long the explicit steps of a comparison will take, from the first few of each model on the coarsest mesh.
//
// An explicit step is as long as stability allows: about h √(ρ/E) for cells of size h. A tissue of 1e12 Pa asks for 1e4 times as many
// steps as one of 1e4 Pa, and a mesh of half the cell size for twice as many of eight times the tets.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "compare/models/rival.h"

namespace glisson::app {

/// Of one model on all meshes of a comparison.
struct ExpectedTime {
  std::string model;
  double steps = 0.0;   ///< on all meshes together
  double wall_s = 0.0;  ///< by the clock [s]; more where tissue stiffens
};

/// Steps a model for a tenth of a second on the coarsest mesh; each finer one takes 16 times as long.
/// @param meshes  how many, each with the tets of the one before split in eight
/// @return no time and no steps where the model has no answer, which its run says, or was stopped
ExpectedTime expected_time(const models::Rival& rival, const models::Problem& coarsest, int meshes,
                           const std::atomic<bool>& stop);

}  // namespace glisson::app
