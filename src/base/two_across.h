// two_across.h — a frame around a direction.
#pragma once

#include <array>
#include <cmath>

#include "glisson/math.h"

namespace glisson {

/// Two directions across one, of length 1 as it is.
inline std::array<Vec3d, 2> two_across(const Vec3d& d) {
  const Vec3d helper = std::abs(d.x) < 0.6 ? Vec3d{1.0, 0.0, 0.0} : Vec3d{0.0, 1.0, 0.0};
  const Vec3d e = unit(cross(d, helper));
  return {e, cross(d, e)};
}

}  // namespace glisson
