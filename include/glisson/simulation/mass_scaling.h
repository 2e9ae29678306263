// mass_scaling.h — mass that is added to tets which would keep the step short: when, and how much it came to.
#pragma once

#include <cstdint>
#include <vector>

#include "glisson/words.h"

namespace glisson {

/// When mass scaling adds mass.
enum class MassScalingKind { fixed, variable };
template <>
inline constexpr Word<MassScalingKind> kWords<MassScalingKind>[] = {
    {"fixed", MassScalingKind::fixed, "at rest, permanently, to tets with a short element step bound"},
    {"variable", MassScalingKind::variable,
     "the same, and at vertices of tets whose bound is below the step, while the tissue moves evenly"}};

/// Mass added by mass scaling.
struct MassScaling {
  double added = 0.0;               ///< permanently [kg]
  double share = 0.0;               ///< of the body's own mass [-]
  std::vector<std::uint32_t> tets;  ///< with permanently added mass, ascending
  double present = 0.0;             ///< variable: in addition, for tets whose present bound is below the step [kg]
  double largest = 0.0;             ///< largest value of `present` so far [kg]
};

}  // namespace glisson
