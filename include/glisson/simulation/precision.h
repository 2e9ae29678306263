// precision.h — the precision of the element arithmetic.
#pragma once

#include "glisson/words.h"

namespace glisson {

/// Precision of the element arithmetic; displacements and velocities are held in double either way.
enum class Precision { single_precision, double_precision, adaptive };
template <>
inline constexpr Word<Precision> kWords<Precision>[] = {
    {"single", Precision::single_precision, "elements in float, state in double"},
    {"double", Precision::double_precision, "everything in double"},
    {"adaptive", Precision::adaptive,
     "single, and the linear law in parts of the body where the tissue's own makes little difference"}};

}  // namespace glisson
