// needle_options.h — what a needle's options must be.
#pragma once

#include "glisson/instruments/needle.h"

namespace glisson {

/// @throws std::invalid_argument naming the option, its value, the allowed range
void require_needle(const NeedleOptions& options);

}  // namespace glisson
