// static_branches.h — what relaxes and resists under `quasi_static`.
#pragma once

#include "glisson/words.h"

namespace glisson {

/// What Maxwell branches and Kelvin–Voigt viscosity do under `quasi_static`.
enum class StaticBranches {
  automatic,  ///< relaxed; `glisson check` and a run say so where the tissue has any
  relaxed,    ///< branches have relaxed at once, viscosity gives no force: the state after long times
  follow      ///< both go by the time of motions and loads, as in slow motion: no mass, no nodal damping
};
template <>
inline constexpr Word<StaticBranches> kWords<StaticBranches>[] = {
    {"auto", StaticBranches::automatic, "relaxed; `glisson check` and the run say so where the tissue has any"},
    {"relaxed", StaticBranches::relaxed, "they have relaxed at once, and viscosity gives no force"},
    {"follow", StaticBranches::follow, "they relax in the time of motions and loads, and viscosity resists"}};

}  // namespace glisson
