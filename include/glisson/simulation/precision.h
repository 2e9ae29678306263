// precision.h — the precision of the element arithmetic.
#pragma once

namespace glisson {

/// Precision of the element arithmetic; displacements and velocities are held in double either way.
enum class Precision { single_precision, double_precision };

}  // namespace glisson
