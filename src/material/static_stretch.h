// static_stretch.h — the state that small oscillations and torsion start from: stretched along z, sides free, at rest for long.
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

#include "base/text.h"
#include "glisson/material_point.h"

namespace glisson {

/// [s]; of all branches and of viscosity nothing is left.
inline constexpr double kLongTime = 1e30;

/// Takes a point at rest to a stretch along z, and lets it relax there.
/// @param what  whose argument the stretch is, for the message
/// @throws std::invalid_argument for a stretch out of range, or one at which no free sides are found
inline void stretch_for_long(MaterialPoint& point, double stretch, const std::string& what) {
  if (!(stretch > 0.0) || !std::isfinite(stretch)) {
    throw std::invalid_argument(what + ": stretch = " + detail::number_text(stretch) +
                                " is outside the allowed range, > 0; 1 is rest");
  }
  if (stretch == 1.0) return;
  const MaterialTargets targets = test_targets(MaterialTest::uniaxial, MaterialControl::deformation, stretch);
  if (point.advance(kLongTime, targets).converged) return;
  throw std::invalid_argument(what + ": at stretch = " + detail::number_text(stretch) +
                              " no free sides are found: it is beyond what the tissue can carry; give one nearer to 1");
}

}  // namespace glisson
