// near_bounds.h — what `glisson check` says of sets and regions whose size hangs on rounding.
#pragma once

#include "glisson/scene/scene.h"

namespace glisson::app {

/// Says of each set and region given by a box, ball or side how many vertices or tets it has by its tolerance alone, and how many
/// lie so little outside that it has probably lost them.
void print_near_bounds(const Variant& variant, const TetMesh& mesh);

}  // namespace glisson::app
