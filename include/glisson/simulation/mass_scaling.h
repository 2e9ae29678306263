// mass_scaling.h — when mass is added for a longer step.
#pragma once

#include "glisson/words.h"

namespace glisson {

/// When mass scaling adds mass.
enum class MassScalingKind { fixed, variable };
template <>
inline constexpr Word<MassScalingKind> kWords<MassScalingKind>[] = {
    {"fixed", MassScalingKind::fixed, "at rest, for good, to tets with a short element step bound"},
    {"variable", MassScalingKind::variable,
     "the same, and at vertices of tets that have stiffened, until they soften"}};

}  // namespace glisson
