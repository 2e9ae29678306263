// locking.h — tissues in which linear tets are too stiff.
#pragma once

#include <optional>

#include "glisson/material/tissue.h"

namespace glisson {

/// Poisson's ratio at rest of a tissue whose tets keep their own volumes and lock by it (docs/laws.md §5); none: they do not,
/// or share their volumes already.
inline std::optional<double> locking_ratio(const Tissue& tissue) {
  constexpr double kLocking = 0.45, kRounding = 1e-9;
  const LameParameters at_rest = tissue.lame();
  const double nu = at_rest.lambda / (2.0 * (at_rest.lambda + at_rest.mu));
  if (nu < kLocking - kRounding || tissue.volume_change == VolumeChange::average_nodal) return {};
  return nu;
}

}  // namespace glisson
