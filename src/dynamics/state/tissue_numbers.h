// tissue_numbers.h — a tissue in a checkpoint.
#pragma once

#include "dynamics/state/checkpoint.h"
#include "glisson/material/tissue.h"

namespace glisson {

void put(CheckpointWriter& out, const Tissue& tissue);
/// @throws std::runtime_error where it is none; whether it is valid is for the caller to ask
Tissue get_tissue(CheckpointReader& in);

}  // namespace glisson
