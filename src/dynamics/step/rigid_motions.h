// rigid_motions.h — whether what is held keeps a body from moving as a whole, without which statics has no answer.
#pragma once

#include <span>
#include <string>

#include "element/body.h"

namespace glisson {

/// Looks at each connected piece of the body for a translation or rotation that no held component resists.
/// @param held  per vertex component (3 i + axis): not 0 where it is held
/// @return what is free and what to do; empty where nothing is
std::string free_rigid_motion(const Body& body, std::span<const char> held);

}  // namespace glisson
